"""How the shares of examples in a mixture go on in time: a Gaussian process, learned.

The examples' deviations R_i(s) from their mean are the mixing weights of a semiparametric
latent factor model [1]_: a variant deviates by the sum of u_i(s) R_i(s), where the latent u_i
share one kernel, RBF plus bias [ZH14, eq. 4.3]. Its covariance between channels c and d at
moments s and t is k(s, t) times the examples' own covariance, so that what belongs together in
the examples, between channels and in time, stays together.

.. [1] Teh, Seeger, Jordan (2005). Semiparametric latent factor models. AISTATS.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

Array = NDArray[np.float64]

N_MOMENTS = 24
N_COMPONENTS = 6
START = (np.log(0.5), 0.0, np.log(0.1))
BOUNDS = ((np.log(0.05), np.log(20.0)), (-4.0, 4.0), (np.log(1e-4), np.log(1.0)))
JITTER = 1e-9


@dataclass(frozen=True)
class MixingKernel:
    """How alike a share is at two moments.

    Attributes
    ----------
    scale : float, seconds
        Of the RBF kernel: over so much time shares change.
    bias : float
        Part of the variance that never changes within a variant: 0 to 1.
    """

    scale: float = 0.5
    bias: float = 0.5

    def covariance(self, times: Array, period: float | None = None) -> Array:
        """Return the covariance of a share at moments, with variance 1.

        Parameters
        ----------
        times : shape (n,), seconds
        period : float, seconds, optional
            After which a loop begins anew.
        """
        apart = times[:, None] - times
        if period:
            apart = period / np.pi * np.sin(np.pi * apart / period)
        return np.asarray(
            self.bias + (1.0 - self.bias) * np.exp(-0.5 * (apart / self.scale) ** 2)
        )


def learn_mixing_kernel(deviations: Array, seconds: float) -> MixingKernel:
    """Learn scale and bias by the likelihood of each example given the others.

    Gradients of the Gaussian's log likelihood in both and in the variance of what the others
    do not tell (Rasmussen and Williams 2006, eq. 5.9), by L-BFGS.

    Parameters
    ----------
    deviations : shape (n_examples, n_moments, n_channels)
        Channels scaled so that they count alike; at least three examples.
    seconds : float
        What an example lasts.
    """
    if len(deviations) < 3:
        return MixingKernel()
    rows = np.linspace(0, deviations.shape[1] - 1, min(N_MOMENTS, deviations.shape[1]))
    kept = deviations[:, np.round(rows).astype(int)]
    flat = kept.reshape(-1, kept.shape[-1])
    _, axes = np.linalg.eigh(flat.T @ flat)
    told = kept @ axes[:, -N_COMPONENTS:]
    variance = float((told**2).mean())
    if variance <= 0.0:
        return MixingKernel()
    told = told / np.sqrt(variance)
    times = rows / (deviations.shape[1] - 1) * seconds
    done = minimize(
        _cost, START, args=(told, times), jac=True, method="L-BFGS-B", bounds=BOUNDS,
        options={"maxiter": 40},
    )  # fmt: skip
    return MixingKernel(float(np.exp(done.x[0])), float(_share(done.x[1])))


def _share(x: float) -> float:
    return float(1.0 / (1.0 + np.exp(-x)))


def _cost(point: Array, told: Array, times: Array) -> tuple[float, Array]:
    """Return minus the log likelihood of each example given the others, and its gradient."""
    scale, bias, noise = np.exp(point[0]), _share(point[1]), np.exp(point[2])
    squares = ((times[:, None] - times) / scale) ** 2
    rbf = np.exp(-0.5 * squares)
    kernels = (
        bias + (1.0 - bias) * rbf,
        (1.0 - bias) * rbf * squares,
        bias * (1.0 - bias) * (1.0 - rbf),
    )
    n, size = len(told), told.shape[1] * told.shape[2]
    total, slope = 0.0, np.zeros(3)
    for held in range(n):
        others = np.delete(told, held, axis=0)
        middle = others.mean(axis=0)
        beside = (others - middle).reshape(n - 1, size)
        own = np.einsum("ia,ib->ab", beside, beside) * (n / (n - 1.0)) / (n - 2.0)
        whole, by_scale, by_bias = (
            own * np.kron(kernel, np.ones((told.shape[2], told.shape[2]))) for kernel in kernels
        )
        factor = cho_factor(whole + (noise + JITTER) * np.eye(size), lower=True)
        wanted = (told[held] - middle).reshape(size)
        solved = cho_solve(factor, wanted)
        inverse = cho_solve(factor, np.eye(size))
        total += 0.5 * wanted @ solved + np.log(np.diag(factor[0])).sum()
        pull = inverse - np.outer(solved, solved)
        slope += 0.5 * np.array([
            (pull * by_scale).sum(), (pull * by_bias).sum(), noise * np.trace(pull),
        ])  # fmt: skip
    return float(total), slope
