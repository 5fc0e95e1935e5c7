"""The unit of joints whose file does not say it, by the size of the body that they make."""

from dataclasses import replace

import numpy as np

from ...errors import InvalidMotionError
from ...motion import JointRecording
from ...motion.humanoid import (
    MAX_BODY_SCALE,
    MIN_BODY_SCALE,
    estimate_body_scale,
    posture_positions,
)
from ...progress import Progress

UNITS = {1.0: "metres", 0.01: "centimetres", 0.001: "millimetres"}


def convert_to_body_unit(
    recording: JointRecording, unit: float, progress: Progress
) -> JointRecording:
    """Return a recording, taken in this unit, in the one of `UNITS` that makes a human body.

    It stays as it is where the unit does, where none does, or where no body is recognised.

    Parameters
    ----------
    recording : JointRecording
    unit : float, metres
    progress : Progress
        Told of another unit.
    """
    try:
        size = estimate_body_scale(posture_positions(recording))
    except InvalidMotionError:  # no hips
        return recording
    if MIN_BODY_SCALE <= size <= MAX_BODY_SCALE or not size > 0.0:
        return recording
    likely = min(UNITS, key=lambda other: abs(np.log(size * other / unit)))
    factor = likely / unit
    if not MIN_BODY_SCALE <= size * factor <= MAX_BODY_SCALE:
        return recording
    progress(1.0, describe_guessed_unit(likely))
    tracks = recording.tracks
    return replace(recording, tracks=tracks.with_positions(factor * tracks.positions))


def describe_guessed_unit(unit: float) -> str:
    """Say that lengths are taken for metres, centimetres or millimetres, and why."""
    return (
        f"Lengths are taken for {UNITS[unit]}, by the size of the body; give the unit if that"
        " is wrong"
    )
