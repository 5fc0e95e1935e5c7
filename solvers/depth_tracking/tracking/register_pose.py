"""Register a pose to an observation by damped Gauss-Newton steps over the terms."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ...arrays import Array
from ..body import (
    N_COORDINATES,
    BodyModel,
    PoseEquations,
    SurfaceRows,
    equations_in_coordinates,
    joint_limits,
    natural_stance,
    segment_equations,
    solve_step,
    sum_equations,
)
from ..terms import (
    DEFAULT_TRACKER,
    Hypothesis,
    Observation,
    TrackerSettings,
    likelihood_rows,
    render_hypothesis,
)

Prior = Callable[[Array], PoseEquations]
Likelihood = Callable[[Hypothesis, Observation, TrackerSettings], SurfaceRows]

_MIN_STEP = 1e-3
"""A shorter step, radians or meters, ends the search. It bounds the run time."""
_DAMPING_FACTOR = 5.0
"""Factor of the damping after a step that is refused; an accepted one divides by it. Half and
twice are no better (`make sensitivity`)."""
_METERS_PER_RADIAN = 0.5
"""Ratio of the limits of a step: of the hips in meters, and of rotations. By definition half a
meter, the length of a thigh or upper body, so that both move the next joints equally far."""


@dataclass(frozen=True, eq=False)
class Registered:
    """A registered pose and its normal equations.

    Attributes
    ----------
    hypothesis : Hypothesis
    equations : PoseEquations
        Equations of likelihood and priors at this pose.
    iterations : int
        Number of rendered hypotheses.
    """

    hypothesis: Hypothesis
    equations: PoseEquations
    iterations: int

    @property
    def pose(self) -> Array:
        """The coordinates, shape (36,)."""
        return self.hypothesis.pose


def register_pose(
    body: BodyModel,
    pose: Array,
    observation: Observation,
    prior: Prior,
    settings: TrackerSettings = DEFAULT_TRACKER,
    likelihood: Likelihood = likelihood_rows,
) -> Registered:
    """Return the most probable pose near `pose`.

    The terms are summed into one 6 x 6 matrix per segment, and transformed to the coordinates
    once per step [WZC12]_, section 3.1. Steps are damped (Levenberg-Marquardt) and limited.
    With `accept_only_better` a step that raises the cost is rejected and repeated with more
    damping. The first steps use a quarter of the pixels.

    Parameters
    ----------
    body : BodyModel
    pose : shape (36,)
    observation : Observation
        Not empty.
    prior : callable
        Maps a pose to its prior equations.
    settings : TrackerSettings
    likelihood : callable
        Returns the weighted rows of the image terms of a hypothesis.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    coarse = min(settings.coarse_iterations, settings.iterations - 1)
    half = observation.every(2)
    if coarse and not half.empty:
        objective = _Objective(body, half, prior, settings, likelihood)
        pose = descend(objective.evaluate, pose, coarse, settings).pose
    objective = _Objective(body, observation, prior, settings, likelihood)
    registered = descend(objective.evaluate, pose, settings.iterations - coarse, settings)
    return replace(registered, iterations=registered.iterations + coarse)


@dataclass(frozen=True, eq=False)
class _Objective:
    """The constant inputs of one registration."""

    body: BodyModel
    observation: Observation
    prior: Prior
    settings: TrackerSettings
    likelihood: Likelihood

    def evaluate(self, pose: Array) -> Registered:
        """Return the equations of likelihood, prior and joint limits at a pose."""
        observation = self.observation
        hypothesis = render_hypothesis(
            self.body, pose, observation.camera, observation.occluders
        )
        rows = self.likelihood(hypothesis, observation, self.settings)
        equations = [
            equations_in_coordinates([segment_equations(rows)], hypothesis.twists),
            self.prior(pose),
            joint_limits(pose, self.settings.limit_weight),
            natural_stance(pose, self.settings.natural_weight, self.settings.ankle_weight),
        ]
        return Registered(hypothesis, sum_equations(equations), 1)


AnyRegistered = TypeVar("AnyRegistered", bound=Registered)


def descend(
    evaluate: Callable[[Array], AnyRegistered],
    pose: Array,
    iterations: int,
    settings: TrackerSettings,
) -> AnyRegistered:
    """Return the best pose after damped Gauss-Newton steps.

    Parameters
    ----------
    evaluate : callable
        Maps a pose (36,) to the normal equations of all terms.
    pose : shape (36,)
    iterations : int
        Maximum number of evaluated poses.
    settings : TrackerSettings
        The damping and the limits of the steps.
    """
    damping = settings.damping
    best = evaluate(pose)
    for iteration in range(1, iterations):
        change = solve_step(best.equations, np.full(N_COORDINATES, damping))
        if np.abs(change).max() < _MIN_STEP:
            break
        trial = evaluate(best.pose + _limit_step(change, settings))
        if not settings.accept_only_better or trial.equations.cost <= best.equations.cost:
            best, damping = trial, max(damping / _DAMPING_FACTOR, settings.damping)
        else:
            damping = max(damping, 1.0) * _DAMPING_FACTOR
        best = replace(best, iterations=iteration + 1)
    return best


def _limit_step(change: Array, settings: TrackerSettings) -> Array:
    largest_step = max(np.abs(change[3:]).max(), np.abs(change[:3]).max() / _METERS_PER_RADIAN)
    limited: Array = change * min(1.0, settings.max_step / max(largest_step, 1e-12))
    return limited
