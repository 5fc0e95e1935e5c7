"""How the shares of examples in a mixture go on in time: the kernel of a Gaussian process.

The examples' deviations R_i(s) from their mean are the mixing weights of a semiparametric
latent factor model [1]_: a variant deviates by the sum of u_i(s) R_i(s), where the latent u_i
share one kernel, RBF plus bias [ZH14, eq. 4.3]. Its covariance between channels c and d at
moments s and t is k(s, t) times the examples' own covariance, so that what belongs together in
the examples, between channels and in time, stays together.

Scale and bias are not learned by marginal likelihood: where moments are not quite lined up the
likeliest shares change within .1 s, and variants made of them jerk and look like no example
(docs/variation.md). They are the same for all behaviours, chosen on squats and hops.

.. [1] Teh, Seeger, Jordan (2005). Semiparametric latent factor models. AISTATS.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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

    scale: float = 0.6
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
