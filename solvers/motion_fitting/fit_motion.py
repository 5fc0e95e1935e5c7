"""Fit a whole take to goals by the Gauss-Newton method."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..motion import Motion
from ..progress import Progress, unwatched
from .goal import Goal
from .normal_equations import NormalEquations
from .variables import FittedMotion

MAX_ROUNDS = 16
"""Number of steps. It bounds the time; takes of all kinds need two to seven;
feet far out of reach are still not settled after these."""
MAX_HALVINGS = 8
"""Number of times that a step is halved which makes the cost higher. It bounds the time."""
SMALL_DECREASE = 1e-2
"""Relative decrease of the cost that ends the fit, a ratio. Chosen by hand: x0.5 costs nothing,
x2 costs nothing."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A motion that meets its goals as well as it can.

    Attributes
    ----------
    motion : Motion
    has_converged : bool
    """

    motion: Motion
    has_converged: bool


def fit_motion(
    start: FittedMotion,
    goals: Sequence[Goal],
    progress: Progress = unwatched,
    message: str = "Fitting the motion",
) -> Fit:
    """Return the motion with the least sum of squares of its goals' residuals.

    Parameters
    ----------
    start : FittedMotion
        The motion, and what of it may change.
    goals : sequence of Goal
    progress : Progress
    message : str
        What is shown as progress.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    fitted, equations, damping = start, _equations(start, goals), 1.0
    for number in range(1, MAX_ROUNDS + 1):
        progress(number / (MAX_ROUNDS + 1), message)
        step = equations.step()
        for _ in range(MAX_HALVINGS):
            trial = fitted.moved(damping * step)
            tried = _equations(trial, goals)
            if tried.cost <= equations.cost:
                break
            damping *= 0.5
        else:
            return Fit(fitted.motion, False)
        is_small = equations.cost - tried.cost <= SMALL_DECREASE * tried.cost
        has_converged = is_small and damping == 1.0
        fitted, equations, damping = trial, tried, min(1.0, 2.0 * damping)
        if has_converged:
            return Fit(fitted.motion, True)
    return Fit(fitted.motion, False)


def _equations(fitted: FittedMotion, goals: Sequence[Goal]) -> NormalEquations:
    equations = NormalEquations(fitted.motion.n_frames, fitted.n_variables)
    for goal in goals:
        goal.add_to(equations, fitted)
    return equations
