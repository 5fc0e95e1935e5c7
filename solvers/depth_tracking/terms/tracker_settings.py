"""Settings of the tracker: weights of its terms, and the presets of the papers."""

from dataclasses import dataclass

import numpy as np

from ...settings import Settings, setting


def _weight(default: float, help: str, unit: str = "1/m2") -> float:
    value: float = setting(default, help, unit=unit, minimum=0.0, maximum=1e9, advanced=True)
    return value


@dataclass(frozen=True, kw_only=True)
class TrackerSettings(Settings):
    """Weights of the terms of the tracker, and its solver. A weight of 0 disables a term.

    Pixel weights apply to pixels that cover 4 square centimeters. They scale with distance and
    resolution.
    """

    picture_width: int = setting(
        160, "Columns of the subsampled depth image; higher is finer and slower",
        minimum=20, maximum=4096,
    )  # fmt: skip
    iterations: int = setting(
        6, "Maximum steps per frame; higher follows faster motion", minimum=1, maximum=100
    )
    coarse_iterations: int = setting(
        2, "Number of these steps that use a quarter of the pixels; higher is faster",
        minimum=0, maximum=100, advanced=True,
    )  # fmt: skip
    limit: float = setting(
        0.08, "Depth difference between different body parts; higher compares more pixels",
        unit="m", minimum=0.005, maximum=1.0, advanced=True,
    )  # fmt: skip
    robust_scale: float = setting(
        0.06, "Distance above which points lose weight; higher weighs distant points more",
        unit="m", minimum=0.005, maximum=10.0, advanced=True,
    )  # fmt: skip
    closest_weight: float = _weight(
        4000.0, "Weight of the pull of observed points on the surface"
    )
    off_actor_weight: float = _weight(300.0, "Weight of the body staying inside the outline")
    too_near_weight: float = _weight(
        300.0, "Weight of the body staying out of observed free space"
    )
    depth_weight: float = _weight(2000.0, "Weight of the depth image term of [WZC12]")
    extra_weight: float = _weight(1000.0, "Weight of the extra depth term of [WZC12]")
    silhouette_weight: float = _weight(0.1, "Weight of the silhouette term of [WZC12]", "")
    surface_weight: float = _weight(0.0, "Weight of the surface term of [LOU12]")
    edge_weight: float = _weight(0.0, "Weight of the edge term of [LOU12]")
    similar_weight: float = _weight(
        30.0, "Weight of the similarity to poses of the motion prior, if any", "1/rad2"
    )
    shift_weight: float = _weight(
        400.0, "Smoothness of the hip translation; higher is smoother and follows slower"
    )
    turn_weight: float = _weight(
        60.0,
        "Smoothness of the joint rotations; higher is smoother and follows slower",
        "1/rad2",
    )
    trust: float = setting(
        0.7, "Fraction of the last movement used for prediction; higher follows faster motion",
        minimum=0.0, maximum=1.0, advanced=True,
    )  # fmt: skip
    start_ahead: bool = setting(
        True, "Start each frame at the predicted pose instead of the previous pose",
        advanced=True,
    )  # fmt: skip
    apart_weight: float = _weight(0.0, "Weight of the separation of overlapping limbs")
    natural_weight: float = _weight(
        2.0, "Weight of the pull toward upright standing; higher is smoother for hidden"
        " limbs",
        "1/rad2",
    )  # fmt: skip
    ankle_weight: float = _weight(
        30.0, "Weight that keeps feet perpendicular to the shanks; 1e6 locks the ankles, as in"
        " the 34 coordinates of [WZC12]", "1/rad2",
    )  # fmt: skip
    limit_weight: float = _weight(2000.0, "Weight of the joint limits", "1/rad2")
    damping: float = setting(
        1.0, "Minimum damping of each step; higher is more stable and slower",
        minimum=0.0, maximum=1e6, advanced=True,
    )  # fmt: skip
    longest_step: float = setting(
        0.35, "Maximum joint rotation in one step; higher is faster and less stable",
        unit="rad", minimum=0.01, maximum=10.0, advanced=True,
    )  # fmt: skip
    accept_only_better: bool = setting(
        True, "Reject steps that increase the cost", advanced=True
    )


NO_ANKLES = 1e6
"""`ankle_weight` that locks the ankles."""

PER_DEGREE = (180.0 / np.pi) ** 2
"""Squared degrees in a squared radian."""

WZC12 = TrackerSettings(
    iterations=5, coarse_iterations=0, limit=0.08,
    closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0,
    depth_weight=4.0, extra_weight=4.0 / 0.29**2, silhouette_weight=4.0 / 100.0**2,
    shift_weight=1.0 / 14.3**2, turn_weight=1.0 / 14.3**2,
    trust=1.0, start_ahead=False,
    limit_weight=0.0, natural_weight=0.0, ankle_weight=NO_ANKLES, damping=1e-6,
    longest_step=10.0, accept_only_better=False,
)  # fmt: skip
"""Terms and standard deviations of [WZC12] appendix A, in meters and radians; each pixel
here counts as four of their pixels (320 columns)."""

LOU12 = TrackerSettings(
    picture_width=320, iterations=10, coarse_iterations=0,
    closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0,
    depth_weight=0.0, extra_weight=0.0, silhouette_weight=0.0,
    surface_weight=4.0, edge_weight=40.0, similar_weight=0.001 * PER_DEGREE,
    shift_weight=1e-5, turn_weight=1e-5 * PER_DEGREE, trust=0.0,
    limit_weight=0.0, natural_weight=0.0, ankle_weight=NO_ANKLES, damping=1e-6,
    longest_step=10.0, accept_only_better=False,
)  # fmt: skip
"""Terms and weights of [LOU12] sections 3.4 to 3.6: surface 1, edges 10, motion prior 0.001,
smoothness 0.00001 (a pixel of 320 columns covers about a quarter of the reference area).

The paper gives no units. Angles are interpreted in degrees, as in its training motions. With
weights per square radian, prior and smoothness have no effect, and tracking fails within a
second."""

DEFAULT_TRACKER = TrackerSettings()
"""Settings with the best benchmark results."""
