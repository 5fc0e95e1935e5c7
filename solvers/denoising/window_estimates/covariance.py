"""Covariance of a window's DCT coefficients: the prior's, adapted to the take."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array
from ..window_priors import WindowPrior


@dataclass(frozen=True, eq=False)
class WindowCovariance:
    """Covariance of the coefficients of a window."""

    prior: WindowPrior
    own: Array | None
    """Mean second moment of the take's slow coefficients, if it is known."""
    fast: Array
    """Variances of the fast coefficients, shape (length - n_slow, n_channels)."""

    @cached_property
    def slow(self) -> Array:
        """Of the slow coefficients, a square matrix, coefficients outermost."""
        return self._mix(self.prior.own_weight)

    @cached_property
    def slow_in_gaps(self) -> Array:
        """The same for windows with long gaps."""
        return self._mix(self.prior.own_weight_in_gaps)

    def _mix(self, own_weight: float) -> Array:
        if self.own is None:
            return self.prior.matrix
        mixed = own_weight * self.own
        mixed += (1.0 - own_weight) * self.prior.matrix
        return mixed


def covariance_from_prior(prior: WindowPrior, length: int) -> WindowCovariance:
    """Return the covariance of windows of this many frames under the prior alone."""
    fast = _extend_fast_variances(prior.fast, length - prior.n_slow)
    return WindowCovariance(prior, None, fast)


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
    power = np.maximum(power - noise**2, 0.0)
    fast = _extend_fast_variances(prior.fast, len(power))
    fast = fast * (1.0 - prior.own_weight) + power * prior.own_weight
    return WindowCovariance(prior, slow, fast)


def _extend_fast_variances(fast: Array, n_coefficients: int) -> Array:
    """Return variances of more (or fewer) fast coefficients; added ones decay with
    frequency."""
    if len(fast) >= n_coefficients:
        return fast[:n_coefficients]
    last = fast[-1:] if len(fast) else np.zeros((1, fast.shape[1]))
    steps = np.arange(1, n_coefficients - len(fast) + 1)[:, None]
    return np.concatenate([fast, last / (1.0 + steps / max(len(fast), 1)) ** 4])
