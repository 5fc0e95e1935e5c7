"""Let the hips give way to feet that are kept where they stand."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..motion import WorldPoses
from ..signals import FADES

Array = NDArray[np.float64]
STAYING = 10.0
"""How much worse it is to move the hips than to move a knee."""

FADING = 0.04
"""Seconds over which the hips' shift fades."""

STRAIGHTEST = 0.01
"""Metres, for a leg of 0.9 m, by which a knee is at least out of its leg's line."""

REACH = 6
"""Entries above the diagonal: three components, coupled with those of two frames before."""


class LegGoal(NamedTuple):
    """Where a leg should end."""

    chain: tuple[int, int, int]
    """Hip, knee and ankle."""
    ankle: Array
    """Where the ankle should be, shape (n_frames, 3), metres."""


def hips_shift(
    poses: WorldPoses, legs: Sequence[LegGoal], frame_rate: float, size: float
) -> Array:
    """Return a smooth shift of the hips, (n_frames, 3), that spares the knees.

    A leg that is nearly straight bends by six degrees if it gets a millimetre shorter, and
    which way its knee then goes cannot be told; and it gets no longer at all. If the leg is to
    be longer by e along its direction u, and the hips move by s, its knee moves aside by
    (e - u s) d / 4k, where d is the distance of hip and ankle, and k that of the knee from the
    line between them, were thigh and shin of one length. The shift minimises the integral of

        sum over legs |(e - u s) d / 4k|^2 + STAYING (|s|^2 + tau^4 |s''|^2)

    Parameters
    ----------
    poses : WorldPoses
        Before anything is moved.
    legs : sequence of LegGoal
    frame_rate : float, hertz
    size : float
        Of the body: its legs over 0.9 m.
    """
    n_frames = len(poses.positions)
    bands = np.zeros((REACH + 1, 3 * n_frames))
    wish = np.zeros((n_frames, 3))
    _add_bending(bands, STAYING * (FADING / FADES * frame_rate) ** 4)
    bands[REACH] += STAYING
    for leg in legs:
        hip, knee, ankle = (poses.positions[:, joint] for joint in leg.chain)
        way = leg.ankle - hip
        distance = np.linalg.norm(way, axis=1)
        along = way / np.maximum(distance, 1e-9)[:, None]
        weight = _leverage(knee - hip, ankle - knee, size) ** 2
        longer = weight * (distance - np.linalg.norm(ankle - hip, axis=1))
        wish += longer[:, None] * along
        for row in range(3):
            for column in range(row, 3):
                entries = weight * along[:, row] * along[:, column]
                bands[REACH + row - column, column::3] += entries
    return np.asarray(solveh_banded(bands, wish.ravel())).reshape(n_frames, 3)


def _add_bending(bands: Array, weight: float) -> None:
    """Add the squares of second differences over time, for each of three components."""
    n_values = bands.shape[1]
    for place, factor in enumerate((1.0, 4.0, 1.0)):
        bands[REACH, 3 * place : n_values - REACH + 3 * place] += weight * factor
    bands[REACH - 3, 3 : n_values - 3] -= 2.0 * weight
    bands[REACH - 3, 6:] -= 2.0 * weight
    bands[REACH - 6, 6:] += weight


def _leverage(thigh: Array, shin: Array, size: float) -> Array:
    """Return by how much a knee moves aside for each metre that its leg gets shorter."""
    distance = np.linalg.norm(thigh + shin, axis=1)
    twice_area = np.linalg.norm(np.cross(thigh, shin), axis=1)
    aside = twice_area / np.maximum(distance, 1e-9)
    return np.asarray(distance / (4.0 * np.maximum(aside, STRAIGHTEST * size)))
