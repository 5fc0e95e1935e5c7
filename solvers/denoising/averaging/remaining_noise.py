"""Estimate the noise of a take from the remainder of its best estimate."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..channels import Estimate, Smoothed
from ..motion_model import MAX_CONSTANT_RANGE
from .leverage import leverage

MIN_NOISE = 1e-3
"""Degrees or centimeters: smaller noise is that of rounding in files. Guards a division."""


def noise_factors(
    noise: Array,
    complete: Array,
    candidates: Sequence[Estimate | Smoothed],
    is_good: NDArray[np.bool_],
) -> Array:
    """Return how much smaller the noise is than third differences say, shape (n_channels,).

    They take fast movement for noise, which would then be smoothed away. What the best of the
    candidates leaves holds less movement. They may follow noise, too: no joint's factor is less
    than the median of all channels.
    """
    moves = np.ptp(complete, axis=0) > MAX_CONSTANT_RANGE
    if not moves.any():
        return np.ones_like(noise)
    factors = [_noise_factors_of(noise, complete, each, is_good, moves) for each in candidates]
    return np.asarray(np.min(factors, axis=0))


def _noise_factors_of(
    noise: Array,
    complete: Array,
    candidate: Estimate | Smoothed,
    is_good: NDArray[np.bool_],
    moves: NDArray[np.bool_],
) -> Array:
    residuals = np.where(is_good, complete - candidate.values, 0.0)
    free = np.where(is_good, 1.0 - leverage(residuals, candidate.leave_one_out_error), 0.0)
    left = np.sqrt((residuals**2).sum(axis=0) / np.maximum(free.sum(axis=0), 1.0))
    logs = np.log(np.maximum(left, MIN_NOISE) / noise)
    of_joints = np.where(moves, logs, 0.0).reshape(-1, 3).sum(axis=1)
    of_joints /= np.maximum(moves.reshape(-1, 3).sum(axis=1), 1)
    logs = np.maximum(np.repeat(of_joints, 3), np.median(logs[moves]))
    return np.asarray(np.exp(np.minimum(logs, 0.0)))
