"""Average several estimates with weights from their held-out errors (stacking)."""

from collections.abc import Sequence

import numpy as np
import scipy

from ...arrays import Array

INDEPENDENT_FRACTION = 0.3
"""Fraction of each estimate's error variance, added as independent of all others. Half and
twice gain less than 1 % (`make sensitivity`)."""
MIN_SQUARED_ERROR = 1e-9
"""Square meters: errors below 0.03 mm are the same. Guards a singular matrix."""


def blend_weights(trials: Sequence[Array]) -> Array:
    """Return non-negative weights whose average has the least held-out error.

    Errors common to all estimates do not average out; different errors do. Therefore the
    products of the errors count, not only their sizes [1]_, and no weight is negative [2]_. The
    products come from few frames, so the variance of each estimate is increased a little. The
    minimum over weights that sum to one is that of w'Pw - 2 sum(w), scaled to that sum.

    Parameters
    ----------
    trials : sequence of arrays, shape (n_frames, 3), meters
        Error of each estimate in the same frames.

    Returns
    -------
    shape (n_estimates,)

    References
    ----------
    .. [1] Bates, Granger (1969). The combination of forecasts. doi:10.1057/jors.1969.103
    .. [2] Breiman (1996). Stacked regressions. doi:10.1007/BF00117832
    """
    from scipy.optimize import nnls  # slow to import: only when needed

    errors = np.array(trials).reshape(len(trials), -1)
    products = errors @ errors.T / len(trials[0])
    squares = np.diag(products) + MIN_SQUARED_ERROR
    products += np.diag(MIN_SQUARED_ERROR + INDEPENDENT_FRACTION * squares)
    root = np.linalg.cholesky(products / squares.min())
    weights, _ = nnls(
        root.T, scipy.linalg.solve_triangular(root, np.ones(len(root)), lower=True)
    )
    return np.asarray(weights / weights.sum())
