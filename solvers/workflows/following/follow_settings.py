"""Settings of recordings that are tracked while they are written."""

from dataclasses import dataclass

from ...settings import Settings, setting


@dataclass(frozen=True, kw_only=True)
class FollowSettings(Settings):
    """When to measure the actor, which images to drop, and when to end."""

    calibration: float = setting(
        3.0, "Time at the start in which the actor is measured; move arms and legs", unit="s",
        minimum=0.5, maximum=30.0,
    )  # fmt: skip
    max_delay: float = setting(
        0.1, "Drop images that wait longer than this for the tracker; 0 drops none", unit="s",
        minimum=0.0, maximum=60.0,
    )  # fmt: skip
    max_silence: float = setting(
        5.0, "End after this time without a new image", unit="s",
        minimum=0.5, maximum=3600.0,
    )  # fmt: skip
    max_wait: float = setting(
        60.0, "Wait this long for the first image", unit="s",
        minimum=0.5, maximum=86_400.0,
    )  # fmt: skip
