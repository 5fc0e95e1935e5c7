"""How the tracker weighs what it sees, and the presets of the papers."""

from dataclasses import dataclass

import numpy as np

from ...settings import Settings, setting


def _weight(default: float, help: str, unit: str = "1/m2") -> float:
    value: float = setting(default, help, unit=unit, minimum=0.0, maximum=1e9, advanced=True)
    return value


@dataclass(frozen=True, kw_only=True)
class TrackerSettings(Settings):
    """Weights of the terms of the tracker, and how it solves. A weight of 0 leaves a term out.

    Weights of pixels are those of pixels that see 4 square centimetres, and follow from there
    with distance and resolution.
    """

    picture_width: int = setting(
        160, "Columns of the picture that are looked at; more is finer and slower",
        minimum=20, maximum=4096,
    )  # fmt: skip
    iterations: int = setting(
        6, "Most steps per frame; more follows quick movements farther", minimum=1, maximum=100
    )
    coarse_iterations: int = setting(
        2, "How many of them look at a quarter of the pixels only; more is faster",
        minimum=0, maximum=100, advanced=True,
    )  # fmt: skip
    limit: float = setting(
        0.08, "Depths farther apart belong to different parts of the body; more compares more",
        unit="m", minimum=0.005, maximum=1.0, advanced=True,
    )  # fmt: skip
    robust_scale: float = setting(
        0.06, "Distance from which on points count less; more trusts far points",
        unit="m", minimum=0.005, maximum=10.0, advanced=True,
    )  # fmt: skip
    closest_weight: float = _weight(4000.0, "How much observed points pull the surface")
    off_actor_weight: float = _weight(300.0, "How much the body must stay inside the outline")
    too_near_weight: float = _weight(300.0, "How much the body must leave free space free")
    depth_weight: float = _weight(2000.0, "Weight of the depth image term of [WZC12]")
    extra_weight: float = _weight(1000.0, "Weight of the extra depth term of [WZC12]")
    silhouette_weight: float = _weight(0.1, "Weight of the silhouette term of [WZC12]", "")
    surface_weight: float = _weight(0.0, "Weight of the surface term of [LOU12]")
    edge_weight: float = _weight(0.0, "Weight of the edge term of [LOU12]")
    similar_weight: float = _weight(
        30.0, "How much poses must be like those of the motion prior, if there is one", "1/rad2"
    )
    shift_weight: float = _weight(
        400.0, "How smoothly the hips move; more is steadier and follows slower"
    )
    turn_weight: float = _weight(
        60.0, "How smoothly joints turn; more is steadier and follows slower", "1/rad2"
    )
    trust: float = setting(
        0.7, "How much of a movement is expected to go on; more follows quick movements",
        minimum=0.0, maximum=1.0, advanced=True,
    )  # fmt: skip
    start_ahead: bool = setting(
        True, "Start each frame where it is expected rather than at the frame before",
        advanced=True,
    )  # fmt: skip
    apart_weight: float = _weight(0.0, "How much limbs push each other apart")
    natural_weight: float = _weight(
        2.0, "How much joints are drawn to upright standing; more is calmer where little shows",
        "1/rad2",
    )  # fmt: skip
    ankle_weight: float = _weight(
        30.0, "How much feet are held square to the shanks; 1e6 leaves them no ankles, as the"
        " 34 coordinates of [WZC12]", "1/rad2",
    )  # fmt: skip
    limit_weight: float = _weight(2000.0, "How hard the joint limits are", "1/rad2")
    damping: float = setting(
        1.0, "Least resistance to each step; more is safer and slower",
        minimum=0.0, maximum=1e6, advanced=True,
    )  # fmt: skip
    longest_step: float = setting(
        0.35, "Most that a joint turns within one step; more is quicker and riskier",
        unit="rad", minimum=0.01, maximum=10.0, advanced=True,
    )  # fmt: skip
    accept_only_better: bool = setting(
        True, "Take back steps that make the fit worse", advanced=True
    )


NO_ANKLES = 1e6
"""`ankle_weight` that makes feet one with the shanks."""

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
"""Terms and standard deviations of [WZC12] appendix A, in metres and radians; each pixel of
ours counts as four of their 320 columns."""

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
smoothness 0.00001 (a pixel of 320 columns sees about a quarter of what weights are for).

The paper tells no units. Angles are taken to be in degrees, as in the recorded motions that it
learns from: with weights per square radian neither prior nor smoothness weighs anything, and
the actor is lost within a second."""

DEFAULT_TRACKER = TrackerSettings()
"""What measured best."""
