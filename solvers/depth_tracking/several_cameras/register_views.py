"""Register one pose to the images of several cameras."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ..body import (
    BodyModel,
    PoseEquations,
    equations_in_coordinates,
    joint_limits,
    natural_stance,
    segment_equations,
    sum_equations,
)
from ..terms import DEFAULT_TRACKER, TrackerSettings, likelihood_rows
from ..tracking import (
    FitQuality,
    Prior,
    Registered,
    descend,
    fit_quality,
    quality_without_actor,
)
from .views import View, ViewHypothesis, render_view


@dataclass(frozen=True, eq=False)
class RegisteredViews(Registered):
    """A pose that is registered to several images, and its normal equations.

    Attributes
    ----------
    hypotheses : tuple of ViewHypothesis
        One for each view; `hypothesis` is the first.
    """

    hypotheses: tuple[ViewHypothesis, ...]


def register_views(
    body: BodyModel,
    pose: Array,
    views: Sequence[View],
    prior: Prior,
    settings: TrackerSettings = DEFAULT_TRACKER,
) -> RegisteredViews:
    """Return the most probable pose near `pose`, given the images of all views.

    As `register_pose`, with the normal equations of the images summed. With one view at the
    first camera the result is the same.

    Parameters
    ----------
    body : BodyModel
    pose : shape (36,)
    views : sequence of View
        At least one; none is empty.
    prior : callable
        Maps a pose to its prior equations.
    settings : TrackerSettings
    """
    coarse = min(settings.coarse_iterations, settings.iterations - 1)
    halves = [view.every(2) for view in views]
    halves = [view for view in halves if not view.observation.empty]
    if coarse and halves:
        objective = _ViewsObjective(body, halves, prior, settings)
        pose = descend(objective.evaluate, pose, coarse, settings).pose
    objective = _ViewsObjective(body, views, prior, settings)
    registered = descend(objective.evaluate, pose, settings.iterations - coarse, settings)
    return replace(registered, iterations=registered.iterations + coarse)


@dataclass(frozen=True, eq=False)
class _ViewsObjective:
    """The constant inputs of one registration."""

    body: BodyModel
    views: Sequence[View]
    prior: Prior
    settings: TrackerSettings

    def evaluate(self, pose: Array) -> RegisteredViews:
        """Return the equations of all images, prior and joint limits at a pose."""
        settings = self.settings
        hypotheses = tuple(render_view(self.body, pose, view) for view in self.views)
        equations = sum_equations([
            *image_equations(hypotheses, self.views, settings),
            self.prior(pose),
            joint_limits(pose, settings.limit_weight),
            natural_stance(pose, settings.natural_weight, settings.ankle_weight),
        ])
        return RegisteredViews(hypotheses[0], equations, 1, hypotheses)


def image_equations(
    hypotheses: Sequence[ViewHypothesis], views: Sequence[View], settings: TrackerSettings
) -> list[PoseEquations]:
    """Return the normal equations of each image, all in the same coordinates."""
    return [
        equations_in_coordinates(
            [segment_equations(likelihood_rows(each, view.observation, settings))], each.twists
        )
        for each, view in zip(hypotheses, views, strict=True)
    ]


def views_quality(
    body: BodyModel, registered: RegisteredViews, views: Sequence[View], limit: float
) -> FitQuality:
    """Compare a registered pose with the images of several cameras.

    Figures are means over the cameras, weighted by the visible surface of the actor. The
    confidence of a joint is that of the camera that shows it best, with the variance that all
    images leave.

    Parameters
    ----------
    body : BodyModel
    registered : RegisteredViews
    views : sequence of View
        The same as in the registration.
    limit : float, meters
        As in `fit_quality`.
    """
    found, surfaces = [], []
    for hypothesis, view in zip(registered.hypotheses, views, strict=True):
        seen = Registered(hypothesis, registered.equations, 1)
        found.append(fit_quality(body, seen, view.observation, limit))
        surfaces.append(len(view.observation.pixels) * view.observation.pixel_area)
    if not found:
        return quality_without_actor()
    weights = np.array(surfaces)

    def mean(values: Sequence[float]) -> float:
        valid = np.isfinite(values)
        if not valid.any():
            return float("nan")
        return float(np.average(np.array(values)[valid], weights=weights[valid]))

    return FitQuality(
        residual=mean([each.residual for each in found]),
        coverage=mean([each.coverage for each in found]),
        score=mean([each.score for each in found]),
        off_actor=mean([each.off_actor for each in found]),
        too_near=mean([each.too_near for each in found]),
        unexplained=mean([each.unexplained for each in found]),
        confidence=np.max([each.confidence for each in found], axis=0),
    )
