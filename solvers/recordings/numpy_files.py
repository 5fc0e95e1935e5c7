"""Read the arrays of NumPy files, which state little but their shape."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..errors import InvalidFileError
from ..motion import JointRecording, Motion, Tracks
from ..motion.humanoid import ADULT_STATURE_M
from ..progress import Progress, Remark, unwatched
from .containers import (
    describe_frame_files,
    frame_files,
    read_array,
)
from .conventions import DEFAULT_FRAME_RATE, Bodies, JointSamples, check_scale, observed_body
from .identities import follow_arrays
from .joint_files import read_freemocap_points
from .point_bodies import (
    body_of_named_points,
    body_of_points,
    has_layout,
    in_room,
    points_of_array,
    read_body,
    stand_body,
)
from .skeleton_files import is_motion_x, read_motion_x

HUMANML3D_FEATURES = 263
MAX_ROUNDING = 1e-2
"""Difference from a rotation, relative to 1, up to which numbers are one. It guards points on a
sphere of radius 1; rotations of 16 bits are off by 1e-3."""


class Stated(NamedTuple):
    """What an archive states next to the points."""

    rate: float | None
    """Frames per second."""
    roots: Array | None
    """Transforms of the body, shape (n_frames, 4, 4), which joints may be relative to."""
    names: tuple[str, ...]
    """Of the joints; empty without any."""


NOTHING_STATED = Stated(None, None, ())


def open_npy(
    path: Path | str,
    *,
    scale: float | None = None,
    height: float = ADULT_STATURE_M,
    on_floor: bool = True,
    progress: Progress = unwatched,
) -> Bodies[Motion | JointRecording | Tracks]:
    """Open a `.npy` file by the shape of its array.

    (n_frames, 322) is Motion-X: an SMPL-X body. Points of (n_frames, n_points, 3) are joints if
    they form a body in one of the known orders (`name_joints`), such as the 22 of HumanML3D, 20
    Hz, or the 17 of Human3.6M. Other points are freemocap's (`read_freemocap`). A fourth axis
    in front has several people or takes. One frame (n_points, 3) stands for all files of its
    take (`frame_files`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    height : float, meters
        Stature of an SMPL-X body (`open_smpl`).
    on_floor : bool
        Whether the feet of such a body are put on the floor.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds features or rotations, from which no pose
        follows, or points of images.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    array = read_array(path)
    if is_motion_x(array.shape):
        return Bodies(
            str(path),
            (),
            lambda _, progress: read_motion_x(array, scale, height, on_floor, progress),
        )
    if array.ndim == 2 and array.shape[1] == HUMANML3D_FEATURES:
        raise InvalidFileError(
            f"{path} holds the {HUMANML3D_FEATURES} features of HumanML3D, not a pose. Recover"
            " the 22 joints with its recover_from_ric, and save those."
        )
    if _is_frame(array):
        array = _read_frames(path, array.shape, progress)
    return open_points(path, array, scale, progress=progress)


def is_frame_npy(path: Path | str) -> bool:
    """Return whether a file holds the joints of one frame."""
    return _is_frame(read_array(path))


def _is_frame(array: Array) -> bool:
    return array.ndim == 2 and array.shape[1] in {3, 4} and has_layout(array.shape[0])


def _read_frames(path: Path | str, shape: tuple[int, ...], progress: Progress) -> Array:
    """Return the points of all files of a take; NaN in frames without a file."""
    files = frame_files(path).frames()
    if len(files) == 1:
        raise InvalidFileError(
            f"{path} holds the joints of one frame. Save all frames as one array of the shape"
            " (frames, joints, 3)."
        )
    frames = []
    for file in files:
        frames.append(np.full(shape, np.nan) if file is None else read_array(file))
        if frames[-1].shape != shape:
            raise InvalidFileError(
                f"{file} holds an array of shape {frames[-1].shape}, other frames of the take"
                f" have {shape}. Save all joints in each frame."
            )
    progress(0.5, Remark(describe_frame_files(len(files))))
    return np.stack(frames)


def open_points(
    path: Path | str,
    array: Array,
    scale: float | None,
    stated: Stated = NOTHING_STATED,
    progress: Progress = unwatched,
) -> Bodies[JointRecording | Tracks]:
    """List the bodies of an array, (F, n, 3); several are on another axis, first or second."""
    _refuse_rotations(path, array)
    separate = _bodies_of(array)
    numbers = [str(number) for number in range(1, len(separate) + 1)]
    bodies = follow_arrays(numbers, separate, None, progress)
    listed = tuple(
        observed_body(
            number,
            np.flatnonzero(np.isfinite(points).all(axis=2).any(axis=1)),
            len(points),
            len(points) / (stated.rate or DEFAULT_FRAME_RATE),
        )
        for number, points in zip(numbers, bodies, strict=True)
        if len(bodies) > 1
    )

    def read(index: int, progress: Progress) -> JointRecording | Tracks:
        points = points_of_array(path, bodies[index])
        n_roots = 0 if stated.roots is None else len(stated.roots)
        is_alone = len(bodies) == 1 and n_roots == len(points)
        own = stated if is_alone else stated._replace(roots=None)
        return _read_points(path, points, scale, own, progress)

    return Bodies(str(path), listed, read)


def _bodies_of(array: Array) -> list[Array]:
    """Return the points of each body of an array, with the frames on the first axis.

    Points move little from frame to frame, so frames are on the axis with the smaller steps; on
    the longer one where the steps say nothing. A body whose points are all at the origin is not
    observed, and slots that are never filled are left out.
    """
    if array.ndim != 4 or 1 in array.shape[:2] or array.shape[3] not in {2, 3, 4}:
        return [array]
    found = np.where(array.any(axis=(2, 3), keepdims=True), array, np.nan)
    steps = step_along(found, 0), step_along(found, 1)
    is_second = found.shape[1] > found.shape[0] if steps[0] == steps[1] else steps[1] < steps[0]
    bodies = found if is_second else np.moveaxis(found, 1, 0)
    return [body for body in bodies if np.isfinite(body).any()] or [*bodies]


def step_along(points: Array, axis: int) -> float:
    """Return the median step of points, (..., 3), along an axis; infinite if none is known."""
    steps = np.linalg.norm(np.diff(points[..., :3], axis=axis), axis=-1)
    steps = steps[np.isfinite(steps)]
    return float(np.median(steps)) if steps.size else np.inf


def _refuse_rotations(path: Path | str, array: Array) -> None:
    """Raise InvalidFileError for rotation matrices and unit quaternions."""
    if array.ndim < 3 or not array.size or not np.isfinite(array).all():
        return
    if array.shape[-2:] == (3, 3):
        products = array @ np.swapaxes(array, -1, -2)
        is_rotation = np.abs(products - np.eye(3)).max() < MAX_ROUNDING
    else:
        norms = np.linalg.norm(array, axis=-1)
        is_rotation = array.shape[-1] == 4 and np.abs(norms - 1.0).max() < MAX_ROUNDING
    if is_rotation:
        raise InvalidFileError(
            f"{path} holds rotations without a skeleton, an array of shape {array.shape}. Save"
            " the positions of the joints, shape (frames, joints, 3), or export BVH."
        )


def _read_points(
    path: Path | str,
    points: Array,
    scale: float | None,
    stated: Stated,
    progress: Progress,
) -> JointRecording | Tracks:
    points = np.where(np.isfinite(points).all(axis=-1)[..., None], points, np.nan)
    n_points, rate = points.shape[1], stated.rate or DEFAULT_FRAME_RATE
    is_named = len(stated.names) == n_points
    named = body_of_named_points(stated.names, points) if is_named else None
    if named is not None:
        placed = in_room(named.names, named.positions, stated.roots)
        return stand_body(
            path,
            JointSamples(named.names, placed, frame_rate=rate),
            scale=scale,
            progress=progress,
        )
    body = body_of_points(path, points)
    if body is not None:
        body = body._replace(positions=in_room(body.names, body.positions, stated.roots))
        return read_body(path, body, scale, progress, rate=stated.rate)
    if body is None and has_layout(n_points):
        progress(
            0.9,
            Remark(
                f"The {n_points} points have no names and form no body in a known order; store"
                " the joints as a joint CSV, which has names"
            ),
        )
    return read_freemocap_points(
        path, points, scale, stated.rate or DEFAULT_FRAME_RATE, progress
    )
