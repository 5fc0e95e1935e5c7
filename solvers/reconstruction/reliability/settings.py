"""Settings of the reliability measure."""

from dataclasses import dataclass
from enum import Enum

from ...errors import InvalidSettingError
from ...settings import Settings, setting

SENSOR_RATE_HZ = 30.0
"""Frame rate (Hz) of the cameras for which [SHJT13] gives its thresholds."""


class ReliabilityMethod(Enum):
    """Ways to combine the terms of reliability."""

    DEFAULT = "default"
    PUBLISHED = "published"


@dataclass(frozen=True, kw_only=True)
class ReliabilitySettings(Settings):
    """Settings of `measure_reliability`."""

    method: ReliabilityMethod = setting(
        ReliabilityMethod.DEFAULT,
        "Default is the probability that a joint is right, learned from measured errors."
        " Published is the minimum of the three terms of Shum and others (2013)",
        advanced=True,
    )
    causal: bool = setting(
        False,
        "Use only earlier frames, as a live system must; otherwise use frames on both sides",
    )
    inferred: float = setting(
        0.0, "Reliability of joints that the tracker inferred; higher keeps more of them",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    tolerance: float = setting(
        0.05, "Error up to which a joint counts as right; higher rates joints as more reliable",
        unit="m", minimum=0.005, maximum=0.5,
    )  # fmt: skip
    slowest: float = setting(
        0.9, "Speed below which a joint never counts as vibrating; higher tolerates more",
        unit="m/s", minimum=0.0, maximum=100.0, advanced=True,
    )  # fmt: skip
    vibration_window: float = setting(
        0.1, "Time over which changes of direction are averaged; longer tolerates single jumps",
        unit="s", minimum=0.01, maximum=1.0, advanced=True,
    )  # fmt: skip
    vibration_floor: float = setting(
        90.0, "Mean change of direction up to which the path is normal; higher tolerates more",
        unit="degrees", minimum=0.0, maximum=179.0, advanced=True,
    )  # fmt: skip
    vibration_roof: float = setting(
        135.0, "Mean change of direction from which on reliability is 0; must exceed the floor",
        unit="degrees", minimum=1.0, maximum=180.0, advanced=True,
    )  # fmt: skip
    window: float = setting(
        0.2, "Time over which reliability is averaged; longer recovers more slowly",
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
