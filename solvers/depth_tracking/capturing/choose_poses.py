"""Select one candidate pose per frame, balancing image fit and smoothness."""

import numpy as np

from ...arrays import Array, Integers


def choose_poses(scores: Array, joints: Array, movement_scale: float) -> Integers:
    """Return the index of the selected candidate in each frame, shape (n_frames,).

    The Viterbi algorithm [VIT67]_ minimizes the total cost. Each frame costs one
    minus its score. Each step costs the squared mean movement of the joints over
    `movement_scale`. Swapped limbs must jump back, which costs more than the true trajectory.

    Parameters
    ----------
    scores : shape (n_frames, n_candidates)
        Fit of each candidate to its image, 0 to 1; NaN without a candidate.
    joints : shape (n_frames, n_candidates, n_joints, 3), meters
    movement_scale : float, meters
        Mean movement of the joints between frames that costs 1.

    References
    ----------
    .. [VIT67] Viterbi (1967). Error bounds for convolutional codes and an asymptotically
       optimum decoding algorithm. IEEE Transactions on Information Theory 13(2).
    """
    losses = np.where(np.isfinite(scores), 1.0 - scores, np.inf)
    n_frames, n_candidates = losses.shape
    total, back = losses[0], np.zeros((n_frames, n_candidates), dtype=np.intp)
    for frame in range(1, n_frames):
        offsets = joints[frame][np.newaxis] - joints[frame - 1][:, np.newaxis]
        moved = np.sqrt(np.einsum("abji,abji->abj", offsets, offsets)).mean(axis=-1)
        costs = total[:, np.newaxis] + (np.nan_to_num(moved) / movement_scale) ** 2
        back[frame] = costs.argmin(axis=0)
        total = costs.min(axis=0) + losses[frame]
    chosen = np.empty(n_frames, dtype=np.intp)
    chosen[-1] = total.argmin()
    for frame in range(n_frames - 1, 0, -1):
        chosen[frame - 1] = back[frame, chosen[frame]]
    return chosen


def nearest_tracked(tracked: Integers, n_frames: int) -> Integers:
    """Return the nearest tracked frame for each of (n_frames,); of two, the earlier.

    `tracked` has frames in ascending order.
    """
    frames = np.arange(n_frames)
    after = np.searchsorted(tracked, frames).clip(0, len(tracked) - 1)
    before = (after - 1).clip(0)
    earlier = frames - tracked[before] <= tracked[after] - frames
    nearest: Integers = tracked[np.where(earlier, before, after)]
    return nearest
