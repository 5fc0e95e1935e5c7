"""Offset the pelvis so that planted feet stay reachable."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import solveh_banded

from ..arrays import Array
from ..motion import WorldPoses
from ..signals import FADE_TIME_CONSTANTS, second_difference_bands

PELVIS_WEIGHT = 10.0
"""Cost of a pelvis displacement relative to a knee displacement. Chosen by hand: x0.1 costs
0.2 %, x0.001 costs 2.9 %, x10 costs nothing."""

SMOOTHING_S = 0.04
"""Time constant in seconds of the pelvis offset. It guards recordings of 120 Hz and
more: without it the noise of a nearly straight leg shakes the pelvis."""

MIN_KNEE_OFFSET_M = 0.01
"""Minimum distance of a knee from the line of its leg in meters, for legs of 0.9 m. It guards a
division where a knee is straight."""

N_BANDS = 6
"""Bands above the diagonal: three components, coupled with those of two frames before."""


class LegGoal(NamedTuple):
    """Goal of a leg's ankle."""

    chain: tuple[int, int, int]
    """Hip, knee and ankle."""
    ankle: Array
    """Goal positions of the ankle, shape (n_frames, 3), meters."""


def solve_pelvis_offset(
    poses: WorldPoses, legs: Sequence[LegGoal], frame_rate: float, size: float
) -> Array:
    """Return a smooth offset of the pelvis, (n_frames, 3), that minimizes knee displacement.

    A nearly straight leg flexes by six degrees if it gets a millimeter shorter, in an ambiguous
    direction, and it cannot get longer. Let a leg be longer by e along its direction u, and the
    pelvis move by s. Its knee then moves aside by (e - u s) d / 4k, for thigh and shin of equal
    length: d is the distance of hip and ankle, and k that of the knee from the line between
    them. The offset minimizes the integral of

        sum over legs |(e - u s) d / 4k|^2 + PELVIS_WEIGHT (|s|^2 + tau^4 |s''|^2)

    Parameters
    ----------
    poses : WorldPoses
        Before any correction.
    legs : sequence of LegGoal
    frame_rate : float, hertz
    size : float
        Of the body: its legs over 0.9 m.
    """
    n_frames = len(poses.positions)
    bands = np.zeros((N_BANDS + 1, 3 * n_frames))
    right_side = np.zeros((n_frames, 3))
    curvature_weight = PELVIS_WEIGHT * (SMOOTHING_S / FADE_TIME_CONSTANTS * frame_rate) ** 4
    bands[::3] = curvature_weight * np.repeat(second_difference_bands(n_frames), 3, axis=1)
    bands[N_BANDS] += PELVIS_WEIGHT
    for leg in legs:
        hip, knee, ankle = (poses.positions[:, joint] for joint in leg.chain)
        leg_vectors = leg.ankle - hip
        distance = np.linalg.norm(leg_vectors, axis=1)
        directions = leg_vectors / np.maximum(distance, 1e-9)[:, None]
        weight = _knee_leverage(knee - hip, ankle - knee, size) ** 2
        weighted_stretch = weight * (distance - np.linalg.norm(ankle - hip, axis=1))
        right_side += weighted_stretch[:, None] * directions
        for row in range(3):
            for column in range(row, 3):
                entries = weight * directions[:, row] * directions[:, column]
                bands[N_BANDS + row - column, column::3] += entries
    return np.asarray(solveh_banded(bands, right_side.ravel())).reshape(n_frames, 3)


def _knee_leverage(thigh: Array, shin: Array, size: float) -> Array:
    """Return the sideways knee displacement per meter of leg shortening."""
    distance = np.linalg.norm(thigh + shin, axis=1)
    twice_area = np.linalg.norm(np.cross(thigh, shin), axis=1)
    knee_offsets = twice_area / np.maximum(distance, 1e-9)
    return np.asarray(distance / (4.0 * np.maximum(knee_offsets, MIN_KNEE_OFFSET_M * size)))
