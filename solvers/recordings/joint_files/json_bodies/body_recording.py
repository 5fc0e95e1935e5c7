"""Convert the points of one person in all frames to a recording of joints."""

from pathlib import Path

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from ....motion import JointRecording
from ....progress import Progress, Remark
from ...conventions import DEFAULT_FRAME_RATE, JointSamples
from ...point_bodies import (
    body_of_named_points,
    body_of_points,
    in_room,
    landmark_columns,
    read_body,
    recording_from_landmarks,
    refuse_pictures,
    stand_body,
)
from .bodies import BodiesFrame, roots_of, stack_body

MAX_SPREAD = 20
"""Columns of named joints in all frames for each point in them, a ratio. It bounds the memory
of files whose names differ between frames."""
MAX_FEW_COLUMNS = 1 << 22
"""Columns of named joints in all frames that any file may have. It bounds the memory:
130 MB."""


def in_columns(
    path: Path | str, body: str, frames: list[BodiesFrame]
) -> tuple[tuple[str, ...], list[BodiesFrame]]:
    """Return the frames of one body with each named joint in its own column, and the names.

    Raises InvalidFileError if the names differ so much that this would need much memory.
    """
    own = [frame.bodies.get(body) for frame in frames]
    columns = {
        name: column
        for column, name in enumerate(dict.fromkeys(
            name for joints in own if joints is not None for name in joints.names
        ))
    }  # fmt: skip
    n_points = sum(len(joints.positions) for joints in own if joints is not None)
    if len(columns) * len(own) > max(MAX_FEW_COLUMNS, MAX_SPREAD * n_points):
        raise InvalidFileError(
            f"{path} has joints with other names in each frame. Export it again."
        )
    placed = []
    for frame, joints in zip(frames, own, strict=True):
        if joints is not None and joints.names:
            at = [columns[name] for name in joints.names]
            positions = np.full((len(columns), 3), np.nan)
            confidence = np.full(len(columns), np.nan)
            positions[at], confidence[at] = joints.positions, joints.confidence
            joints = joints._replace(positions=positions, confidence=confidence, names=())
        placed.append(frame._replace(bodies={} if joints is None else {body: joints}))
    return tuple(columns), placed


def recording_of_body(
    path: Path | str,
    names: tuple[str, ...],
    body: str,
    frames: list[BodiesFrame],
    times: Array | None,
    rate: float | None,
    scale: float | None,
    progress: Progress,
) -> JointRecording:
    """Return the recording of one person, by the names of the points or by their order.

    Parameters
    ----------
    path : Path or str
    names : tuple of str
        Of the points; points whose number is another one have no names.
    body : str
        Identity of the person.
    frames : list of BodiesFrame
    times : shape (n_frames,), seconds, or None
    rate : float, hertz, or None
    scale : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The number of points changes, or they form no known body.
    """
    try:
        points, confidence = stack_body(body, frames)
    except ValueError:
        raise InvalidFileError(
            f"{path}: the number of joints of body {body} changes. Export it again."
        ) from None
    is_named = len(names) == points.shape[1]
    if is_named and (landmarks := landmark_columns(names)) is not None:
        visibility = np.full(points.shape[:2], np.nan) if confidence is None else confidence
        marks = np.dstack([points, visibility])[:, landmarks]
        return recording_from_landmarks(path, marks, times, rate, scale, progress)
    found = body_of_named_points(names, points) if is_named else None
    roots = roots_of(body, frames, progress)
    if found is None:
        unnamed = body_of_points(path, points)
        if unnamed is not None:
            placed = in_room(unnamed.names, unnamed.positions, roots)
            unnamed = unnamed._replace(positions=placed)
            return read_body(path, unnamed, scale, progress, times, rate)
        if is_named:
            raise InvalidFileError(
                f"{path} has joints called {', '.join(names[:3])} ..., which do not form a"
                " body. Store them as a joint CSV."
            )
        raise InvalidFileError(
            f"{path} has {points.shape[1]} points without names, which form no body in a"
            " known order. Store the joints as a joint CSV, which has names."
        )
    refuse_pictures(path, found.positions)
    if times is None and rate is None:
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    return stand_body(
        path,
        JointSamples(
            found.names,
            in_room(found.names, found.positions, roots),
            times=times,
            frame_rate=rate or DEFAULT_FRAME_RATE,
        ),
        scale=scale,
        progress=progress,
    )
