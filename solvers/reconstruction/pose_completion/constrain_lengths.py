"""Bones of lost joints keep their lengths, and joints that are trusted their places."""

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS, PARENTS, segment_lengths

Array = NDArray[np.float64]

N_ROUNDS = 30
MAX_STIFFNESS_RATIO = 50.0
"""How many times easier a joint gives way that is not trusted than one that is."""


def constrain_lengths(postures: Array, lengths: Array, trust: Array, sure: Array) -> Array:
    """Return postures in which bones are as long as they should be.

    A bone of which both ends are trusted stays as it was seen, though trackers see its length
    change; one with an end that is not is as long as the actor's. Position-based dynamics
    [1]_: bone after bone, both ends give way, the less sure one more.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), metres
    lengths : shape (20,), metres
    trust : shape (n_frames, 20), 0 to 1
        How far what was seen of each joint is trusted.
    sure : shape (n_frames, 20), 0 to 1
        How sure each joint is, seen or not.

    References
    ----------
    .. [1] Müller, Heidelberger, Hennix, Ratcliff (2007). Position based dynamics. Journal of
       Visual Communication and Image Representation 18(2). doi:10.1016/j.jvcir.2007.01.005
    """
    x = np.array(postures)
    gives = 1.0 / (1.0 / MAX_STIFFNESS_RATIO + np.maximum(trust, sure**2))
    both = np.minimum(trust, trust[:, np.maximum(PARENTS, 0)])
    wanted = (1.0 - both) * lengths + both * segment_lengths(x)
    for _ in range(N_ROUNDS):
        for joint in range(1, N_JOINTS):
            above = PARENTS[joint]
            way = x[:, joint] - x[:, above]
            size = np.maximum(np.linalg.norm(way, axis=-1), 1e-6)
            share = gives[:, joint] + gives[:, above]
            move = ((wanted[:, joint] - size) / size / share)[:, None] * way
            x[:, joint] += gives[:, [joint]] * move
            x[:, above] -= gives[:, [above]] * move
    return x
