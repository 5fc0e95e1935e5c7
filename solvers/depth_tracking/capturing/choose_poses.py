"""Choose one of several poses per frame, so that a take fits its pictures and goes smoothly."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.intp]


def choose_poses(scores: Array, joints: Array, sharpness: float, reach: float) -> Integers:
    """Return which candidate to take in each frame, shape (n_frames,).

    The choice costs least in total [VIT67]_: each frame what its picture lacks, times
    `sharpness`, and each step the squared movement of the joints over `reach`. Limbs that were
    mistaken for each other have to jump back, which costs more than the true course.

    Parameters
    ----------
    scores : shape (n_frames, n_candidates)
        How well each fits its picture, 0 to 1; NaN where there is no such candidate.
    joints : shape (n_frames, n_candidates, n_joints, 3), metres
    sharpness : float
    reach : float, metres
        Mean movement of the joints between frames that costs 1.

    References
    ----------
    .. [VIT67] Viterbi (1967). Error bounds for convolutional codes and an asymptotically
       optimum decoding algorithm. IEEE Transactions on Information Theory 13(2).
    """
    losses = np.where(np.isfinite(scores), sharpness * (1.0 - scores), np.inf)
    n_frames, n_candidates = losses.shape
    total, back = losses[0], np.zeros((n_frames, n_candidates), dtype=np.intp)
    for frame in range(1, n_frames):
        apart = joints[frame][np.newaxis] - joints[frame - 1][:, np.newaxis]
        moved = np.sqrt(np.einsum("abji,abji->abj", apart, apart)).mean(axis=-1)
        ways = total[:, np.newaxis] + (np.nan_to_num(moved) / reach) ** 2
        back[frame] = ways.argmin(axis=0)
        total = ways.min(axis=0) + losses[frame]
    chosen = np.empty(n_frames, dtype=np.intp)
    chosen[-1] = total.argmin()
    for frame in range(n_frames - 1, 0, -1):
        chosen[frame - 1] = back[frame, chosen[frame]]
    return chosen


def nearest_known(known: Integers, n_frames: int) -> Integers:
    """Return the nearest of some ascending frames for every frame, the earlier of two."""
    frames = np.arange(n_frames)
    after = np.searchsorted(known, frames).clip(0, len(known) - 1)
    before = (after - 1).clip(0)
    earlier = frames - known[before] <= known[after] - frames
    nearest: Integers = known[np.where(earlier, before, after)]
    return nearest
