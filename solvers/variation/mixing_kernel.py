"""Covariance of mixing weights over time: the kernel of a Gaussian process.

The examples' deviations R_i(s) from their mean are the basis of a semiparametric latent factor
model [1]_. A variant deviates by the sum of u_i(s) R_i(s), and the latent weights u_i share one
kernel, RBF plus bias [ZH14, eq. 4.3]. The covariance between channels c and d at times s and t
is k(s, t) times the examples' own covariance. Correlations of the examples, between channels
and in time, are therefore preserved.

Scale and bias are not learned by marginal likelihood. Where samples are not exactly aligned,
the most likely weights change within 0.1 s; such variants jerk and resemble no example
(docs/manual/variation.md). The values are the same for all behaviors, chosen on squats and
hops.

.. [1] Teh, Seeger, Jordan (2005). Semiparametric latent factor models. AISTATS.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array


@dataclass(frozen=True)
class MixingKernel:
    """Covariance of a mixing weight at two times.

    Attributes
    ----------
    scale : float, seconds
        Length scale of the RBF kernel: larger values change the weights more slowly.
    bias : float
        Fraction of the variance that is constant within a variant: 0 to 1.
    """

    scale: float = 0.6
    bias: float = 0.5

    def covariance(self, times: Array, period: float | None = None) -> Array:
        """Return the covariance of a weight at given times, with variance 1.

        Parameters
        ----------
        times : shape (n,), seconds
        period : float, seconds, optional
            Duration of a loop; the kernel is then periodic.
        """
        lags = times[:, None] - times
        if period:
            lags = period / np.pi * np.sin(np.pi * lags / period)
        return np.asarray(
            self.bias + (1.0 - self.bias) * np.exp(-0.5 * (lags / self.scale) ** 2)
        )
