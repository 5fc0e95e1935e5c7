"""Settings of Simulate: the ground, and how closely the body follows the take."""

from dataclasses import dataclass

from ..settings import Choice, Settings, setting


class Ground(Choice):
    """Height of the ground."""

    LIKELY = (
        "likely",
        "Use the given height if the take stands near it; otherwise the height of the feet",
        "Auto",
    )
    """At the given height where the take stands near it, or else under the feet."""
    HEIGHT = "height", "Put the ground at the given height", "Fixed Height"
    FEET = "auto", "Put the ground under the feet of the take", "Under Feet"


@dataclass(frozen=True, kw_only=True)
class SimulateSettings(Settings):
    """Parameters of the simulation."""

    strength: float = setting(
        1.0, "Blend from captured to simulated motion; 0 leaves the take unchanged",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    ground: Ground = setting(
        Ground.LIKELY,
        "Choose where the ground is",
    )
    ground_height: float = setting(
        0.0, "Height of the ground, unless Ground is Under Feet",
        unit="m", minimum=-1e4, maximum=1e4,
    )  # fmt: skip
    response: float = setting(
        5.0,
        "Set how quickly joints follow the captured pose; higher is closer, lower is softer",
        unit="Hz", minimum=0.5, maximum=15.0,
    )  # fmt: skip
    smoothing: float = setting(
        0.02, "Smooth the take before simulation; higher is smoother but blurs fast motion",
        unit="s", minimum=0.0, maximum=0.5,
    )  # fmt: skip
    friction: float = setting(
        1.0, "Friction coefficient of feet and ground; higher holds feet against sideways pull",
        minimum=0.0, maximum=5.0,
    )  # fmt: skip
    plant: bool = setting(
        True, "Keep planted feet from slipping; off relies on friction alone",
        label="Plant Feet",
    )  # fmt: skip
    support: float = setting(
        0.4, "Balancing force, as fraction of the body weight; lower relies more on the legs",
        minimum=0.0, maximum=3.0, advanced=True,
    )  # fmt: skip
