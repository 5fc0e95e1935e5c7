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
MOST = 0.6
"""Share of what is observed in a window that cannot all be errors."""
LONG = 3
"""Frames from which on noise cannot give a spike gentle slopes by chance."""


def quick_moves(
    error: Array, inlier: Array, noise: Array, rate: float, window: int
) -> NDArray[np.bool_]:
    """Return which of the doubted samples belong to a move that the recording resolves.

    A spike leaves the estimate with a step and comes back with a step. A hill that is climbed
    and descended gradually is a move that is quicker than was expected: so is one that has no
    step anywhere, in takes of any noise, where it lasts for LONG frames. In takes of little
    noise and few outliers its first and last step are enough. And where nearly all that was
    observed over a whole window is doubted, it is the estimate that is wrong.

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
    steepest = np.maximum.reduceat(steps, np.stack([first, last + 1], 1).ravel())[::2]
    calm = np.repeat((noise < CALM) & (rate <= FEW), len(error) + 2)[first]
    gradual = np.maximum(steps[first], steps[last]) < STEEP * heights
    smooth = (steepest < STEEP * heights) & (last - first >= LONG)
    moves = np.zeros(len(height), dtype=np.int8)
    is_move = (calm & gradual) | smooth
    moves[first + 1] = is_move
    moves[last + 1] = -is_move.astype(np.int8)
    hills = np.cumsum(moves).reshape(error.shape[1], -1)[:, 1:-1].T > 0
    return np.asarray(hills | _lasting(inlier < DOUBTED, error, window))


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
