"""Covariance of the residual prior: how strongly the errors of two frames correlate.

The error y of a joint is y = f(x) + f_actor(x) + b_actor + b_take + noise. f is common to all
actors and has covariance a1 k1 + a2 k2: k1 depends on the joint and its neighbors as in [ZH14],
k2 on the complete pose. f_actor has the same form with its own strengths; the b are constant
offsets. Only f is used for a new actor. Without the other terms, f would attribute differences
between actors to the pose, and its variance would be too small.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array

Real = TypeVar("Real", NDArray[np.float64], NDArray[np.float32])

MIN_VARIANCE_RATIO, MIN_LENGTH_RATIO, MAX_RATIO = 1e-4, 0.3, 10.0
"""Bounds of each variance, relative to the variance of the errors, and of each length, relative
to the spread of the examples. They guard the search for a maximum of the likelihood."""
MAX_ITERATIONS = 40
"""Maximum number of iterations of the search for a maximum of the likelihood. It bounds the run
time."""


@dataclass(frozen=True)
class Kernel:
    """Hyper-parameters of one joint: lengths in meters of features, variances in square meters.

    Attributes
    ----------
    lengths, shared, personal : (local, complete pose)
        Length scales of the features; strengths of f and of f_actor.
    take, actor, noise : float
        Variances of the constant offsets and of the residual.
    """

    lengths: tuple[float, float]
    shared: tuple[float, float]
    personal: tuple[float, float]
    take: float
    actor: float
    noise: float

    @classmethod
    def from_logs(cls, logs: Array) -> "Kernel":
        """Create a kernel from the optimized logarithms."""
        l1, l2, a1, a2, p1, p2, take, actor, noise = (float(value) for value in np.exp(logs))
        return cls((l1, l2), (a1, a2), (p1, p2), take, actor, noise)


def squared_distances(one: Real, other: Real) -> Real:
    """Return the squared distance of each row to each row, shape (n_one, n_other)."""
    result = one @ other.T
    result *= -2.0
    result += (one**2).sum(axis=1)[:, None]
    result += (other**2).sum(axis=1)
    return np.maximum(result, 0.0, out=result)


def squared_exponential(one: Array, other: Array, length: float) -> Array:
    """Return the squared-exponential kernel, shape (n_one, n_other)."""
    return np.asarray(np.exp(-0.5 * squared_distances(one, other) / length**2))


def proximity(squared: Array, far: tuple[float, float]) -> Array:
    """Return 1 near the points, falling to 0 with distance from the nearest, shape (n,).

    `squared` are the squared distances from all points, shape (n, n_points).
    """
    near, fall_off = far
    distance = np.sqrt(squared.min(axis=1))
    return np.asarray(np.exp(-0.5 * (np.maximum(distance - near, 0.0) / fall_off) ** 2))


def learn_kernel(
    features: tuple[Array, Array],
    errors: Array,
    takes: NDArray[np.int64],
    actors: NDArray[np.int64],
    simple: bool,
) -> Kernel:
    """Find the hyper-parameters of maximum marginal likelihood (L-BFGS).

    Parameters
    ----------
    features : local and of the complete pose, each of shape (n, n_features)
    errors : shape (n, 3), meters; axes share the hyper-parameters
    takes, actors : shape (n,), int
    simple : bool
        As published: only k1 and noise.
    """
    far = tuple(squared_distances(one, one) for one in features)
    spread = np.sqrt([max(float(one.mean()) / 2.0, 1e-12) for one in far])
    centered = errors - errors.mean(axis=0)
    total = max(float(centered.var()), 1e-12)
    same = tuple((one[:, None] == one).astype(np.float64) for one in (takes, actors))
    start = np.log([*spread, *(total * np.array([0.2, 0.2, 0.1, 0.1, 0.1, 0.2, 0.1]))])
    bounds = [(np.log(MIN_LENGTH_RATIO * one), np.log(MAX_RATIO * one)) for one in spread]
    bounds += [(np.log(MIN_VARIANCE_RATIO * total), np.log(MAX_RATIO * total))] * 7
    if simple:
        for index in (3, 4, 5, 6, 7):
            start[index] = np.log(MIN_VARIANCE_RATIO * total * 1e-3)
            bounds[index] = (start[index], start[index])
    optimum = scipy.optimize.minimize(
        _negative_log_likelihood, start, args=(far, same, centered), jac=True,
        method="L-BFGS-B", bounds=bounds, options={"maxiter": MAX_ITERATIONS},
    )  # fmt: skip
    return Kernel.from_logs(optimum.x)


def _negative_log_likelihood(
    logs: Array, far: tuple[Array, ...], same: tuple[Array, ...], errors: Array
) -> tuple[float, Array]:
    """Return the negative log marginal likelihood and its gradient by the logarithms."""
    kernel = Kernel.from_logs(logs)
    n, n_axes = errors.shape
    shapes = [np.exp(-0.5 * d / size**2) for d, size in zip(far, kernel.lengths, strict=True)]
    strengths = [
        shared + personal * same[1]
        for shared, personal in zip(kernel.shared, kernel.personal, strict=True)
    ]
    covariance = kernel.take * same[0] + kernel.actor * same[1] + kernel.noise * np.eye(n)
    for shape, strength in zip(shapes, strengths, strict=True):
        covariance += shape * strength
    factor = scipy.linalg.cho_factor(covariance, lower=True, check_finite=False)
    solved = scipy.linalg.cho_solve(factor, errors, check_finite=False)
    value = 0.5 * (errors * solved).sum() + n_axes * np.log(np.diag(factor[0]).copy()).sum()
    inverse = scipy.linalg.cho_solve(factor, np.eye(n), check_finite=False)
    slope = -0.5 * (solved @ solved.T - n_axes * inverse)
    weighted = [slope * shape for shape in shapes]
    gradient = [
        ((one * strength) * d).sum() / size**2
        for one, strength, d, size in zip(weighted, strengths, far, kernel.lengths, strict=True)
    ]
    gradient += [a * one.sum() for a, one in zip(kernel.shared, weighted, strict=True)]
    gradient += [
        p * (one * same[1]).sum() for p, one in zip(kernel.personal, weighted, strict=True)
    ]
    gradient += [
        kernel.take * (slope * same[0]).sum(),
        kernel.actor * (slope * same[1]).sum(),
        kernel.noise * np.trace(slope),
    ]
    return float(value), np.array(gradient)
