"""The settings of Physics."""

from dataclasses import dataclass
from enum import Enum

from ..settings import Settings, setting


class Ground(Enum):
    """Where the ground is."""

    LIKELY = "likely"
    """At the given height where the take stands near it, or else under the feet."""
    HEIGHT = "height"
    FEET = "auto"


@dataclass(frozen=True, kw_only=True)
class SimulateSettings(Settings):
    """How a motion is simulated."""

    strength: float = setting(
        1.0, "How much of the simulation the result takes over; 0 leaves the take as it is",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    ground: Ground = setting(
        Ground.LIKELY,
        "Where the ground is: at a given height, or under the feet of the take;"
        " or, likely, at the height if the take stands near it, else under the feet",
    )
    ground_height: float = setting(
        0.0, "Height of the ground, unless it is under the feet",
        unit="m", minimum=-1e4, maximum=1e4,
    )  # fmt: skip
    response: float = setting(
        5.0, "How quickly joints are pulled to the captured pose; higher follows it closer,"
        " lower is softer and lags behind",
        unit="Hz", minimum=0.5, maximum=15.0,
    )  # fmt: skip
    smoothing: float = setting(
        0.02, "Standard deviation of the Gaussian that calms the take first; higher is calmer"
        " but blurs quick moves",
        unit="s", minimum=0.0, maximum=0.5,
    )  # fmt: skip
    friction: float = setting(
        1.0, "Friction between feet and ground; higher holds feet that are pulled aside",
        minimum=0.0, maximum=5.0,
    )  # fmt: skip
    plant: bool = setting(
        True, "Also keep feet from creeping and slipping where they stand; off leaves them to"
        " friction alone",
    )  # fmt: skip
    support: float = setting(
        0.4, "Force from outside that may keep the body from falling, as a share of its weight;"
        " lower leaves more to its own legs",
        minimum=0.0, maximum=3.0, advanced=True,
    )  # fmt: skip
