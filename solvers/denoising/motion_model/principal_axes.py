"""The axes along which a joint moves most and least."""

import numpy as np

from ...arrays import Array


def principal_axes(samples: Array) -> Array:
    """Return the principal axes of each joint's movement, shape (n_joints, 3, 3).

    The columns are orthonormal, the axis of the largest movement first. They follow the joint's
    own axes: a rig whose bones are turned about their length gets the same movement along them.

    Parameters
    ----------
    samples : shape (n_frames, n_joints, 3), without NaN
    """
    centered = samples - samples.mean(axis=0)
    _, axes = np.linalg.eigh(np.einsum("tjc,tjd->jcd", centered, centered))
    return np.asarray(axes[..., ::-1])
