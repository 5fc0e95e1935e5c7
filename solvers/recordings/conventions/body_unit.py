"""Estimate the unit of joints whose file does not state it, from the size of the body."""

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

UNIT_NAMES = {1.0: "meters", 0.01: "centimeters", 0.001: "millimeters"}


def convert_to_body_unit(
    recording: JointRecording, unit: float, progress: Progress
) -> JointRecording:
    """Convert a recording to the unit of `UNIT_NAMES` that gives a human body.

    It is unchanged if its unit already does, if no unit does, or if no body is recognized.

    Parameters
    ----------
    recording : JointRecording
    unit : float, meters
    progress : Progress
        Receives a message if the unit changes.
    """
    try:
        size = estimate_body_scale(posture_positions(recording))
    except InvalidMotionError:  # no hips
        return recording
    if MIN_BODY_SCALE <= size <= MAX_BODY_SCALE or not size > 0.0:
        return recording
    nearest_unit = min(UNIT_NAMES, key=lambda other: abs(np.log(size * other / unit)))
    factor = nearest_unit / unit
    if not MIN_BODY_SCALE <= size * factor <= MAX_BODY_SCALE:
        return recording
    progress(1.0, describe_guessed_unit(nearest_unit))
    tracks = recording.tracks
    return replace(recording, tracks=tracks.with_positions(factor * tracks.positions))


def describe_guessed_unit(unit: float) -> str:
    """Return a message that states the estimated unit of length, and why."""
    return (
        f"Lengths are interpreted as {UNIT_NAMES[unit]}, by the size of the body; give the unit"
        " if that is wrong"
    )
