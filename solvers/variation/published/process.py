"""Gaussian processes from features of two frames to the next rotation of one joint.

Both forms take y = Phi c(x) with three channels c, made of processes with the kernel of [ZH14,
eq. 4.3]

    u_p(x, x') = exp(-|x - x'|^2 / (2 l_p^2)) + b_p + n_p [x = x'].

As published (eq. 4.4) the channels are the outputs themselves, Phi = 1, and their kernels are
sums of phi_ip^2 u_p over three shared u_p: the outputs share hyperparameters and nothing else.
In a semiparametric latent factor model [1]_ the channels are the latent processes u_p and Phi
mixes them, so that outputs covary. Here there are as many latent processes as outputs, and the
noise is on the latent ones. The joint likelihood of all outputs is then that of Phi^-1 y,
channel by channel, times |det Phi|^-n: exact, and no matrix is larger than n by n.

.. [1] Teh, Seeger, Jordan (2005). Semiparametric latent factor models. AISTATS.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array

N_CHANNELS = 3
"""Number of outputs, of latent processes and of channels."""
N_PACKED = 3 * N_CHANNELS + N_CHANNELS * N_CHANNELS
"""Number of hyperparameters of one triple."""
MAX_ITERATIONS = 40
LOG_LENGTH_BOUNDS, LOG_BIAS_BOUNDS, LOG_NOISE_BOUNDS = (-1.5, 4.0), (-4.0, 3.0), (-9.0, 0.0)
"""Bounds of logarithms: of lengths relative to the typical distance of examples, of biases and
of noises. They guard the search for a maximum of the likelihood."""
MAX_MIXING = 20.0
"""Bound of mixing weights, relative to the standard deviation of the outputs. It guards the
same search."""
REGULARIZATION = 1e-6
"""Fraction of the variance that is added to the diagonal of a covariance. It guards a
factorization."""


@dataclass(frozen=True, eq=False)
class Hyperparameters:
    """Parameters that maximize the likelihood, for outputs of about unit variance.

    Attributes
    ----------
    lengths, biases, noises : shape (3,)
        Of the processes u_p; their RBF kernels have variance 1.
    mixing : shape (3, 3)
        phi_ip as published; the inverse of Phi in a latent factor model.
    """

    lengths: Array
    biases: Array
    noises: Array
    mixing: Array

    def to_vector(self) -> Array:
        """Return all parameters in one vector, shape (18,)."""
        return np.concatenate([self.lengths, self.biases, self.noises, self.mixing.ravel()])

    @classmethod
    def from_vector(cls, numbers: Array) -> "Hyperparameters":
        """Read the vector of `to_vector`."""
        by_process = numbers[: 3 * N_CHANNELS].reshape(3, N_CHANNELS)
        return cls(
            by_process[0],
            by_process[1],
            by_process[2],
            numbers[3 * N_CHANNELS :].reshape(N_CHANNELS, N_CHANNELS),
        )

    def weights(self, published: bool) -> Array:
        """Return the weight of each u_p in the kernel of each channel, shape (3, 3)."""
        return self.mixing**2 if published else np.eye(N_CHANNELS)

    def from_channels(self, published: bool) -> Array:
        """Return Phi, shape (3, 3)."""
        return np.eye(N_CHANNELS) if published else np.linalg.inv(self.mixing)


def learn_hyperparameters(
    features: Array, outputs: Array, published: bool, max_iterations: int = MAX_ITERATIONS
) -> Hyperparameters:
    """Maximize the marginal likelihood by its gradient (L-BFGS).

    Parameters
    ----------
    features : shape (n, n_features)
    outputs : shape (n, 3)
        Centered and scaled.
    published : bool
        Whether outputs share kernels only (eq. 4.4).
    max_iterations : int
    """
    squared_distances = scipy.spatial.distance.cdist(features, features, "sqeuclidean")
    log_typical_length = 0.5 * np.log(max(float(squared_distances.mean()), 1e-12))
    mixing = _initial_mixing(outputs)
    start = np.concatenate([
        log_typical_length + np.array([-0.5, 0.0, 0.5]),
        np.full(N_CHANNELS, -1.0), np.full(N_CHANNELS, -4.0),
        (mixing if published else np.linalg.inv(mixing)).ravel(),
    ])  # fmt: skip
    bounds = [
        (log_typical_length + LOG_LENGTH_BOUNDS[0], log_typical_length + LOG_LENGTH_BOUNDS[1])
    ] * N_CHANNELS
    bounds += (
        [LOG_BIAS_BOUNDS] * N_CHANNELS
        + [LOG_NOISE_BOUNDS] * N_CHANNELS
        + [(None, None)] * N_CHANNELS**2
    )
    if published:
        bounds[3 * N_CHANNELS :] = [(-MAX_MIXING, MAX_MIXING)] * N_CHANNELS**2
    cost = _published_cost if published else _latent_cost
    solution = scipy.optimize.minimize(
        cost, start, args=(squared_distances, outputs), jac=True,
        method="L-BFGS-B", bounds=bounds, options={"maxiter": max_iterations},
    )  # fmt: skip
    return _unpack_point(solution.x)


def compute_kernels(
    squared_distances: Array, hyperparameters: Hyperparameters, weights: Array
) -> Array:
    """Return kernels of channels without noise, shape (3, ...), from squared distances."""
    by_process = [
        np.exp(-0.5 * squared_distances / length**2) + bias
        for length, bias in zip(hyperparameters.lengths, hyperparameters.biases, strict=True)
    ]
    return np.asarray(np.tensordot(weights, np.stack(by_process), axes=1))


def _initial_mixing(outputs: Array) -> Array:
    """Return an initial Phi: the principal axes of the outputs, scaled by their deviations."""
    values, axes = np.linalg.eigh(outputs.T @ outputs / len(outputs))
    return np.asarray(axes * np.sqrt(np.maximum(values, 1e-4)))


def _unpack_point(point: Array) -> Hyperparameters:
    return Hyperparameters.from_vector(
        np.concatenate([np.exp(point[: 3 * N_CHANNELS]), point[3 * N_CHANNELS :]])
    )


def _kernel_and_slope(
    squared_distances: Array, length: float, bias: float
) -> tuple[Array, Array]:
    """Return RBF plus bias, and its derivative with respect to the logarithm of the length."""
    rbf = np.exp(-0.5 * squared_distances / length**2)
    return rbf + bias, rbf * squared_distances / length**2


def _likelihood(covariance: Array, values: Array) -> tuple[float, Array, Array]:
    """Return the negative log likelihood without its constant, and its derivatives by the
    covariance and by the values."""
    n = len(values)
    factor = scipy.linalg.cho_factor(covariance, lower=True, check_finite=False)
    solved = scipy.linalg.cho_solve(factor, values, check_finite=False)
    inverse = scipy.linalg.cho_solve(factor, np.eye(n), check_finite=False)
    cost = 0.5 * values @ solved + np.log(np.diag(factor[0]).copy()).sum()
    return float(cost), 0.5 * (inverse - np.outer(solved, solved)), solved


def _latent_cost(point: Array, squared_distances: Array, outputs: Array) -> tuple[float, Array]:
    """Return the negative log likelihood of a latent factor model, and its gradient."""
    hyperparameters, n = _unpack_point(point), len(outputs)
    total, slope = 0.0, np.zeros((3, N_CHANNELS))
    mixing = np.zeros((N_CHANNELS, N_CHANNELS))
    for p in range(N_CHANNELS):
        kernel, by_length = _kernel_and_slope(
            squared_distances, hyperparameters.lengths[p], hyperparameters.biases[p]
        )
        noise = hyperparameters.noises[p]
        values = outputs @ hyperparameters.mixing[p]
        cost, gradient, solved = _likelihood(
            kernel + (noise + REGULARIZATION) * np.eye(n), values
        )
        total += cost
        slope[:, p] = (
            (gradient * by_length).sum(), hyperparameters.biases[p] * gradient.sum(),
            noise * np.trace(gradient),
        )  # fmt: skip
        mixing[p] = solved @ outputs
    sign, log_det = np.linalg.slogdet(hyperparameters.mixing)
    if not sign:
        return 1e12, np.zeros_like(point)
    mixing -= n * np.linalg.inv(hyperparameters.mixing).T
    return total - n * log_det, np.concatenate([slope.ravel(), mixing.ravel()])


def _published_cost(
    point: Array, squared_distances: Array, outputs: Array
) -> tuple[float, Array]:
    """Return the negative log likelihood of outputs that share kernels (eq. 4.4)."""
    hyperparameters, n = _unpack_point(point), len(outputs)
    kernels = [
        _kernel_and_slope(
            squared_distances, hyperparameters.lengths[p], hyperparameters.biases[p]
        )
        for p in range(N_CHANNELS)
    ]
    shared = np.stack([part[0] for part in kernels])
    total, slope = 0.0, np.zeros((3, N_CHANNELS))
    mixing = np.zeros((N_CHANNELS, N_CHANNELS))
    for i in range(N_CHANNELS):
        weights = hyperparameters.mixing[i] ** 2
        covariance = np.tensordot(weights, shared, axes=1)
        covariance += (weights @ hyperparameters.noises + REGULARIZATION) * np.eye(n)
        cost, gradient, _ = _likelihood(covariance, outputs[:, i])
        total += cost
        along = np.array([
            [(gradient * by_length).sum(), bias * gradient.sum(), noise * np.trace(gradient)]
            for (_, by_length), bias, noise in zip(
                kernels, hyperparameters.biases, hyperparameters.noises, strict=True
            )
        ])  # fmt: skip
        slope += weights * along.T
        each = [
            (gradient * kernel).sum() + noise * np.trace(gradient)
            for kernel, noise in zip(shared, hyperparameters.noises, strict=True)
        ]
        mixing[i] = 2.0 * hyperparameters.mixing[i] * np.array(each)
    return total, np.concatenate([slope.ravel(), mixing.ravel()])
