"""The output of a live take, frame by frame, and its settings."""

from dataclasses import dataclass
from typing import NamedTuple

from ...motion import Motion
from ...reconstruction import LivePose
from ...settings import Settings, setting


@dataclass(frozen=True, kw_only=True)
class LiveTakeSettings(Settings):
    """Settings of `LiveTake`."""

    calibration_s: float = setting(
        3.0, "Time at the start in which the actor is measured; move arms and legs", unit="s",
        minimum=1.0, maximum=30.0, label="Calibration",
    )  # fmt: skip
    smoothing: float = setting(
        0.05, "Remove jitter shorter than about this; higher is smoother but later",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip


DEFAULT_SETTINGS = LiveTakeSettings()


class LiveMotion(NamedTuple):
    """One frame of the actor.

    Attributes
    ----------
    frame : int
        Time slot after calibration, at the rate of the stream; slots without data are left out.
    motion : Motion
        One frame, without gaps.
    joints : LivePose, optional
        None for streams of bones, which are not reconstructed.
    body : int
        The person in the stream.
    """

    frame: int
    motion: Motion
    joints: LivePose | None
    body: int
