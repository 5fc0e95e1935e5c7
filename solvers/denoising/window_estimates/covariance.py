"""Covariance of a window's DCT coefficients: the prior's, adapted to the take."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..window_priors import WindowPrior


@dataclass(frozen=True, eq=False)
class WindowCovariance:
    """Covariance of the coefficients of a window."""

    slow: Array
    """Of the slow coefficients, a square matrix, coefficients outermost."""
    slow_in_gaps: Array
    """The same for windows with long gaps."""
    fast: Array
    """Variances of the fast coefficients, shape (length - n_slow, n_channels)."""


def covariance_from_prior(prior: WindowPrior, length: int) -> WindowCovariance:
    """Return the covariance of windows of this many frames under the prior alone."""
    return WindowCovariance(
        prior.matrix, prior.matrix, _extend_fast_variances(prior.fast, length - prior.n_slow)
    )


def adapt_covariance(
    prior: WindowPrior, slow: Array, power: Array, noise: Array
) -> WindowCovariance:
    """Mix the prior's covariance with the current estimate of the take's.

    Parameters
    ----------
    prior : WindowPrior
    slow : square matrix
        Mean second moment of the take's slow coefficients.
    power : shape (length - n_slow, n_channels)
        Mean square of the take's measured fast coefficients.
    noise : shape (n_channels,)
        Standard deviation of a coefficient.
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
    """Return variances of more (or fewer) fast coefficients; added ones decay with
    frequency."""
    if len(fast) >= n_coefficients:
        return fast[:n_coefficients]
    last = fast[-1:] if len(fast) else np.zeros((1, fast.shape[1]))
    steps = np.arange(1, n_coefficients - len(fast) + 1)[:, None]
    return np.concatenate([fast, last / (1.0 + steps / max(len(fast), 1)) ** 4])
