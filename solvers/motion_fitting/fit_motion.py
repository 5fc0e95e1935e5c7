"""Fit a whole take to goals by the Gauss-Newton method."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..motion import Motion
from ..progress import Progress, unwatched
from .goals import Goal
from .normal_equations import NormalEquations
from .variables import FittedMotion

MAX_ROUNDS = 8
SMALL_DECREASE = 1e-2
"""Relative decrease of the cost that ends the fit."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A motion that meets its goals as well as it can.

    Attributes
    ----------
    motion : Motion
    has_converged : bool
    cost : float
        Half the sum of squares of all residuals.
    n_rounds : int
    """

    motion: Motion
    has_converged: bool
    cost: float
    n_rounds: int


def fit_motion(
    motion: Motion,
    joints: Sequence[int],
    goals: Sequence[Goal],
    progress: Progress = unwatched,
) -> Fit:
    """Return the motion with the least weighted sum of squares of its goals."""
    fitted, damping = FittedMotion(motion, motion, tuple(joints)), 1.0
    equations = _equations(fitted, goals)
    for number in range(1, MAX_ROUNDS + 1):
        progress(number / MAX_ROUNDS, "Fitting")
        step = equations.step()
        for _ in range(4):
            trial = fitted.moved(damping * step)
            tried = _equations(trial, goals)
            if tried.cost <= equations.cost:
                break
            damping *= 0.5
        else:
            return Fit(fitted.motion, False, equations.cost, number)
        has_converged = equations.cost - tried.cost <= SMALL_DECREASE * tried.cost
        fitted, equations, damping = trial, tried, min(1.0, 2.0 * damping)
        if has_converged:
            return Fit(fitted.motion, True, equations.cost, number)
    return Fit(fitted.motion, False, equations.cost, MAX_ROUNDS)


def _equations(fitted: FittedMotion, goals: Sequence[Goal]) -> NormalEquations:
    equations = NormalEquations(fitted.motion.n_frames, fitted.n_variables)
    for goal in goals:
        goal.add_to(equations, fitted)
    return equations
