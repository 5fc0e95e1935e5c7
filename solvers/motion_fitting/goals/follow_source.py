"""Stay near the source, and leave and reach it smoothly."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..normal_equations import NormalEquations
from ..variables import FittedMotion


@dataclass(frozen=True, eq=False)
class FollowSource:
    """Keep the change d of each variable small and smooth: |d|^2 + tau^4 |d''|^2.

    Without another goal a change decays as exp(-t / (tau sqrt 2)) at every frame rate.

    Attributes
    ----------
    tolerances : shape (n_variables,), meters and radians
    time_constants : shape (n_variables,), seconds
        tau.
    """

    tolerances: Array
    time_constants: Array

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        changes, weights = fitted.deviations(), 1.0 / self.tolerances
        equations.add_variables(changes * weights, weights)
        if len(changes) > 2:
            smoothness = weights * (self.time_constants * fitted.motion.frame_rate) ** 2
            equations.add_second_differences(np.diff(changes, 2, axis=0) * smoothness, smoothness)
