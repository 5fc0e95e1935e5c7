"""Standardize the joint names of a recording, and check that it can be reconstructed."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from ..motion.humanoid import (
    ADULT_STATURE_M,
    MAX_BODY_SCALE,
    MIN_BODY_SCALE,
    POSTURE_JOINTS,
    UPPER_LEG_ROLES,
    estimate_body_scale,
    fill_missing_hips,
    posture_joint_indices,
    posture_positions,
)
from ..signals import find_runs

MIN_GAP_S = 1.0
"""Minimum duration of a gap of all joints that is reported, seconds. Chosen by hand: 1 s is no
remark on every dropped frame; it decides a sentence of the report only."""
UNITS = {0.001: "millimeters", 0.01: "centimeters", 0.0254: "inches", 1000.0: "kilometers"}
KINECT_V1 = dict(zip(POSTURE_JOINTS, SENSOR_JOINTS[Sensor.KINECT_V1], strict=True))
"""Joint names of the Kinect v1 by posture joint."""
Value = TypeVar("Value", np.int8, np.float64)


def standardize_joint_names(recording: JointRecording) -> JointRecording:
    """Return the recording with joint names whose hierarchy is known.

    Names of a known tracker stay. Other names are mapped by their humanoid roles to those of
    the Kinect v1. Hips that are missing or never tracked are placed between the legs.

    Raises
    ------
    InvalidMotionError
        Nothing is tracked, or no body is recognized.
    """
    check_tracked(recording)
    parents = recording.parents
    if parents.count(-1) == 1 and "hips" in posture_joint_indices(recording.names):
        return fill_missing_hips(recording)
    return fill_missing_hips(_joints_by_role(recording))


def check_tracked(recording: JointRecording) -> None:
    """Raise InvalidMotionError if at most one joint is ever tracked."""
    tracks = recording.tracks
    tracked = tracks.visible.any(axis=0)
    if not tracked.any():
        raise InvalidMotionError(
            f"No joint is tracked in any of the {tracks.n_frames} frames; there is nothing to"
            " reconstruct."
        )
    if tracked.sum() < 2:
        name = tracks.names[int(np.argmax(tracked))]
        raise InvalidMotionError(
            f"Only one joint ({name}) is ever tracked; poses need hips and limbs."
        )


def _joints_by_role(recording: JointRecording) -> JointRecording:
    tracks, state = recording.tracks, recording.tracking_state
    columns = posture_joint_indices(tracks.names)
    joints = {role: [column] for role, column in columns.items()}
    legs = [columns[leg] for leg in UPPER_LEG_ROLES if leg in columns]
    if "hips" not in columns and len(legs) == len(UPPER_LEG_ROLES):
        joints["hips"] = legs
    if "hips" not in joints or len(joints) < 2:
        raise InvalidMotionError(
            "No body was recognized in the names of the joints"
            f" ({', '.join(tracks.names[:4])}); they must be those of a Kinect, or humanoid"
            " roles such as hips and leftUpperArm."
        )
    groups = list(joints.values())
    body = Tracks(
        tuple(KINECT_V1[role] for role in joints),
        np.stack([tracks.positions[:, group].mean(axis=1) for group in groups], axis=1),
        tracks.frame_rate,
        None if tracks.confidence is None else _minimum(tracks.confidence, groups),
    )
    return JointRecording(
        body, None if state is None else _minimum(state, groups), Sensor.OTHER
    )


def _minimum(values: NDArray[Value], groups: list[list[int]]) -> NDArray[Value]:
    """Return the minimum over each group of joints."""
    return np.stack([values[:, group].min(axis=1) for group in groups], axis=1)


def check_size(recording: JointRecording) -> None:
    """Raise InvalidMotionError with a probable unit if the body is not of human size."""
    size = estimate_body_scale(posture_positions(recording))
    if np.isnan(size):
        return
    if size == 0.0:
        raise InvalidMotionError(
            "All joints have the same position, as some exporters write them where no body is"
            " tracked. Choose a recording of a tracked actor."
        )
    if MIN_BODY_SCALE <= size <= MAX_BODY_SCALE:
        return
    unit = min(UNITS, key=lambda factor: abs(np.log(size * factor)))
    human = MIN_BODY_SCALE <= size * unit <= MAX_BODY_SCALE
    tall = f"{ADULT_STATURE_M * size:.3g}"
    if human:
        raise InvalidMotionError(
            f"The body is {tall} m tall, as if {UNITS[unit]} were read as meters. Read the"
            f" recording with a scale of {unit:g}."
        )
    raise InvalidMotionError(
        f"The body is {tall} m tall. Read the recording with a scale of {1.0 / size:.3g}."
    )


def gap_remarks(recording: JointRecording) -> list[str]:
    """Report the longest gap of all joints, if it is long."""
    gaps = find_runs(~recording.tracks.visible.any(axis=1))
    if not gaps:
        return []
    start, stop = max(gaps, key=lambda gap: gap[1] - gap[0])
    seconds, start_s = (stop - start) / recording.frame_rate, start / recording.frame_rate
    if seconds < MIN_GAP_S:
        return []
    return [
        f"Nothing was tracked for {seconds:.1f} s from {start_s:.1f} s on; the motion there is"
        " an estimate."
    ]
