"""How much an estimate follows the noise of its own take."""

import numpy as np

from ...arrays import Array


def leverage(residual: Array, leave_one_out_error: Array) -> Array:
    """Return the weight, 0 to 1, of each sample in its own estimate, from both of its errors.

    Both have the shape of the samples; a leave-one-out error of 0 or NaN gives weight 1.
    """
    known = np.isfinite(leave_one_out_error) & (leave_one_out_error != 0.0)
    ratio = np.divide(residual, leave_one_out_error, out=np.zeros_like(residual), where=known)
    return np.asarray(np.clip(1.0 - ratio, 0.0, 1.0))
