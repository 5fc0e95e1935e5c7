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
"""Part of its height that a spike rises, or falls, from one frame to the next."""
LONG = 3
"""Frames from which on noise cannot give a spike gentle slopes by chance."""


def quick_moves(error: Array, inlier: Array, noise: Array, rate: float) -> NDArray[np.bool_]:
    """Return which of the doubted samples belong to a move that the recording resolves.

    A spike leaves the estimate with a step and comes back with a step. A hill that is climbed
    and descended gradually is a move that is quicker than was expected: so is one that has no
    step anywhere, in takes of any noise, where it lasts for LONG frames. In takes of little
    noise and few outliers its first and last step are enough.

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
    # One long column, with a frame of nothing before and after each channel.
    height = np.pad(error, ((1, 1), (0, 0)), constant_values=np.nan).T.ravel()
    doubted = np.pad(inlier < DOUBTED, ((1, 1), (0, 0))).T.ravel()
    doubted &= np.isfinite(height)
    edges = np.flatnonzero(np.diff(doubted))
    if not edges.size:
        return found
    steps = np.nan_to_num(np.abs(np.diff(height, append=np.nan)), nan=np.inf)
    first, last = edges[::2], edges[1::2]
    heights = np.maximum.reduceat(np.nan_to_num(np.abs(height)), edges + 1)[::2]
    steepest = np.maximum.reduceat(steps, np.stack([first, last + 1], 1).ravel())[::2]
    calm = np.repeat((noise < CALM) & (rate <= FEW), len(error) + 2)[first]
    gradual = np.maximum(steps[first], steps[last]) < STEEP * heights
    smooth = (steepest < STEEP * heights) & (last - first >= LONG)
    moves = np.zeros(len(height), dtype=np.int8)
    is_move = (calm & gradual) | smooth
    moves[first + 1] = is_move
    moves[last + 1] = -is_move.astype(np.int8)
    return np.asarray(np.cumsum(moves).reshape(error.shape[1], -1)[:, 1:-1].T > 0)
