"""Gaussian processes from features of two frames to the next rotation of one joint.

Both forms take y = Phi c(x) with three channels c, made of processes with the kernel of [ZH14,
eq. 4.3]

    u_p(x, x') = exp(-|x - x'|^2 / (2 l_p^2)) + b_p + n_p [x = x'].

As published (eq. 4.4) the channels are the outputs themselves, Phi = 1, and their kernels are
sums of phi_ip^2 u_p over three shared u_p: the outputs share hyper-parameters and nothing else.
As a semiparametric latent factor model proper [1]_ the channels are the latent processes u_p
and Phi mixes them, so that outputs covary. With as many latent processes as outputs and noise
on the latent ones, the joint likelihood of all outputs is that of Phi^-1 y, channel by channel,
times |det Phi|^-n: exact, and no matrix is larger than n by n.

.. [1] Teh, Seeger, Jordan (2005). Semiparametric latent factor models. AISTATS.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize
from scipy.spatial.distance import cdist

Array = NDArray[np.float64]

N = 3
"""Outputs, latent processes and channels."""
PACKED = 3 * N + N * N
"""Numbers of the hyper-parameters of one triple."""
ROUNDS = 40
LOG_LENGTH, LOG_BIAS, LOG_NOISE = (-1.5, 4.0), (-4.0, 3.0), (-9.0, 0.0)
"""Bounds of logarithms: of lengths by the usual distance of examples, of biases and noises."""
MIX = 20.0
"""Bound of mixing weights, by the spread of the outputs."""
JITTER = 1e-6


@dataclass(frozen=True, eq=False)
class Hyperparameters:
    """What the likelihood is maximised over, for outputs of about unit variance.

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

    def packed(self) -> Array:
        """Return all numbers in a row, shape (18,)."""
        return np.concatenate([self.lengths, self.biases, self.noises, self.mixing.ravel()])

    @classmethod
    def unpacked(cls, numbers: Array) -> "Hyperparameters":
        """Read what `packed` gave."""
        told = numbers[: 3 * N].reshape(3, N)
        return cls(told[0], told[1], told[2], numbers[3 * N :].reshape(N, N))

    def weights(self, published: bool) -> Array:
        """Return how much of each u_p is in the kernel of each channel, shape (3, 3)."""
        return self.mixing**2 if published else np.eye(N)

    def from_channels(self, published: bool) -> Array:
        """Return Phi, shape (3, 3)."""
        return np.eye(N) if published else np.linalg.inv(self.mixing)


def learn_hyperparameters(
    features: Array, outputs: Array, published: bool, rounds: int = ROUNDS
) -> Hyperparameters:
    """Maximise the marginal likelihood by its gradient (L-BFGS).

    Parameters
    ----------
    features : shape (n, n_features)
    outputs : shape (n, 3)
        Centred and scaled.
    published : bool
        Whether outputs share kernels only (eq. 4.4).
    rounds : int
        Iterations at most.
    """
    far = cdist(features, features, "sqeuclidean")
    usual = 0.5 * np.log(max(float(far.mean()), 1e-12))
    start = np.concatenate([
        usual + np.array([-0.5, 0.0, 0.5]), np.full(N, -1.0), np.full(N, -4.0),
        (_spread(outputs) if published else np.linalg.inv(_spread(outputs))).ravel(),
    ])  # fmt: skip
    bounds = [(usual + LOG_LENGTH[0], usual + LOG_LENGTH[1])] * N
    bounds += [LOG_BIAS] * N + [LOG_NOISE] * N + [(None, None)] * N**2
    if published:
        bounds[3 * N :] = [(-MIX, MIX)] * N**2
    cost = _published_cost if published else _latent_cost
    done = minimize(
        cost, start, args=(far, outputs), jac=True, method="L-BFGS-B", bounds=bounds,
        options={"maxiter": rounds},
    )  # fmt: skip
    return _read(done.x)


def kernel_of(far: Array, found: Hyperparameters, weights: Array) -> Array:
    """Return kernels of channels without noise, shape (3, ...), by squared distances."""
    by_process = [
        np.exp(-0.5 * far / length**2) + bias
        for length, bias in zip(found.lengths, found.biases, strict=True)
    ]
    return np.asarray(np.tensordot(weights, np.stack(by_process), axes=1))


def _spread(outputs: Array) -> Array:
    """Return a first Phi: the axes of the outputs times their deviations along them."""
    values, axes = np.linalg.eigh(outputs.T @ outputs / len(outputs))
    return np.asarray(axes * np.sqrt(np.maximum(values, 1e-4)))


def _read(point: Array) -> Hyperparameters:
    return Hyperparameters.unpacked(np.concatenate([np.exp(point[: 3 * N]), point[3 * N :]]))


def _parts(far: Array, length: float, bias: float) -> tuple[Array, Array]:
    """Return RBF plus bias, and its derivative along the logarithm of the length."""
    rbf = np.exp(-0.5 * far / length**2)
    return rbf + bias, rbf * far / length**2


def _likelihood(covariance: Array, values: Array) -> tuple[float, Array, Array]:
    """Return minus a log likelihood less its constant, its slope along the covariance, and
    that along the values."""
    n = len(values)
    factor = cho_factor(covariance, lower=True, check_finite=False)
    solved = cho_solve(factor, values, check_finite=False)
    inverse = cho_solve(factor, np.eye(n), check_finite=False)
    cost = 0.5 * values @ solved + np.log(np.diag(factor[0])).sum()
    return float(cost), 0.5 * (inverse - np.outer(solved, solved)), solved


def _latent_cost(point: Array, far: Array, outputs: Array) -> tuple[float, Array]:
    """Return minus the log likelihood of a latent factor model, and its gradient."""
    found, n = _read(point), len(outputs)
    total, slope = 0.0, np.zeros((3, N))
    mixing = np.zeros((N, N))
    for p in range(N):
        kernel, by_length = _parts(far, found.lengths[p], found.biases[p])
        noise = found.noises[p]
        values = outputs @ found.mixing[p]
        cost, pull, solved = _likelihood(kernel + (noise + JITTER) * np.eye(n), values)
        total += cost
        slope[:, p] = (
            (pull * by_length).sum(), found.biases[p] * pull.sum(), noise * np.trace(pull),
        )  # fmt: skip
        mixing[p] = solved @ outputs
    sign, log_det = np.linalg.slogdet(found.mixing)
    if not sign:
        return 1e12, np.zeros_like(point)
    mixing -= n * np.linalg.inv(found.mixing).T
    return total - n * log_det, np.concatenate([slope.ravel(), mixing.ravel()])


def _published_cost(point: Array, far: Array, outputs: Array) -> tuple[float, Array]:
    """Return minus the log likelihood of outputs that share kernels (eq. 4.4)."""
    found, n = _read(point), len(outputs)
    parts = [_parts(far, found.lengths[p], found.biases[p]) for p in range(N)]
    shared = np.stack([part[0] for part in parts])
    total, slope = 0.0, np.zeros((3, N))
    mixing = np.zeros((N, N))
    for i in range(N):
        weights = found.mixing[i] ** 2
        covariance = np.tensordot(weights, shared, axes=1)
        covariance += (weights @ found.noises + JITTER) * np.eye(n)
        cost, pull, _ = _likelihood(covariance, outputs[:, i])
        total += cost
        along = np.array([
            [(pull * by_length).sum(), bias * pull.sum(), noise * np.trace(pull)]
            for (_, by_length), bias, noise in zip(
                parts, found.biases, found.noises, strict=True
            )
        ])  # fmt: skip
        slope += weights * along.T
        each = [
            (pull * one).sum() + noise * np.trace(pull)
            for one, noise in zip(shared, found.noises, strict=True)
        ]
        mixing[i] = 2.0 * found.mixing[i] * np.array(each)
    return total, np.concatenate([slope.ravel(), mixing.ravel()])
