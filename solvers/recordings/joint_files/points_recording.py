"""Make a recording of named or numbered points: the joints of a body, or markers."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Tracks
from ...progress import READING, Progress, Remark
from ..conventions import (
    DEFAULT_FRAME_RATE,
    ConstantRate,
    JointSamples,
    guess_unit_of_points,
    stand_markers,
)
from ..point_bodies import (
    are_joints,
    body_of_named_points,
    body_of_points,
    in_room,
    key_of_root,
    missing_limbs,
    read_body,
    stand_body,
    transforms_at,
)

MIN_CONFIDENCE = 0.9
"""Confidence from which the bones decide on points whose names are those of no body. It guards
optical markers, whose order is not that of a body."""


def recording_of_points(
    path: Path | str,
    names: tuple[str, ...],
    points: Array,
    times: Array | None,
    unit: float | None,
    progress: Progress,
    rate: float | None = None,
) -> JointRecording | Tracks:
    """Return named or numbered points as the joints of a body, or as markers if they are none.

    Parameters
    ----------
    path : Path or str
    names : tuple of str
    points : shape (n_frames, n_points, 3), in the unit and axes of the file
    times : shape (n_frames,), seconds, or None
    unit : float, meters per unit of the file, or None
    progress : Progress
    rate : float, hertz, or None
        As the file states it; of frames with times, which may be uneven, about the same.

    Raises
    ------
    InvalidFileError
        No point has all its coordinates in any frame.
    """
    points = np.where(np.isfinite(points).all(axis=-1, keepdims=True), points, np.nan)
    if not len(points) or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are observed in any frame.")
    is_named = not all(name.isdigit() for name in names)
    body = body_of_named_points(names, points) if is_named else None
    lacking = missing_limbs(names) if body is None and is_named else []
    unnamed = None if body is not None or lacking else body_of_points(path, points)
    key = key_of_root(names)
    roots = None if key is None else transforms_at(points[:, names.index(key)])
    if unnamed is not None and (not is_named or unnamed.confidence > MIN_CONFIDENCE):
        placed = in_room(unnamed.names, unnamed.positions, roots)
        return read_body(path, unnamed._replace(positions=placed), unit, progress, times, rate)
    if times is None and rate is None:
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    if body is not None:
        placed = in_room(body.names, body.positions, roots)
        joints = JointSamples(
            body.names, placed, times=times, frame_rate=rate or DEFAULT_FRAME_RATE
        )
        return stand_body(path, joints, scale=unit, progress=progress)
    progress(0.8, _remark_of_markers(names, lacking))
    if times is not None:
        resampler = ConstantRate(path, times, rate)
        points, rate = resampler.positions(points), resampler.frame_rate
    unit = guess_unit_of_points(points, names, progress) if unit is None else unit
    progress(1.0, READING)
    return stand_markers(names, points * unit, rate or DEFAULT_FRAME_RATE, unit, "")


def refuse_other_points(path: Path | str, points: Array) -> None:
    """Raise InvalidFileError if points, (F, n, 3), without names are not joints of a body."""
    if body_of_points(path, points) is None:
        raise InvalidFileError(
            f"{path} is a table without titles, and its numbers form no body in a known order"
            " of joints. Write the names of joints and axes, such as LeftHand_x, in its first"
            " line."
        )


def _remark_of_markers(names: Sequence[str], lacking: Sequence[str]) -> Remark:
    if not lacking and are_joints(names):
        return Remark("The points are a few joints of a body and are imported as markers")
    if not lacking:
        return Remark("The names are those of no body; the points become markers")
    return Remark(
        f"The points lack {', '.join(lacking)} of a body and are imported as markers;"
        " export these joints too"
    )
