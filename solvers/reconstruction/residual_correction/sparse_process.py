"""Sparse Gaussian process of one joint, by inducing points.

FITC [1]_: values at inducing points define the process. The remaining variance at an example
counts as independent noise of that example.

.. [1] Snelson, Ghahramani (2006). Sparse Gaussian processes using pseudo-inputs. NIPS 18.
"""

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from .kernel import Kernel, squared_distances, squared_exponential

REGULARIZATION = 1e-6
"""Added to the diagonal of a covariance, relative to the variance. It guards a
factorization."""
MEAN_VARIANCE = 1e4
"""Prior variance of the mean error in square meters. By definition uninformative: any value as
large gives the same."""


def inducing_points(features: Array, count: int, seed: int) -> Array:
    """Return at most `count` of the features, (n, n_features): cluster centers (k-means)."""
    distinct = np.unique(features, axis=0)
    if len(distinct) <= count:
        return distinct
    centers, _ = scipy.cluster.vq.kmeans2(
        features, count, iter=5, minit="++", seed=np.random.default_rng(seed)
    )
    return np.asarray(centers)


def cholesky_root(points: Array, length: float) -> Array:
    """Return the lower triangular root, (n, n), of the covariance of inducing points."""
    return np.linalg.cholesky(
        squared_exponential(points, points, length) + REGULARIZATION * np.eye(len(points))
    )


def basis_functions(features: Array, points: Array, length: float) -> Array:
    """Return functions of unit prior variance whose sum is the process, (n, n_points)."""
    root = cholesky_root(points, length)
    return basis_values(squared_distances(features, points), length, root)


def basis_values(squared: Array, length: float, root: Array) -> Array:
    """Return what `basis_functions` does, from distances and a root that are already computed.

    `squared` are the squared distances from the points, (n_frames, n); `root` is their
    `cholesky_root`, (n, n).
    """
    values = np.exp(-0.5 * squared / length**2)
    # The transposed root is in the order of LAPACK, which would copy the root itself.
    solution, _ = scipy.linalg.lapack.dtrtrs(root.T, values.T, lower=0, trans=1)
    return np.asarray(solution.T)


def posterior(
    bases: Sequence[Array],
    errors: Array,
    takes: NDArray[np.int64],
    actors: NDArray[np.int64],
    kernel: Kernel,
    repeats: float,
) -> tuple[Array, Array]:
    """Return posterior mean and covariance of the weights of shared functions and mean error.

    Parameters
    ----------
    bases : local and complete-pose bases from `basis_functions`
    errors : shape (n, 3), meters
    takes, actors : shape (n,), int, counted from 0
    kernel : Kernel
    repeats : float
        Number of examples that carry the information of one, since adjacent frames correlate.

    Returns
    -------
    mean : shape (n_weights, 3)
    covariance : shape (n_weights, n_weights)
    """
    open_variance = sum(
        (shared + personal) * np.maximum(1.0 - (one**2).sum(axis=1), 0.0)
        for one, shared, personal in zip(bases, kernel.shared, kernel.personal, strict=True)
    )
    scale = 1.0 / np.sqrt(open_variance + repeats * kernel.noise)[:, None]
    columns = shared_design(bases, kernel)
    n_shared = columns.shape[1]
    blocks = [columns]
    for actor in range(int(actors.max()) + 1):
        is_actor = (actors == actor)[:, None]
        blocks += [
            np.sqrt(personal) * one * is_actor
            for one, personal in zip(bases, kernel.personal, strict=True)
        ]
    blocks.append(np.sqrt(kernel.take) * np.eye(int(takes.max()) + 1)[takes])
    blocks.append(np.sqrt(kernel.actor) * np.eye(int(actors.max()) + 1)[actors])
    design = np.concatenate(blocks, axis=1) * scale
    precision = design.T @ design + np.eye(design.shape[1])
    covariance = np.linalg.inv(precision)
    mean = covariance @ (design.T @ (errors * scale))
    return mean[:n_shared], covariance[:n_shared, :n_shared]


def shared_design(bases: Sequence[Array], kernel: Kernel) -> Array:
    """Return the design matrix of the weights of `posterior`, shape (n, n_weights)."""
    ones = np.full((len(bases[0]), 1), np.sqrt(MEAN_VARIANCE))
    scaled = [np.sqrt(shared) * one for one, shared in zip(bases, kernel.shared, strict=True)]
    return np.concatenate([*scaled, ones], axis=1)
