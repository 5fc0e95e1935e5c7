"""Find the pose whose picture fits what was observed: damped Gauss-Newton steps over terms."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..body import (
    N_COORDINATES,
    BodyModel,
    PoseEquations,
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
    PreviousFrame,
    TrackerSettings,
    likelihood_rows,
    render_hypothesis,
)

Array = NDArray[np.float64]
Prior = Callable[[Array], PoseEquations]

_CLOSE_ENOUGH = 1e-3
"""Radians or metres; a shorter step ends the search."""
_HARDER, _EASIER = 5.0, 0.3
_METRES_PER_RADIAN = 0.5
"""Shifts of the hips are limited to this times what turns are limited to."""


@dataclass(frozen=True, eq=False)
class Registered:
    """A pose, and what is asked of it.

    Attributes
    ----------
    hypothesis : Hypothesis
    equations : PoseEquations
        Of likelihood and priors, at this pose.
    iterations : int
        Pictures drawn to find it.
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
    memory: PreviousFrame | None = None,
) -> Registered:
    """Return the most probable pose near `pose`.

    Terms tell how the surface should move, and are summed as one 6 x 6 matrix per segment;
    the coordinates see them once per step [WZC12]_, section 3.1. Steps are damped
    (Levenberg-Marquardt) and limited; with `accept_only_better` a step that raises the cost is
    taken back and tried shorter. The first steps look at a quarter of the pixels.

    Parameters
    ----------
    body : BodyModel
    pose : shape (36,)
    observation : Observation
        It must show something of the actor.
    prior : callable
        Takes a pose and returns what is asked of it.
    settings : TrackerSettings
    memory : PreviousFrame, optional
        The frame before, with its colours.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    coarse = min(settings.coarse_iterations, settings.iterations - 1)
    half = observation.every(2)
    if coarse and not half.empty:
        scene = _Scene(body, half, prior, settings, memory)
        pose = _descend(scene, pose, coarse).pose
    scene = _Scene(body, observation, prior, settings, memory)
    found = _descend(scene, pose, settings.iterations - coarse)
    return replace(found, iterations=found.iterations + coarse)


@dataclass(frozen=True, eq=False)
class _Scene:
    """What stays the same while a pose is searched."""

    body: BodyModel
    observation: Observation
    prior: Prior
    settings: TrackerSettings
    memory: PreviousFrame | None

    def evaluate(self, pose: Array) -> Registered:
        """Return what likelihood, prior and joint limits ask of this pose."""
        hypothesis = render_hypothesis(self.body, pose, self.observation.camera)
        rows = likelihood_rows(hypothesis, self.observation, self.settings, self.memory)
        asked = [
            equations_in_coordinates([segment_equations(rows)], hypothesis.twists),
            self.prior(pose),
            joint_limits(pose, self.settings.limit_weight),
            natural_stance(pose, self.settings.natural_weight, self.settings.ankle_weight),
        ]
        return Registered(hypothesis, sum_equations(asked), 1)


def _descend(scene: _Scene, pose: Array, iterations: int) -> Registered:
    settings = scene.settings
    damping = settings.damping
    best = scene.evaluate(pose)
    for iteration in range(1, iterations):
        change = solve_step(best.equations, np.full(N_COORDINATES, damping))
        if np.abs(change).max() < _CLOSE_ENOUGH:
            break
        trial = scene.evaluate(best.pose + _limited(change, settings))
        if not settings.accept_only_better or trial.equations.cost <= best.equations.cost:
            best, damping = trial, max(damping * _EASIER, settings.damping)
        else:
            damping = max(damping, 1.0) * _HARDER
        best = replace(best, iterations=iteration + 1)
    return best


def _limited(change: Array, settings: TrackerSettings) -> Array:
    longest = max(np.abs(change[3:]).max(), np.abs(change[:3]).max() / _METRES_PER_RADIAN)
    limited: Array = change * min(1.0, settings.longest_step / max(longest, 1e-12))
    return limited
