"""How the waves of a window vary together: what the prior says, adapted to the take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..prior import WindowPrior

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WindowCovariance:
    """Of the waves of a window."""

    slow: Array
    """Of the slow waves, a square matrix, waves outermost."""
    slow_in_gaps: Array
    """The same for windows with long gaps."""
    fast: Array
    """Variances of the faster waves, shape (length - n_slow, n_channels)."""


def covariance_from_prior(prior: WindowPrior, length: int) -> WindowCovariance:
    """Return what a prior says by itself of windows of so many frames."""
    return WindowCovariance(
        prior.matrix, prior.matrix, _extend_fast_variances(prior.fast, length - prior.n_slow)
    )


def adapt_covariance(
    prior: WindowPrior, slow: Array, power: Array, noise: Array
) -> WindowCovariance:
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
    complete, in_gaps = (
        _mix_covariances(prior.matrix, slow, np.tile(own_weight, prior.n_slow))
        for own_weight in (prior.own_weight, prior.own_weight_in_gaps)
    )
    power = np.maximum(power - noise**2, 0.0)
    fast = _extend_fast_variances(prior.fast, len(power))
    return WindowCovariance(
        complete, in_gaps, fast * (1.0 - prior.own_weight) + power * prior.own_weight
    )


def _mix_covariances(prior: Array, own: Array, own_weight: Array) -> Array:
    own_scale, prior_scale = np.sqrt(own_weight), np.sqrt(1.0 - own_weight)
    return np.asarray(
        prior * np.outer(prior_scale, prior_scale) + own * np.outer(own_scale, own_scale)
    )


def _extend_fast_variances(fast: Array, n_coefficients: int) -> Array:
    """Return the variances of more (or fewer) fast waves; those unheard of fade away."""
    if len(fast) >= n_coefficients:
        return fast[:n_coefficients]
    last = fast[-1:] if len(fast) else np.zeros((1, fast.shape[1]))
    steps = np.arange(1, n_coefficients - len(fast) + 1)[:, None]
    return np.concatenate([fast, last / (1.0 + steps / max(len(fast), 1)) ** 4])
