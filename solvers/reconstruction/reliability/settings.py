"""Settings of the reliability measure."""

from dataclasses import dataclass

from ...errors import InvalidSettingError
from ...settings import Choice, Settings, setting

SENSOR_RATE_HZ = 30.0
"""Frame rate (Hz) of the cameras for which [SHJT13] gives its thresholds."""
WRONG_RELIABILITY = 0.02
"""Reliability up to which a joint is wrong: nothing shows where it is. It is also the minimum
weight of a joint in a correction, which has no solution for a joint of weight 0. Sweep: x10
costs 4.4 %. It guards joints that are far off:
`test_wrong_joint_is_replaced_and_an_uncertain_one_stays_near`."""
REPLACED_RELIABILITY = 0.2
"""Reliability below which a joint takes the position of a library pose; joints that one round
of the search completed with confidence have it in the next. Chosen by hand; `make sensitivity`
varies it."""
OBSERVED_RELIABILITY = 0.5
"""Reliability from which a joint keeps its observed position, and library poses are compared
with it; between `REPLACED_RELIABILITY` and this one, both positions are blended. Chosen by
hand; `make sensitivity` varies it."""


class ReliabilityMethod(Choice):
    """Ways to combine the terms of reliability."""

    DEFAULT = "default", "Estimate from measured errors the probability that a joint is right"
    PUBLISHED = (
        "published",
        "Use the smallest of the three terms of Shum et al. (2013)",
        "Shum et al. 2013",
    )


@dataclass(frozen=True, kw_only=True)
class ReliabilitySettings(Settings):
    """Settings of `measure_reliability`."""

    method: ReliabilityMethod = setting(
        ReliabilityMethod.DEFAULT,
        "Choose how to compute the reliability of a joint",
        advanced=True,
    )
    causal: bool = setting(False, "Use only earlier frames, as in a live system")
    inferred: float = setting(
        0.0, "Reliability of joints that the tracker inferred; higher relies on them more",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    tolerance: float = setting(
        0.05, "Position error that still counts as right; higher rates joints as more reliable",
        unit="m", minimum=0.005, maximum=0.5,
    )  # fmt: skip
    min_vibration_speed: float = setting(
        0.9, "Speed below which a joint never counts as vibrating; higher flags fewer joints",
        unit="m/s", minimum=0.0, maximum=100.0, advanced=True, former="slowest",
    )  # fmt: skip
    vibration_window: float = setting(
        0.1, "Time over which direction changes of the path are averaged; longer ignores"
        " single jumps",
        unit="s", minimum=0.01, maximum=1.0, advanced=True,
    )  # fmt: skip
    min_vibration_angle: float = setting(
        90.0, "Mean direction change of the path that is still normal; higher flags fewer"
        " joints",
        unit="degrees", minimum=0.0, maximum=179.0, advanced=True, former="vibration_floor",
    )  # fmt: skip
    max_vibration_angle: float = setting(
        135.0, "Mean direction change of the path at which reliability is 0; must be above the"
        " minimum",
        unit="degrees", minimum=1.0, maximum=180.0, advanced=True, former="vibration_roof",
    )  # fmt: skip
    window: float = setting(
        0.2, "Time over which reliability is averaged; longer recovers more slowly",
        unit="s", minimum=0.01, maximum=2.0, advanced=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.max_vibration_angle <= self.min_vibration_angle:
            raise InvalidSettingError(
                f"max_vibration_angle is {self.max_vibration_angle:g} degrees; it must lie"
                f" above min_vibration_angle, {self.min_vibration_angle:g}."
            )


DEFAULT_SETTINGS = ReliabilitySettings()
