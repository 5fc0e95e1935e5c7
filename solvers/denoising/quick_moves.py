"""Tell quick but honest moves, such as a foot that strikes the floor, from spikes."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DOUBTED = 0.5
CALM = 0.5
"""Noise, degrees or centimetres, below which single samples can be taken at their word."""
FEW = 0.02
"""Share of outliers up to which neighbouring ones that form a hill by chance are rare."""
STEEP = 0.75
"""Part of its height that a spike rises, and falls, from one frame to the next."""


def quick_moves(error: Array, inlier: Array, noise: Array, rate: float) -> NDArray[np.bool_]:
    """Return which of the doubted samples belong to a move that the recording resolves.

    A spike leaves the estimate with a step and comes back with a step. A hill that is climbed
    and descended gradually is a move that is quicker than was expected. Only in takes of
    little noise and few outliers can the two be told apart frame by frame; elsewhere nothing
    is called a move.

    Parameters
    ----------
    error : shape (n_frames, n_channels), degrees or centimetres
        From the estimate to the samples; NaN where not observed.
    inlier : same shape
        Probability that the sample is none.
    noise : shape (n_channels,)
        Standard deviation.
    rate : float
        Share of outliers in the take.
    """
    found = np.zeros(error.shape, dtype=np.bool_)
    calm = noise < CALM
    if rate > FEW or not calm.any():
        return found
    # One long column, with a frame of nothing before and after each channel.
    height = np.pad(error[:, calm], ((1, 1), (0, 0)), constant_values=np.nan).T.ravel()
    doubted = np.pad(inlier[:, calm] < DOUBTED, ((1, 1), (0, 0))).T.ravel()
    doubted &= np.isfinite(height)
    edges = np.flatnonzero(np.diff(doubted))
    if not edges.size:
        return found
    steps = np.abs(np.diff(height))
    heights = np.maximum.reduceat(np.nan_to_num(np.abs(height)), edges + 1)[::2]
    gradual = (steps[edges[::2]] < STEEP * heights) & (steps[edges[1::2]] < STEEP * heights)
    moves = np.zeros(len(height), dtype=np.int8)
    moves[edges[::2] + 1] = gradual
    moves[edges[1::2] + 1] = -gradual.astype(np.int8)
    found[:, calm] = np.cumsum(moves).reshape(calm.sum(), -1)[:, 1:-1].T > 0
    return found
