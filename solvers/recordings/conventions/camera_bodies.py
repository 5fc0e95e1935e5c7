"""Put bodies of cameras upright whose files do not state their axes."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from .axes import z_up_from_y_up

MIN_MIRRORED_FRACTION = 0.8
"""Fraction of the frames in which left and right are exchanged, of mirrored axes."""


def stand_along(points: Array, high: Sequence[int], low: Sequence[int]) -> Array:
    """Rotate points so that some of them are above others, by quarter turns.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3)
    high, low : indices of points, such as of the head and of both ankles

    Returns
    -------
    The points, unchanged if none of them are observed together.
    """
    displacements = points[:, high].mean(axis=1)[:, None] - points[:, low]
    known = displacements[np.isfinite(displacements).all(axis=-1)]
    if not len(known):
        return points
    up = np.median(known, axis=0)
    axis = int(np.argmax(np.abs(up)))
    if axis == 0:
        points = np.roll(points, -1, axis=-1)  # x y z -> y z x
    elif axis == 1:
        points = z_up_from_y_up(points)
    return np.asarray(points * (1.0, -1.0, -1.0)) if up[axis] < 0.0 else points


def is_mirrored(points: Array, left: int, right: int, back: int, front: int) -> bool:
    """Whether the left side is on the right in most frames, as in left-handed axes.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), Z up
    left, right : indices of points beside each other, such as the shoulders
    back, front : indices of points one before the other, such as an ear and the nose
    """
    across, ahead = (
        points[:, one, :2] - points[:, other, :2]
        for one, other in ((left, right), (front, back))
    )
    turn = across[:, 0] * ahead[:, 1] - across[:, 1] * ahead[:, 0]
    turn = turn[np.isfinite(turn) & (turn != 0.0)]
    return bool(len(turn) and (turn > 0.0).mean() > MIN_MIRRORED_FRACTION)
