"""Fit a whole take to goals by the Gauss-Newton method."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..motion import Motion
from ..progress import Progress, Remark, unwatched
from .goal import Goal
from .normal_equations import NormalEquations
from .variables import FittedMotion

MAX_ROUNDS = 16
"""Number of steps. It bounds the time; most takes need two to seven."""
MAX_HALVINGS = 8
"""Number of times that a step is halved which makes the cost higher. It bounds the time."""
MAX_STEP_RAD = 1.0
"""Radians by which any joint turns in one step. It guards limbs that have to go far, which
would bend the wrong way (`test_hand_height_scales_with_the_legs`)."""
SMALL_DECREASE = 1e-2
"""Relative decrease of the cost by a whole step that ends the fit, a ratio. It bounds the
time: from 1e-9 to 0.1 the errors of planted feet differ by less than 0.1 %."""
NEGLIGIBLE_COST = 1e-4
"""Decrease of the cost for each frame that ends the fit: that of a residual of a hundredth of
its tolerance. It guards fits that decrease by ever less, which would end with a warning
(`test_a_fit_that_hardly_decreases_has_converged`)."""


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
        What is shown as progress, and begins the remark on a fit that did not converge.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    fitted, equations, damping = start, _equations(start, goals), 1.0
    negligible = NEGLIGIBLE_COST * start.motion.n_frames
    for number in range(1, MAX_ROUNDS + 1):
        progress(number / (MAX_ROUNDS + 1), message)
        step = equations.step
        rotations = step[:, 3 * fitted.root_moves :]
        damping = min(damping, MAX_STEP_RAD / float(np.abs(rotations).max(initial=1e-9)))
        for _ in range(MAX_HALVINGS):
            trial = fitted.moved(damping * step)
            tried = _equations(trial, goals)
            if tried.cost <= equations.cost:
                break
            damping *= 0.5
        else:
            if equations.expected_decrease <= SMALL_DECREASE * equations.cost + negligible:
                return Fit(fitted.motion, True)
            break
        decrease = equations.cost - tried.cost
        has_converged = decrease <= damping * SMALL_DECREASE * tried.cost + negligible
        fitted, equations, damping = trial, tried, min(1.0, 2.0 * damping)
        if has_converged:
            return Fit(fitted.motion, True)
    progress(1.0, Remark(f"{message} did not fully succeed; look for stretched limbs"))
    return Fit(fitted.motion, False)


def _equations(fitted: FittedMotion, goals: Sequence[Goal]) -> NormalEquations:
    equations = NormalEquations(fitted.motion.n_frames, fitted.n_variables)
    for goal in goals:
        goal.add_to(equations, fitted)
    return equations
