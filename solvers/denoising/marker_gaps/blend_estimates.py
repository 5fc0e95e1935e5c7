"""Average several estimates of one thing, weighted by what each got wrong when tried."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

Array = NDArray[np.float64]

INDEPENDENT_FRACTION = 0.3
"""Share of each estimate's own error that is held to be independent of all others, besides."""
MIN_SQUARED_ERROR = 1e-9
"""Square metres: errors below 0.03 mm are the same."""
SUM_WEIGHT = 100.0
"""How much heavier than the errors it weighs that the weights add up to one."""


def blend_weights(trials: Sequence[Array]) -> Array:
    """Return the weights, none below zero, whose average errs least where it was tried.

    Errors that estimates share do not average out; those that differ do. So the errors'
    products count, not only their sizes [1]_, and no weight is negative [2]_. The products are
    known from few frames: every estimate is doubted a little more than they say.

    Parameters
    ----------
    trials : sequence of arrays, shape (n_frames, 3), metres
        What each estimate got wrong in the same frames.

    Returns
    -------
    shape (n_estimates,)

    References
    ----------
    .. [1] Bates, Granger (1969). The combination of forecasts. doi:10.1057/jors.1969.103
    .. [2] Breiman (1996). Stacked regressions. doi:10.1007/BF00117832
    """
    errors = np.array(trials).reshape(len(trials), -1)
    products = errors @ errors.T / len(trials[0])
    squares = np.diag(products) + MIN_SQUARED_ERROR
    products += np.diag(MIN_SQUARED_ERROR + INDEPENDENT_FRACTION * squares)
    root = np.linalg.cholesky(products / squares.min()).T
    target = np.zeros(len(root) + 1)
    target[-1] = SUM_WEIGHT
    weights, _ = nnls(np.vstack([root, np.full(len(root), SUM_WEIGHT)]), target)
    return np.asarray(weights / weights.sum())
