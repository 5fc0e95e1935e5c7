"""Judge units by the size of the body, and question unusual sizes."""

import re
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import (
    FileConventions,
    JointRecording,
    Motion,
    Skeleton,
    Tracks,
    find_humanoid_map,
)
from ...motion.humanoid import (
    ADULT_STATURE_M,
    estimate_body_scale,
    posture_positions,
)
from ...progress import Progress, Remark
from .axes import ADULT_REACH_M, CENTIMETER, MIN_BODY_JOINTS, longest_bone_path
from .marker_bodies import stature_of_markers
from .unit_estimate import (
    UNITS_OF_JOINTS,
    UNITS_OF_SKELETONS,
    describe_guessed_unit,
    estimate_unit,
)

ODD_STATURE_M = (0.8, 2.6)
"""Range of statures, meters, outside which the report asks. Chosen by hand: from a small child,
0.8 m, to more than the tallest people. It decides a sentence of the report only."""
HEAD_TO_ANKLE = 0.886
"""Path along the bones from the head to an ankle, relative to the stature. By definition of the
body in `smpl_body`."""
MIN_MAP_SCORE = 0.5
"""Score of a humanoid map, a fraction, from which its joints alone decide on unit, axes and
sides. Measured: in docs/benchmarks/importing.md bodies have 0.6 and more, crab and fox 0.04 and
0.24."""
OF_CMU = re.compile("hip ?_?joint|lowerback", re.IGNORECASE)
"""Names of joints that skeletons in Acclaim's unit have: those made from CMU's library."""
ENDS_OF_REACH = ("head", "leftHand", "rightHand"), ("leftFoot", "rightFoot")
"""Roles at both ends of the longest path along the bones of a body."""


def convert_to_body_unit(
    recording: JointRecording, unit: float, progress: Progress
) -> JointRecording:
    """Convert a recording to the most probable unit of its body (`estimate_unit`).

    It is unchanged if that is its own, or if no body is recognized.

    Parameters
    ----------
    recording : JointRecording
    unit : float, meters
        Default unit of the format, by which the recording was read.
    progress : Progress
        Receives a message if the unit changes.
    """
    try:
        size = estimate_body_scale(posture_positions(recording))
    except InvalidMotionError:  # no hips
        return recording
    if not size > 0.0:
        return recording
    estimated = estimate_unit(size / unit, UNITS_OF_JOINTS, default=unit)
    if estimated.unit == unit:
        return recording
    progress(1.0, Remark(describe_guessed_unit(estimated.unit, estimated.rival)))
    tracks = recording.tracks
    noted = replace(tracks.conventions or FileConventions(), unit=estimated.unit)
    positions = estimated.unit / unit * tracks.positions
    larger = replace(tracks, positions=positions, conventions=noted)
    return recording.with_tracks(larger)


def unit_of_skeleton(
    skeleton: Skeleton, progress: Progress, *, stated: float | None = None
) -> float:
    """Return the most probable unit of a skeleton, in meters (`estimate_unit`).

    It fits the body or, where none is recognized, all joints, and is centimeters with too few
    of them. Acclaim's unit is a candidate for a body only with the joints of CMU's library. A
    stated unit counts, unless a body is recognized whose size makes it improbable.

    Parameters
    ----------
    skeleton : Skeleton
        In the unit of the file.
    progress : Progress
        Receives a message if the unit is unusual or not the stated one.
    stated : float, meters, or None
        Unit that the file states.
    """
    offsets = offsets_of_body(skeleton)
    is_body = offsets is not skeleton.offsets
    reach = longest_bone_path(skeleton.parents, offsets)
    is_measurable = skeleton.n_joints >= MIN_BODY_JOINTS and 0.0 < reach < np.inf
    if stated is not None and not (is_body and is_measurable):
        return stated
    if not is_measurable:
        return CENTIMETER
    is_of_cmu = OF_CMU.search(" ".join(skeleton.names))
    units = UNITS_OF_JOINTS if is_body and not is_of_cmu else UNITS_OF_SKELETONS
    estimated = estimate_unit(reach / ADULT_REACH_M, units, default=stated, is_body=is_body)
    if estimated.unit != stated and (stated is not None or estimated.has_low_confidence):
        progress(1.0, Remark(describe_guessed_unit(estimated.unit, estimated.rival)))
    return estimated.unit


def offsets_of_body(skeleton: Skeleton) -> Array:
    """Return the offsets of the joints of the body, shape (n_joints, 3); zero elsewhere.

    A wrapper root, props and the position of the hips in the room have no offset then. All
    offsets are returned if no body is recognized from the head or a hand to a foot.
    """
    humanoid = find_humanoid_map(skeleton)
    roles = humanoid.indices(skeleton)
    if humanoid.score < MIN_MAP_SCORE or not all(
        any(role in roles for role in ends) for ends in ENDS_OF_REACH
    ):
        return skeleton.offsets
    chains = [
        {joint, *skeleton.ancestors(joint)} for role, joint in roles.items() if role != "hips"
    ]
    body = sorted(chains[0].union(*chains) - chains[0].intersection(*chains))
    offsets = np.zeros_like(skeleton.offsets)
    offsets[body] = skeleton.offsets[body]
    return offsets


def stature(recording: Motion | Tracks | JointRecording) -> float | None:
    """Return the height of the actor who stands upright, meters, whatever the pose.

    It follows from the bones, or from markers of head and feet; None where no body is
    recognized.
    """
    if isinstance(recording, Motion):
        return _stature_of_skeleton(recording)
    if isinstance(recording, Tracks):
        return stature_of_markers(recording.names, recording.positions)
    try:
        size = estimate_body_scale(posture_positions(recording))
    except InvalidMotionError:  # no hips
        return None
    return size * ADULT_STATURE_M if size > 0.0 else None


def question_of_size(recording: Motion | Tracks | JointRecording) -> str:
    """Return a question if the size of an actor is unusual; otherwise nothing."""
    tall = stature(recording)
    if tall is None or ODD_STATURE_M[0] <= tall <= ODD_STATURE_M[1]:
        return ""
    size = f"{float(f'{tall:.2g}'):,g}"
    return f"The actor is {size} m tall; set Unit or Scale if this is not right"


def _stature_of_skeleton(motion: Motion) -> float | None:
    skeleton, humanoid = motion.skeleton, find_humanoid_map(motion.skeleton)
    roles = humanoid.indices(skeleton) if humanoid.score >= MIN_MAP_SCORE else {}
    ankle = next((roles[each] for each in ("leftFoot", "rightFoot") if each in roles), None)
    if ankle is None or "head" not in roles:
        return None
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    above = [_to_root(skeleton.parents, joint) for joint in (roles["head"], ankle)]
    path = set(above[0]) ^ set(above[1])  # without what both have in common
    return float(lengths[list(path)].sum()) / HEAD_TO_ANKLE


def _to_root(parents: tuple[int, ...], joint: int) -> list[int]:
    chain = []
    while joint >= 0:
        chain.append(joint)
        joint = parents[joint]
    return chain
