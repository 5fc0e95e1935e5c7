"""How the waves of a window vary together: what the prior says, adapted to the take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..prior import WavePrior

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Covariance:
    """Of the waves of a window."""

    slow: Array
    """Of the slow waves, a square matrix, waves outermost."""
    slow_in_gaps: Array
    """The same for windows with long gaps."""
    fast: Array
    """Variances of the faster waves, shape (length - n_slow, n_channels)."""


def expected(prior: WavePrior, length: int) -> Covariance:
    """Return what a prior says by itself of windows of so many frames."""
    return Covariance(prior.matrix, prior.matrix, _extended(prior.fast, length - prior.n_slow))


def adapted(prior: WavePrior, slow: Array, power: Array, noise: Array) -> Covariance:
    """Mix the prior's covariance with that of the take, as it is estimated so far.

    Parameters
    ----------
    prior : WavePrior
    slow : square matrix
        Mean second moment of the take's slow waves.
    power : shape (length - n_slow, n_channels)
        Mean square of the take's measured faster waves.
    noise : shape (n_channels,)
        Standard deviation of a wave.
    """
    usual, in_gaps = (
        _mixed(prior.matrix, slow, np.tile(trust, prior.n_slow))
        for trust in (prior.trust, prior.trust_in_gaps)
    )
    power = np.maximum(power - noise**2, 0.0)
    fast = _extended(prior.fast, len(power))
    return Covariance(usual, in_gaps, fast * (1.0 - prior.trust) + power * prior.trust)


def _mixed(prior: Array, own: Array, trust: Array) -> Array:
    of_own, rest = np.sqrt(trust), np.sqrt(1.0 - trust)
    return np.asarray(prior * np.outer(rest, rest) + own * np.outer(of_own, of_own))


def _extended(fast: Array, n_waves: int) -> Array:
    """Return the variances of more (or fewer) fast waves; those unheard of fade away."""
    if len(fast) >= n_waves:
        return fast[:n_waves]
    last = fast[-1:] if len(fast) else np.zeros((1, fast.shape[1]))
    steps = np.arange(1, n_waves - len(fast) + 1)[:, None]
    return np.concatenate([fast, last / (1.0 + steps / max(len(fast), 1)) ** 4])
