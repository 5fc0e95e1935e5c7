"""Settings of the tracker: weights of its terms, and steps of its solver."""

from dataclasses import dataclass

from ...settings import Settings, setting


def _weight(default: float, help: str, unit: str = "1/m2", *, former: str = "") -> float:
    value: float = setting(
        default, help, unit=unit, minimum=0.0, maximum=1e9, advanced=True, former=former
    )
    return value


@dataclass(frozen=True, kw_only=True)
class TrackerSettings(Settings):
    """Weights of the terms of the tracker, and its solver. A weight of 0 disables a term.

    Pixel weights apply to pixels that cover 4 square centimeters. They scale with distance and
    resolution.
    """

    image_width: int = setting(
        160, "Columns of the subsampled depth image; higher is finer and slower",
        minimum=20, maximum=4096, former="picture_width",
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
    similar_weight: float = _weight(
        30.0, "Weight of the similarity to poses of the motion prior, if any", "1/rad2"
    )
    shift_weight: float = _weight(
        400.0, "Smoothness of the hip translation; higher is smoother and follows slower"
    )
    rotation_weight: float = _weight(
        60.0,
        "Smoothness of the joint rotations; higher is smoother and follows slower",
        "1/rad2",
        former="turn_weight",
    )
    prediction: float = setting(
        0.7, "Fraction of the last movement used for prediction; higher follows faster motion",
        minimum=0.0, maximum=1.0, advanced=True, former="trust",
    )  # fmt: skip
    start_ahead: bool = setting(
        True, "Start each frame at the predicted pose instead of the previous pose",
        advanced=True,
    )  # fmt: skip
    natural_weight: float = _weight(
        2.0, "Weight of the pull toward upright standing; higher is smoother for hidden"
        " limbs",
        "1/rad2",
    )  # fmt: skip
    ankle_weight: float = _weight(
        30.0, "Weight that keeps feet perpendicular to the shanks; 1e6 locks the ankles as"
        " in [WZC12]", "1/rad2",
    )  # fmt: skip
    limit_weight: float = _weight(2000.0, "Weight of the joint limits", "1/rad2")
    damping: float = setting(
        1.0, "Minimum damping of each step; higher is more stable and slower",
        minimum=0.0, maximum=1e6, advanced=True,
    )  # fmt: skip
    max_step: float = setting(
        0.35, "Maximum joint rotation in one step; higher is faster and less stable",
        unit="rad", minimum=0.01, maximum=10.0, advanced=True, former="longest_step",
    )  # fmt: skip
    accept_only_better: bool = setting(
        True, "Reject steps that increase the cost", advanced=True
    )


DEFAULT_TRACKER = TrackerSettings()
"""Settings with the best benchmark results."""
