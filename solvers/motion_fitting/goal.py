"""The interface of goals: terms whose sum a fitted motion makes least."""

from typing import Protocol

from .normal_equations import NormalEquations
from .variables import FittedMotion


class Goal(Protocol):
    """A term of the sum of squares that the fit makes least.

    Residuals are divided by a tolerance in the goal's own unit, so that 1 is as bad in one goal
    as in another.
    """

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        ...
