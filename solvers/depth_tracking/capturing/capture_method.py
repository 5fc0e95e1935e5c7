"""Methods of *Track*: the default, and the two systems as published."""

from dataclasses import replace

from ...errors import InvalidSettingError
from ...settings import Choice
from ..published import EDGE_TRACKER, REGISTRATION_TRACKER, EdgeLikelihood
from .passes import TrackingContext
from .restart_policies import RestartPolicy, RestartsAfterFailures


class CaptureMethod(Choice):
    """Method of tracking."""

    DEFAULT = "default", "Use the terms of both papers and joint limits, then smooth the take"
    REGISTRATION = (
        "wei",
        "Track forward as published by Wei et al. (2012); nothing is smoothed",
        "Wei et al. 2012",
    )
    """[WZC12]: depth image, extra depth and silhouette; the detector after each failure."""
    EDGES = (
        "lou",
        "Track color and depth edges as published by Lou (2012); nothing is smoothed",
        "Lou 2012",
    )
    """[LOU12]: surface with color, edges and motion prior; the detector at the start only."""


def check_default_method(method: CaptureMethod) -> None:
    """Raise InvalidSettingError if a published method is to do more than it can.

    Published methods track one person in the complete recording of one camera.
    """
    if method is not CaptureMethod.DEFAULT:
        raise InvalidSettingError(
            f"The method {method.value} tracks one person in the complete recording of one"
            " camera. Use the default method."
        )


def published_system(
    actor: TrackingContext, method: CaptureMethod
) -> tuple[TrackingContext, RestartPolicy]:
    """Return the tracker of a published method, and when its detector runs."""
    if method is CaptureMethod.REGISTRATION:
        tracker, likelihood = REGISTRATION_TRACKER, actor.likelihood
    else:
        tracker, likelihood = EDGE_TRACKER, EdgeLikelihood(actor.depth)
    recovers = method is CaptureMethod.REGISTRATION
    policy = RestartsAfterFailures(actor.recovery, recovers=recovers)
    return replace(actor, tracker=tracker, likelihood=likelihood), policy
