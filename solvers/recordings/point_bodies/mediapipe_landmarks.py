"""Names, axes and the check for flat landmarks for all readers of MediaPipe's landmarks."""

import re
from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...motion.skeletons import BODY_POINTS, COMPUTED_JOINTS

N_POINTS = len(BODY_POINTS)
LANDMARK_JOINTS = (*BODY_POINTS, *COMPUTED_JOINTS)
HIPS = [BODY_POINTS.index("left_hip"), BODY_POINTS.index("right_hip")]
MAX_CENTER_FRACTION = 0.2
"""Distance of the middle of the hips from the origin, relative to the size of the body, up to
which landmarks are those of the world, whose origin is there. Measured: in a picture, whose
origin is a corner, it is 0.5 and more, since hips are in the middle of a body."""
MIN_INSIDE = 0.95
"""Coordinates in a picture, a fraction of all. It guards takes of scenes, with a third and more
outside; MediaPipe also guesses limbs that leave the picture."""


WORD_START = re.compile(r"[ \-]|(?<=[a-z])(?=[A-Z])")


def landmark_columns(names: Sequence[str]) -> list[int] | None:
    """Return the columns of MediaPipe's landmarks; None if a name of them is missing.

    All may begin with the same words, as with `body_` next to the hands of freemocap.
    """
    plain = {WORD_START.sub("_", name.rpartition(".")[2]).lower(): at
             for at, name in reversed([*enumerate(names)])}  # fmt: skip
    starts = {
        name.removesuffix(BODY_POINTS[0]) for name in plain if name.endswith(BODY_POINTS[0])
    }
    for start in sorted(starts, key=len):
        columns = [plain.get(start + name) for name in BODY_POINTS]
        if None not in columns:
            return [at for at in columns if at is not None]
    return None


def is_world(points: Array) -> bool:
    """Return whether landmarks, shape (n_frames, 33, 3), are in the world, not in a picture."""
    center = points[:, HIPS].mean(axis=1)
    size = _size(points)
    known = np.isfinite(center).all(axis=1) & (size > 0.0)
    if not known.any():
        return False
    away = np.linalg.norm(center[known], axis=1) / size[known]
    return bool(np.median(away) <= MAX_CENTER_FRACTION)


def _size(points: Array) -> Array:
    """Return the largest side of the box around the landmarks of each frame, (n_frames,)."""
    box = np.fmax.reduce(points, axis=1) - np.fmin.reduce(points, axis=1)
    return np.asarray(box.max(axis=1))


def is_normalized(points: Array) -> bool:
    """Return whether 33 landmarks, shape (n_frames, 33, 3), are fractions of a picture's size.

    A person of 1.5 m and more who stands in a scene exceeds 0 to 1 meter.
    """
    return is_inside_picture(points) and not is_world(points)


def is_inside_picture(points: Array) -> bool:
    """Return whether x and y of points, shape (..., 3), are fractions of a picture's size."""
    flat = points[..., :2][np.isfinite(points).all(axis=-1)]
    inside = (flat >= 0.0) & (flat <= 1.0)
    return bool(inside.mean() >= MIN_INSIDE)


def is_of_picture(points: Array) -> bool:
    """Return whether landmarks that are not of the world are of a picture, without true depth.

    They are fractions of its width and height, or pixels with depths relative to the hips.

    Parameters
    ----------
    points : shape (n_frames, 33, 3)
    """
    depth, size = points[:, HIPS, 2].mean(axis=1), _size(points)
    known = np.isfinite(depth) & (size > 0.0)
    relative = np.abs(depth[known]) <= MAX_CENTER_FRACTION * size[known]
    return is_normalized(points) or not known.any() or bool(np.median(relative))


def with_computed_joints(values: Array) -> Array:
    """Add the mean of the landmarks next to each computed joint, missing where one of them is.

    Parameters
    ----------
    values : shape (n_frames, 33, ...)

    Returns
    -------
    Array, shape (n_frames, n_joints, ...)
        Those of `LANDMARK_JOINTS`.
    """
    groups = [[BODY_POINTS.index(side) for side in sides] for sides in COMPUTED_JOINTS.values()]
    means = [values[:, group].mean(axis=1) for group in groups]
    return np.concatenate([values, np.stack(means, axis=1)], axis=1)
