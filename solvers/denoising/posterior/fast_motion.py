"""Tell quick but honest moves, such as a foot that strikes the floor, from spikes."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

Array = NDArray[np.float64]

DOUBTED = 0.5
CALM = 0.5
"""Noise, degrees or centimetres, below which single samples can be taken at their word."""
FEW = 0.02
"""Share of outliers up to which neighbouring ones that form a hill by chance are rare."""
STEEP = 0.75
"""Part of its height that a spike rises, or falls, from one frame to the next."""
GENTLE = 0.5
"""The same, of the way from its lowest to its highest, that no step of a move makes up."""
LONG, LONG_PART = 3, 0.15
"""Frames, and part of a window, from which on noise cannot give a spike gentle slopes."""
MOST, LASTING = 0.6, 15
"""Share of what is observed around a frame, over a window but at least so many frames, that
cannot all be errors."""


def quick_moves(
    error: Array, inlier: Array, noise: Array, rate: float, window: int
) -> NDArray[np.bool_]:
    """Return which of the doubted samples belong to a move that the recording resolves.

    A spike leaves the estimate with a step and comes back with a step; also one that a filter
    softened a little. A hill that is climbed and descended gradually is a move that is quicker
    than was expected. In takes of little noise and few outliers its first and last step tell,
    elsewhere it must last and have no steep step at all. And where most of what was observed
    around a frame is doubted, it is the estimate that is wrong.

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
    window : int, frames
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
    highest = np.maximum.reduceat(np.nan_to_num(height), edges + 1)[::2]
    lowest = np.minimum.reduceat(np.nan_to_num(height), edges + 1)[::2]
    spans = np.maximum(highest, 0.0) - np.minimum(lowest, 0.0)
    steepest = np.maximum.reduceat(steps, np.stack([first, last + 1], 1).ravel())[::2]
    long = max(LONG, round(LONG_PART * window))
    calm = np.repeat((noise < CALM) & (rate <= FEW), len(error) + 2)[first]
    gradual = np.maximum(steps[first], steps[last]) < STEEP * heights
    smooth = (steepest < GENTLE * spans) & (last - first >= long)
    moves = np.zeros(len(height), dtype=np.int8)
    is_move = (calm & gradual) | smooth
    moves[first + 1] = is_move
    moves[last + 1] = -is_move.astype(np.int8)
    hills = np.cumsum(moves).reshape(error.shape[1], -1)[:, 1:-1].T > 0
    return np.asarray(hills | _lasting(inlier < DOUBTED, error, max(window, LASTING)))


def _lasting(doubted: NDArray[np.bool_], error: Array, window: int) -> NDArray[np.bool_]:
    """Return what is doubted where, over a window, most of what was observed is."""
    known = np.isfinite(error)
    doubted = known & doubted
    share_known, share_doubted = (
        uniform_filter1d(each.astype(float), window, axis=0, mode="constant")
        for each in (known, doubted)
    )
    lasts = (share_doubted > MOST * share_known) & (share_known > 0.5)
    return np.asarray(doubted & lasts)
