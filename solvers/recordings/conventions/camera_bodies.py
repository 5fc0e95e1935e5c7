"""Rotate bodies upright if the file of their camera does not state its axes."""

from collections.abc import Sequence
from typing import cast

import numpy as np

from ...arrays import Array
from ...motion import AxisName
from .points import points_z_up

MIN_MIRRORED_FRACTION = 0.8
"""Fraction of the frames in which left and right are swapped, of mirrored axes. Chosen by
hand: x2 fails `test_a_body_of_the_zed_stands_in_any_axes`."""


def up_along(points: Array, high: Sequence[int], low: Sequence[int]) -> AxisName:
    """Return the axis along which some points are above others; Z if none are observed.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3)
    high, low : indices of points, such as of the head and of both ankles
    """
    displacements = points[:, high].mean(axis=1)[:, None] - points[:, low]
    known = displacements[np.isfinite(displacements).all(axis=-1)]
    if not len(known):
        return "Z"
    up = np.median(known, axis=0)
    axis = int(np.argmax(np.abs(up)))
    return cast(AxisName, ("-" if up[axis] < 0.0 else "") + "XYZ"[axis])


def stand_along(points: Array, high: Sequence[int], low: Sequence[int]) -> Array:
    """Rotate points (n_frames, n_points, 3) by quarter turns: some are above others.

    `high` and `low` are their indices (`up_along`).
    """
    return points_z_up(points, up_along(points, high, low))


def is_mirrored(points: Array, left: int, right: int, back: int, front: int) -> bool:
    """Whether the left side is on the right in most frames, as in left-handed axes.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), Z up
    left, right : indices of points on the left and the right, such as the shoulders
    back, front : indices of points behind and in front, such as an ear and the nose
    """
    across, ahead = (
        points[:, one, :2] - points[:, other, :2]
        for one, other in ((left, right), (front, back))
    )
    handedness = across[:, 0] * ahead[:, 1] - across[:, 1] * ahead[:, 0]
    handedness = handedness[np.isfinite(handedness) & (handedness != 0.0)]
    return bool(len(handedness) and (handedness > 0.0).mean() > MIN_MIRRORED_FRACTION)
