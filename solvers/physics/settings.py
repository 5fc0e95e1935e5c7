"""Settings of Physics."""

from dataclasses import dataclass
from enum import Enum

from ..settings import Settings, setting


class Ground(Enum):
    """Height of the ground."""

    LIKELY = "likely"
    """At the given height if the take stands near it, otherwise under the feet."""
    HEIGHT = "height"
    FEET = "auto"


@dataclass(frozen=True, kw_only=True)
class SimulateSettings(Settings):
    """Parameters of the simulation."""

    strength: float = setting(
        1.0, "Blend factor between the take and the simulation; 0 leaves the take unchanged",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    ground: Ground = setting(
        Ground.LIKELY,
        "Height of the ground: the given height, or under the feet of the take;"
        " likely: the given height if the take stands near it, otherwise under the feet",
    )
    ground_height: float = setting(
        0.0, "Height of the ground, unless it is under the feet",
        unit="m", minimum=-1e4, maximum=1e4,
    )  # fmt: skip
    response: float = setting(
        5.0, "Natural frequency of the control that pulls joints to the captured pose;"
        " higher follows it closer, lower is softer and lags behind",
        unit="Hz", minimum=0.5, maximum=15.0,
    )  # fmt: skip
    smoothing: float = setting(
        0.02, "Standard deviation of the Gaussian that smooths the take first;"
        " higher is smoother but blurs fast movements",
        unit="s", minimum=0.0, maximum=0.5,
    )  # fmt: skip
    friction: float = setting(
        1.0, "Friction coefficient of feet and ground; higher holds feet against sideways pull",
        minimum=0.0, maximum=5.0,
    )  # fmt: skip
    plant: bool = setting(
        True, "Keep standing feet from creeping and slipping; off leaves them to friction",
    )  # fmt: skip
    support: float = setting(
        0.4, "Maximum external force that keeps the body from falling, as a fraction of its"
        " weight; lower leaves more to its legs",
        minimum=0.0, maximum=3.0, advanced=True,
    )  # fmt: skip
