"""Read freemocap's arrays of points, shape (n_frames, n_points, 3)."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import JointRecording, Sensor, Tracks
from ...motion.humanoid import SIDES
from ...motion.skeletons import BODY_POINTS, COMPUTED_JOINTS, HAND_POINTS
from ...progress import READING, Progress, Remark, unwatched
from ..containers import NPY_MAGIC, read_array
from ..conventions import (
    DEFAULT_FRAME_RATE,
    MILLIMETER,
    axes_of_points,
    check_scale,
    describe_guessed_unit,
    estimate_axes_of_points,
    points_z_up,
    up_along,
)
from ..point_bodies import is_no_body, points_of_array

WITH_HANDS = len(BODY_POINTS) + 2 * len(HAND_POINTS)
FACES = (0, 468, 478)
NOSE, ANKLES = [0], [BODY_POINTS.index(f"{side}_ankle") for side in SIDES]
MAX_EXTENT_M = 20.0
"""Maximum extent of a body in units of the file, for the units to be meters. By definition of
the units: a body of 1 to 3 m is 1000 to 3000 units in millimeters."""


def is_npy(head: bytes) -> bool:
    """Return whether a file is a NumPy array, from its first bytes."""
    return head.startswith(NPY_MAGIC)


def read_freemocap(
    path: Path | str,
    *,
    scale: float | None = None,
    frame_rate: float = DEFAULT_FRAME_RATE,
    progress: Progress = unwatched,
) -> JointRecording | Tracks:
    """Read a `.npy` file of freemocap, in meters, Z up; missing points are NaN.

    The array has neither names, unit, axes nor frame rate. Arrays of 33, 75, 543 or 553 points
    are MediaPipe's body, two hands and face, unless a body cannot be where the first 33 are, as
    those of a calibration board. The order of the hands differs between versions,
    so the hand closer to the left wrist is the left one. The joints in the middle of the body,
    which MediaPipe lacks, are added (`COMPUTED_JOINTS`). Other arrays are points called
    `point_<number>`. The unit is millimeters, unless the extent is that of a body in meters. Up
    of a known body is the direction from its ankles to its nose; of other points it is Y or Z,
    by their extent, and Z of fewer than eight. The heading of the actor is otherwise unchanged.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: millimeters or meters, as described above.
    frame_rate : float, hertz
    progress : Progress

    Returns
    -------
    JointRecording of a body, or Tracks of other points

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds no points.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    points = points_of_array(path, read_array(path))
    return read_freemocap_points(path, points, scale, frame_rate, progress)


def read_freemocap_points(
    path: Path | str,
    points: NDArray[np.float64],
    scale: float | None,
    frame_rate: float,
    progress: Progress,
) -> JointRecording | Tracks:
    """Read points, shape (n_frames, n_points, 3), as `read_freemocap` does."""
    points = np.where(np.isfinite(points).all(axis=-1)[..., None], points, np.nan)
    if np.isnan(points).all():
        raise InvalidFileError(f"{path} has no points that are observed in any frame.")
    progress(0.5, "Reading")
    names = _names(points)
    is_body = names[0] == BODY_POINTS[0]
    unit = _unit(points) if scale is None else scale
    if is_body:
        axes = axes_of_points(up_along(points, NOSE, ANKLES), unit)
    else:
        axes = estimate_axes_of_points(points * unit, "", unit, "Z")
    points = points_z_up(points, axes.up)
    if is_body:
        names, points = with_centers(names, points)
    noted = replace(axes, has_floor=not is_body)
    tracks = Tracks(names, points * unit, frame_rate, conventions=noted)
    guessed = scale is None and is_body
    progress(1.0, Remark(describe_guessed_unit(unit)) if guessed else READING)
    return JointRecording(tracks, None, Sensor.MEDIAPIPE) if is_body else tracks


def with_centers(
    names: tuple[str, ...], points: NDArray[np.float64]
) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """Add the joints in the middle of the body; missing where any of their points is.

    Points have the shape (n_frames, n_points, 3).
    """
    centers = [
        points[:, [BODY_POINTS.index(side) for side in sides]].mean(axis=1)
        for sides in COMPUTED_JOINTS.values()
    ]
    together = np.concatenate([points, np.stack(centers, axis=1)], axis=1)
    return (*names, *COMPUTED_JOINTS), together


def _names(points: NDArray[np.float64]) -> tuple[str, ...]:
    n_points = points.shape[1]
    is_body = n_points == len(BODY_POINTS) or n_points - WITH_HANDS in FACES
    if not is_body or is_no_body(points[:, : len(BODY_POINTS)], BODY_POINTS):
        return tuple(f"point_{number}" for number in range(1, n_points + 1))
    if n_points == len(BODY_POINTS):
        return BODY_POINTS
    hands = [points[:, len(BODY_POINTS)], points[:, len(BODY_POINTS) + len(HAND_POINTS)]]
    wrists = [points[:, BODY_POINTS.index(f"{side}_wrist")] for side in SIDES]
    (first_left, first_right), (second_left, second_right) = (
        [_median_distance(hand, wrist) for wrist in wrists] for hand in hands
    )
    nearer_crossed = (
        first_left - first_right, first_left - second_left,
        second_right - second_left, second_right - first_right,
    )  # fmt: skip
    sides = SIDES if np.nansum(nearer_crossed) < 0.0 else SIDES[::-1]
    named = (f"{side}_hand_{part}" for side in sides for part in HAND_POINTS)
    face = (f"face_{number}" for number in range(1, n_points - WITH_HANDS + 1))
    return (*BODY_POINTS, *named, *face)


def _median_distance(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Return the median distance of two points; NaN if they are never observed together."""
    with np.errstate(over="ignore"):
        distances = np.linalg.norm(one - other, axis=-1)
    known = distances[np.isfinite(distances)]
    return float(np.median(known)) if len(known) else np.nan


def _unit(points: NDArray[np.float64]) -> float:
    """Return the meters per unit of points in units of the file."""
    spread = np.nanquantile(points, [0.05, 0.95], axis=(0, 1))
    with np.errstate(over="ignore"):
        return MILLIMETER if float(np.ptp(spread, axis=0).max()) > MAX_EXTENT_M else 1.0
