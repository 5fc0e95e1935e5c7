"""Constrain bone lengths of missing joints, and retain the positions of reliable joints."""

from typing import Any

import numpy as np

from ...arrays import Array
from ...motion.humanoid import N_JOINTS, PARENTS, segment_lengths

N_ROUNDS = 30
"""Number of passes over all bones. It bounds the run time."""

MIN_LENGTH_M = 1e-6
"""Meters: length of a bone whose ends are at one place. It guards a division."""


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
    mobility = 1.0 / np.maximum(reliability, confidence**2)
    bone_reliability = np.minimum(reliability, reliability[:, np.maximum(PARENTS, 0)])
    observed_lengths = segment_lengths(postures)
    target_lengths = (1.0 - bone_reliability) * lengths + bone_reliability * observed_lengths
    if len(postures) == 1:  # live: plain numbers take a tenth of the time of short arrays
        _constrain(x := postures[0].tolist(), mobility[0].tolist(), target_lengths[0].tolist())
        return np.array(x)[None]
    x = np.moveaxis(np.array(postures), 0, -1)
    _constrain(x, mobility.T, target_lengths.T)
    return np.ascontiguousarray(np.moveaxis(x, -1, 0))


def _constrain(x: Any, mobility: Any, lengths: Any) -> None:
    """Move the joints of one frame, or of all: joint by joint, lists of numbers or arrays."""
    for _ in range(N_ROUNDS):
        for joint in range(1, N_JOINTS):
            above = PARENTS[joint]
            bone = [end - start for end, start in zip(x[joint], x[above], strict=True)]
            length = (bone[0] * bone[0] + bone[1] * bone[1] + bone[2] * bone[2]) ** 0.5
            length = length + MIN_LENGTH_M * (length == 0.0)
            total = mobility[joint] + mobility[above]
            factor = (lengths[joint] - length) / length / total
            for axis, part in enumerate(bone):
                move = factor * part
                x[joint][axis] = x[joint][axis] + mobility[joint] * move
                x[above][axis] = x[above][axis] - mobility[above] * move
