"""A recording whose joints hang together, whatever its tracker calls them."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import JOINTS, JointRecording, Sensor, Tracks
from ..motion.humanoid import (
    LARGEST,
    LEGS,
    POSTURE_JOINTS,
    SMALLEST,
    STATURE,
    joints_of_names,
    posture_positions,
    size_of_body,
    with_hips,
)

LONG_GAP = 1.0
"""Seconds without any joint, from which on the result is a guess that is worth a word."""
UNITS = {0.001: "millimetres", 0.01: "centimetres", 0.0254: "inches", 1000.0: "kilometres"}
KINECT_V1 = dict(zip(POSTURE_JOINTS, JOINTS[Sensor.KINECT_V1], strict=True))
"""What the first Kinect calls the joints of postures."""
Word = TypeVar("Word", np.int8, np.float64)


def standardize_joint_names(recording: JointRecording) -> JointRecording:
    """Return the recording, or its joints under the names of the first Kinect's.

    Names of which it is known how they hang together stay. Others are understood by their
    humanoid roles. Hips that are missing, or never tracked, are put between the legs.

    Raises
    ------
    InvalidMotionError
        Nothing is ever tracked, or no body is recognised.
    """
    check_tracked(recording)
    parents = recording.parents
    if parents.count(-1) == 1 and "hips" in joints_of_names(recording.names):
        return with_hips(recording)
    return with_hips(_by_roles(recording))


def check_tracked(recording: JointRecording) -> None:
    """Raise InvalidMotionError where nothing, or a single joint, is ever tracked."""
    tracks = recording.tracks
    seen = tracks.visible.any(axis=0)
    if not seen.any():
        raise InvalidMotionError(
            f"No joint is tracked in any of the {tracks.n_frames} frames; there is nothing to"
            " reconstruct."
        )
    if seen.sum() < 2:
        name = tracks.names[int(np.argmax(seen))]
        raise InvalidMotionError(
            f"Only one joint ({name}) is ever tracked; poses need hips and limbs."
        )


def _by_roles(recording: JointRecording) -> JointRecording:
    tracks, state = recording.tracks, recording.tracking_state
    places = joints_of_names(tracks.names)
    joints = {role: [place] for role, place in places.items()}
    legs = [places[leg] for leg in LEGS if leg in places]
    if "hips" not in places and len(legs) == len(LEGS):
        joints["hips"] = legs
    if "hips" not in joints or len(joints) < 2:
        raise InvalidMotionError(
            "No body was recognised in the names of the joints"
            f" ({', '.join(tracks.names[:4])}); they must be those of a Kinect, or humanoid"
            " roles such as hips and leftUpperArm."
        )
    chosen = list(joints.values())
    body = Tracks(
        tuple(KINECT_V1[role] for role in joints),
        np.stack([tracks.positions[:, some].mean(axis=1) for some in chosen], axis=1),
        tracks.frame_rate,
        None if tracks.confidence is None else _least(tracks.confidence, chosen),
    )
    return JointRecording(body, None if state is None else _least(state, chosen), Sensor.OTHER)


def _least(told: NDArray[Word], chosen: list[list[int]]) -> NDArray[Word]:
    """Return the least that is told of the joints that each is made of."""
    return np.stack([told[:, some].min(axis=1) for some in chosen], axis=1)


def check_size(recording: JointRecording) -> None:
    """Raise InvalidMotionError, and guess the unit, where the body is not of human size."""
    size = size_of_body(posture_positions(recording))
    if np.isnan(size):
        return
    if size == 0.0:
        raise InvalidMotionError(
            "The joints are all in one place, as some exporters write them where no body is"
            " tracked; choose a recording of an actor who was tracked."
        )
    if SMALLEST <= size <= LARGEST:
        return
    unit = min(UNITS, key=lambda factor: abs(np.log(size * factor)))
    human = SMALLEST <= size * unit <= LARGEST
    guess = f", as if {UNITS[unit]} were taken for metres" if human else ""
    scale = f"{unit:g}" if human else f"{1.0 / size:.3g}"
    raise InvalidMotionError(
        f"The body is {STATURE * size:.3g} m tall{guess}. Read the recording with a scale of"
        f" {scale}."
    )


def gap_remarks(recording: JointRecording) -> list[str]:
    """Tell of the longest time at which nothing was tracked, if it is long."""
    blank = ~recording.tracks.visible.any(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], blank, [False]]).astype(np.int8)))
    starts, stops = edges[::2], edges[1::2]
    if not len(starts):
        return []
    longest = int(np.argmax(stops - starts))
    seconds = (stops - starts)[longest] / recording.frame_rate
    if seconds < LONG_GAP:
        return []
    start = starts[longest] / recording.frame_rate
    return [
        f"Nothing was tracked for {seconds:.1f} s from {start:.1f} s on; what moves there is"
        " a guess."
    ]
