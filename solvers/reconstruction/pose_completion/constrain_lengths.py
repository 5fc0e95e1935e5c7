"""Constrain bone lengths of missing joints, and retain the positions of reliable joints."""

import numpy as np

from ...arrays import Array
from ...motion.humanoid import N_JOINTS, PARENTS, segment_lengths

N_ROUNDS = 30
"""Number of passes over all bones. It bounds the run time. Chosen by hand: x0.5 costs nothing,
x2 costs nothing."""


def constrain_lengths(
    postures: Array, lengths: Array, reliability: Array, confidence: Array
) -> Array:
    """Return poses with corrected bone lengths.

    A bone with two reliable ends keeps its observed length, although trackers let lengths vary.
    Other bones get the actor's length. Position-based dynamics [1]_ moves both ends of one bone
    after another, the end of lower confidence more.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
    lengths : shape (20,), meters
    reliability : shape (n_frames, 20), 0 to 1
        Reliability of the observation of each joint.
    confidence : shape (n_frames, 20), above 0, at most 1
        Confidence of each joint, observed or not.

    References
    ----------
    .. [1] Müller, Heidelberger, Hennix, Ratcliff (2007). Position based dynamics. Journal of
       Visual Communication and Image Representation 18(2). doi:10.1016/j.jvcir.2007.01.005
    """
    x = np.array(postures)
    mobility = 1.0 / np.maximum(reliability, confidence**2)
    bone_reliability = np.minimum(reliability, reliability[:, np.maximum(PARENTS, 0)])
    target_lengths = (1.0 - bone_reliability) * lengths + bone_reliability * segment_lengths(x)
    for _ in range(N_ROUNDS):
        for joint in range(1, N_JOINTS):
            above = PARENTS[joint]
            bone = x[:, joint] - x[:, above]
            length = np.maximum(np.linalg.norm(bone, axis=-1), 1e-6)
            total_mobility = mobility[:, joint] + mobility[:, above]
            move = ((target_lengths[:, joint] - length) / length / total_mobility)[
                :, None
            ] * bone
            x[:, joint] += mobility[:, [joint]] * move
            x[:, above] -= mobility[:, [above]] * move
    return x
