"""How the reliability of joints is measured."""

from dataclasses import dataclass
from enum import Enum

from ...errors import InvalidSettingError
from ...settings import Settings, setting

SENSOR_RATE_HZ = 30.0
"""Hertz of the cameras that the published figures are for."""


class ReliabilityMethod(Enum):
    """Ways to combine what tells of a joint's reliability."""

    DEFAULT = "default"
    PUBLISHED = "published"


@dataclass(frozen=True, kw_only=True)
class ReliabilitySettings(Settings):
    """What is held against a joint."""

    method: ReliabilityMethod = setting(
        ReliabilityMethod.DEFAULT,
        "Default tells the chance that a joint is right, as measured errors teach it; published"
        " is the least of the three terms of Shum and others (2013)",
        advanced=True,
    )
    causal: bool = setting(
        False, "Ask past frames only, as a live system must; else those on both sides count"
    )
    inferred: float = setting(
        0.0, "What a joint counts for that the tracker inferred; higher trusts more",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    tolerance: float = setting(
        0.05, "Distance from the truth that is still right; higher trusts more",
        unit="m", minimum=0.005, maximum=0.5,
    )  # fmt: skip
    slowest: float = setting(
        0.9, "Speed below which a joint is never said to vibrate; higher forgives more",
        unit="m/s", minimum=0.0, maximum=100.0, advanced=True,
    )  # fmt: skip
    vibration_window: float = setting(
        0.1, "Time over which turns of the path are averaged; longer forgives single jumps",
        unit="s", minimum=0.01, maximum=1.0, advanced=True,
    )  # fmt: skip
    vibration_floor: float = setting(
        90.0, "Mean turn of the path that is still normal; higher forgives more",
        unit="degrees", minimum=0.0, maximum=179.0, advanced=True,
    )  # fmt: skip
    vibration_roof: float = setting(
        135.0, "Mean turn of the path at which nothing is believed; above the floor",
        unit="degrees", minimum=1.0, maximum=180.0, advanced=True,
    )  # fmt: skip
    window: float = setting(
        0.2, "Time over which reliability is averaged; longer recovers later",
        unit="s", minimum=0.01, maximum=2.0, advanced=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.vibration_roof <= self.vibration_floor:
            raise InvalidSettingError(
                f"vibration_roof is {self.vibration_roof:g} degrees; it must lie above"
                f" vibration_floor, {self.vibration_floor:g}."
            )


DEFAULT_SETTINGS = ReliabilitySettings()
