"""Stay near the source, and leave and reach it smoothly."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ...arrays import Array
from .. import FittedMotion, NormalEquations

FADE_TIME_CONSTANTS = np.pi * np.sqrt(2.0)
"""Time constants after which a free correction has faded to exp(-pi), 4 %. By definition of the
fade."""


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

    @classmethod
    def of_joints(
        cls,
        fitted: FittedMotion,
        root: float,
        joints: Mapping[int, float],
        fade: float,
        smoother: Mapping[int, float] = MappingProxyType({}),
    ) -> "FollowSource":
        """Return the goal from tolerances of the root in meters and of joints in radians.

        A change that nothing else needs fades in `fade` seconds, times a ratio for joints that
        are to be `smoother`.
        """
        tolerances = np.full(fitted.n_variables, root)
        time_constants = np.full(fitted.n_variables, fade / FADE_TIME_CONSTANTS)
        for joint, tolerance in joints.items():
            tolerances[fitted.columns(joint)] = tolerance
            time_constants[fitted.columns(joint)] *= smoother.get(joint, 1.0)
        return cls(tolerances, time_constants)

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        changes, weights = fitted.deviations(), 1.0 / self.tolerances
        equations.add_variables(changes * weights, weights)
        if len(changes) > 2:
            smoothness = weights * (self.time_constants * fitted.motion.frame_rate) ** 2
            bends = changes[2:] - 2.0 * changes[1:-1] + changes[:-2]
            equations.add_second_differences(bends * smoothness, smoothness)
