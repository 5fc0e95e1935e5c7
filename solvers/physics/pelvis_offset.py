"""Offset the pelvis so that planted feet stay reachable."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..motion import WorldPoses

PELVIS_WEIGHT = 10.0
"""Cost of a pelvis displacement relative to a knee displacement. Chosen by hand: x0.1 costs
0.2 %, x0.001 costs 2.9 %, x10 costs nothing."""

MIN_KNEE_OFFSET_M = 0.01
"""Minimum distance of a knee from the line of its leg in meters, for legs of 0.9 m. It guards a
division where a knee is straight."""


class LegGoal(NamedTuple):
    """Goal of a leg's ankle."""

    chain: tuple[int, int, int]
    """Hip, knee and ankle."""
    ankle: Array
    """Goal positions of the ankle, shape (n_frames, 3), meters."""


def solve_pelvis_offset(poses: WorldPoses, legs: Sequence[LegGoal], size: float) -> Array:
    """Return the offset of the pelvis, (n_frames, 3), that minimizes knee displacement.

    A nearly straight leg flexes by six degrees if it gets a millimeter shorter, in an ambiguous
    direction, and it cannot get longer. Let a leg be longer by e along its direction u, and the
    pelvis move by s. Its knee then moves aside by (e - u s) d / 4k, for thigh and shin of equal
    length: d is the distance of hip and ankle, and k that of the knee from the line between
    them. In each frame the offset minimizes

        sum over legs |(e - u s) d / 4k|^2 + PELVIS_WEIGHT |s|^2

    Parameters
    ----------
    poses : WorldPoses
        Before any correction.
    legs : sequence of LegGoal
    size : float
        Of the body: its legs over 0.9 m.
    """
    n_frames = len(poses.positions)
    stiffness = np.tile(PELVIS_WEIGHT * np.eye(3), (n_frames, 1, 1))
    right_side = np.zeros((n_frames, 3))
    for leg in legs:
        hip, knee, ankle = (poses.positions[:, joint] for joint in leg.chain)
        leg_vectors = leg.ankle - hip
        distance = np.linalg.norm(leg_vectors, axis=1)
        directions = leg_vectors / np.maximum(distance, 1e-9)[:, None]
        weight = _knee_leverage(knee - hip, ankle - knee, size) ** 2
        weighted_stretch = weight * (distance - np.linalg.norm(ankle - hip, axis=1))
        right_side += weighted_stretch[:, None] * directions
        stiffness += np.einsum("f,fi,fj->fij", weight, directions, directions)
    return np.asarray(np.linalg.solve(stiffness, right_side[..., None])[..., 0])


def _knee_leverage(thigh: Array, shin: Array, size: float) -> Array:
    """Return the sideways knee displacement per meter of leg shortening."""
    distance = np.linalg.norm(thigh + shin, axis=1)
    twice_area = np.linalg.norm(np.cross(thigh, shin), axis=1)
    knee_offsets = twice_area / np.maximum(distance, 1e-9)
    return np.asarray(distance / (4.0 * np.maximum(knee_offsets, MIN_KNEE_OFFSET_M * size)))
