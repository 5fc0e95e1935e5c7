"""Rebuild the poses of a motion that a depth camera's tracker recorded."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import (
    HumanoidMap,
    JointRecording,
    Motion,
    Sensor,
    Tracks,
    find_humanoid_map,
    forward_kinematics,
    joint_parents,
)
from ..motion.humanoid import (
    POSTURE_JOINTS,
    posture_joint_indices,
    posture_positions,
    postures_from_motion,
)
from ..progress import Progress, unwatched, within
from ..reconstruction import (
    PostureLibrary,
    Reconstruction,
    ReconstructSettings,
    Reliability,
    ResidualPrior,
    reconstruct,
)
from ..reconstruction.joint_rotations import (
    fit_motion_to_postures,
    resize_skeleton,
)
from ..recordings.conventions import keep_on_floor
from .changed_joints import find_changed_joints, shift_remarks
from .joints_from_source import joints_from_source
from .standard_joints import KINECT_V1, check_size, check_tracked, gap_remarks

RECONSTRUCT_SETTINGS = ReconstructSettings()
LENGTH_TOLERANCE = 1e-6
"""Deviation of a length term, a ratio, from 0 or 1 that counts as rounding."""


@dataclass(frozen=True, eq=False)
class RebuiltMotion:
    """Clean motion of a skeleton.

    Attributes
    ----------
    motion : Motion
        Of the given skeleton, apart from the lengths of its bones; without gaps.
    reliability_terms : Reliability
        Reliability of each joint and its terms. NaN for joints that are not posture joints; a
        term that the take cannot measure is NaN everywhere.
    confidence : shape (n_frames, n_joints), 0 to 1
        Confidence of the result; NaN for the same joints.
    rebuilt : bool, shape (n_frames, n_joints)
        Joints that were missing or were moved.
    method : str
        Description of the method.
    remarks : tuple of str
        Sentences the animator should read.
    """

    motion: Motion
    reliability_terms: Reliability
    confidence: Array
    rebuilt: NDArray[np.bool_]
    method: str
    remarks: tuple[str, ...]

    @property
    def reliability(self) -> Array:
        """Reliability of each joint, shape (n_frames, n_joints), 0 to 1."""
        return self.reliability_terms.combined

    @property
    def rebuilt_fraction(self) -> float:
        """Fraction of the posture joints and frames that were rebuilt."""
        return float(self.rebuilt[np.isfinite(self.reliability)].mean())


def reconstruct_motion(
    motion: Motion,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    source: JointRecording | None = None,
    tracking_state: NDArray[np.int8] | None = None,
    sensor: Sensor = Sensor.OTHER,
    resize: bool = False,
    humanoid_map: HumanoidMap | None = None,
    settings: ReconstructSettings = RECONSTRUCT_SETTINGS,
    progress: Progress = unwatched,
) -> RebuiltMotion:
    """Rebuild the poses of a skeleton that was solved from a tracker or captured otherwise.

    If its joints are those of a known tracker, all of them are rebuilt and followed
    (`motion_from_positions`). On any other skeleton the posture joints are rebuilt, and the
    shortest rotations move the skeleton to them (`fit_motion_to_postures`).

    Parameters
    ----------
    motion : Motion
        NaN where it was not observed.
    postures : PostureLibrary, optional
    prior : ResidualPrior, optional
    source : JointRecording, optional
        The recording that the motion was solved from; used if it still matches
        (`joints_from_source`).
    tracking_state : shape (n_frames, n_joints), optional
        State of each joint: 2 tracked, 1 inferred, 0 not tracked.
    sensor : Sensor
        The sensor that tracked the motion, where `source` is missing or does not match.
    resize : bool
        Whether bones may get other lengths, where the constant offset of the sensor was
        corrected.
    humanoid_map : HumanoidMap, optional
        Humanoid role of each joint; detected by default.
    settings : ReconstructSettings
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Nothing is tracked, no body is recognized, or it is not of human size.
    SolveCancelled
        Raised by `progress`.
    """
    tracked = _is_tracked(motion.skeleton.names)
    if tracked:
        recording, columns = _all_joints(motion, source, tracking_state, sensor)
    else:
        found = humanoid_map or find_humanoid_map(motion.skeleton)
        recording, columns = _postures_of(motion, found)
    check_tracked(recording)
    check_size(recording)
    rebuilt = reconstruct(
        recording, postures, prior, settings=settings, progress=within(progress, 0.0, 0.7)
    )
    if tracked:
        skeleton, combined = motion.skeleton, rebuilt.reliability.combined
        if resize and rebuilt.shift is not None:
            skeleton = resize_skeleton(skeleton, rebuilt.tracks, recording.parents, combined)
        result = rebuilt.motion_of(skeleton, within(progress, 0.7, 0.95))
    else:
        result = fit_motion_to_postures(motion, posture_positions(rebuilt.tracks), humanoid_map)
    result = keep_on_floor(motion, result, source)
    reliability_terms, confidence, changed = _for_skeleton_joints(
        motion.n_joints, recording, rebuilt, columns
    )
    progress(1.0, "Done")
    remarks = (*gap_remarks(recording), *shift_remarks(rebuilt))
    return RebuiltMotion(
        result, reliability_terms, confidence, changed, rebuilt.method, remarks
    )


def _for_skeleton_joints(
    n_joints: int, recording: JointRecording, rebuilt: Reconstruction, columns: dict[int, int]
) -> tuple[Reliability, Array, NDArray[np.bool_]]:
    """Return reliability, confidence and changed joints in the order of a skeleton."""
    joints, source_columns = list(columns), list(columns.values())
    shape = (recording.n_frames, n_joints)

    def to_skeleton(values: Array) -> Array:
        result = np.full(shape, np.nan)
        result[:, joints] = values[:, source_columns]
        return result

    found = rebuilt.reliability
    has_no_tracking = recording.tracking_state is None and recording.tracks.confidence is None
    reliability_terms = Reliability(
        to_skeleton(found.combined),
        to_skeleton(found.behavior),
        np.full(shape, np.nan)
        if _is_constant(found.kinematics)
        else to_skeleton(found.kinematics),
        np.full(shape, np.nan) if has_no_tracking else to_skeleton(found.tracking),
    )
    changed = np.zeros(shape, bool)
    changed[:, joints] = find_changed_joints(recording, rebuilt)[:, source_columns]
    return reliability_terms, to_skeleton(rebuilt.confidence), changed


def _is_constant(kinematics: Array) -> bool:
    """Return whether bone lengths are constant, as in any skeleton; 0 is missing."""
    return bool(((kinematics < LENGTH_TOLERANCE) | (kinematics > 1.0 - LENGTH_TOLERANCE)).all())


def postures_recording(motion: Motion) -> JointRecording:
    """Return the posture joints of a motion with the names of a tracker.

    Raises
    ------
    InvalidMotionError
        No body is recognized.
    """
    return _postures_of(motion, find_humanoid_map(motion.skeleton))[0]


def _is_tracked(names: tuple[str, ...]) -> bool:
    """Return whether all joints are those of a known tracker, with a known hierarchy."""
    return joint_parents(names).count(-1) == 1 and "hips" in posture_joint_indices(names)


def _all_joints(
    motion: Motion,
    source: JointRecording | None,
    state: NDArray[np.int8] | None,
    sensor: Sensor,
) -> tuple[JointRecording, dict[int, int]]:
    """Return the positions of all joints, and the column of each joint."""
    columns = {joint: joint for joint in range(motion.n_joints)}
    measured = None if source is None else joints_from_source(motion, source)
    if measured is not None:
        return measured, columns
    positions = forward_kinematics(motion).positions
    tracks = Tracks(motion.skeleton.names, positions, motion.frame_rate)
    return JointRecording(tracks, state, sensor), columns


def _postures_of(
    motion: Motion, humanoid_map: HumanoidMap
) -> tuple[JointRecording, dict[int, int]]:
    """Return the posture joints with the names of a tracker, and the column of each joint."""
    positions = postures_from_motion(motion, humanoid_map)
    observed = np.isfinite(positions).all(axis=-1).any(axis=0)
    posture_joints = np.flatnonzero(
        observed | ~observed.any()
    )  # if none is observed, keep all: the check then reports it
    names = tuple(KINECT_V1[POSTURE_JOINTS[joint]] for joint in posture_joints)
    tracks = Tracks(names, positions[:, posture_joints], motion.frame_rate)
    joint_indices = humanoid_map.indices(motion.skeleton)
    columns = {
        joint_indices[role]: column
        for column, joint in enumerate(posture_joints)
        if (role := POSTURE_JOINTS[joint]) in joint_indices
    }
    return JointRecording(tracks, None, Sensor.OTHER), columns
