"""Rebuild the poses of a skeleton that moves as a depth camera's tracker saw it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
from ..motion.posture_joints import (
    POSTURE_JOINTS,
    joints_of_names,
    motion_postures,
    posture_positions,
)
from ..progress import Progress, unwatched, within
from ..reconstruction import PostureLibrary, ReconstructSettings, ResidualPrior, reconstruct
from ..reconstruction.follow_joints import follow_joints
from ..reconstruction.turn_to_postures import turn_to_postures
from .known_body import KINECT_V1, check_size, check_tracked, gap_remarks
from .measured_joints import measured_joints
from .rebuilt_joints import rebuilt_joints

Array = NDArray[np.float64]
REBUILDING = ReconstructSettings()


@dataclass(frozen=True, eq=False)
class RebuiltMotion:
    """Clean motion of a skeleton.

    Attributes
    ----------
    motion : Motion
        Of the skeleton that was given; without gaps.
    reliability, confidence : shape (n_frames, n_joints), 0 to 1
        How far each joint was trusted, and how sure its result is; NaN for joints that are
        not among those by which bodies are compared.
    rebuilt : bool, shape (n_frames, n_joints)
        Which of these joints were lost, or are put elsewhere than they were recorded.
    method : str
        What was done, in words.
    remarks : tuple of str
        Sentences on what the animator should know.
    """

    motion: Motion
    reliability: Array
    confidence: Array
    rebuilt: NDArray[np.bool_]
    method: str
    remarks: tuple[str, ...]

    @property
    def rebuilt_share(self) -> float:
        """Share of the joints and frames that were rebuilt, of those that are compared."""
        return float(self.rebuilt[np.isfinite(self.reliability)].mean())


def reconstruct_motion(
    motion: Motion,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    source: JointRecording | None = None,
    tracking_state: NDArray[np.int8] | None = None,
    humanoid_map: HumanoidMap | None = None,
    settings: ReconstructSettings = REBUILDING,
    progress: Progress = unwatched,
) -> RebuiltMotion:
    """Rebuild the poses of a motion that a tracker's joints, or any capture, gave a skeleton.

    Where its joints are those of a known tracker, all of them are rebuilt and followed
    (`follow_joints`). On any other skeleton those of a body are, and its motion is turned the
    short way to where they come to be (`turn_to_postures`).

    Parameters
    ----------
    motion : Motion
        NaN where it was not observed.
    postures : PostureLibrary, optional
    prior : ResidualPrior, optional
    source : JointRecording, optional
        What the motion was made of, if it is at hand; used where it still fits
        (`measured_joints`).
    tracking_state : shape (n_frames, n_joints), optional
        What the tracker said of each joint: 2 tracked, 1 inferred, 0 not tracked.
    humanoid_map : HumanoidMap, optional
        Which joint plays which part of a body; found where it is not given.
    settings : ReconstructSettings
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Nothing is tracked, no body is recognised, or it is not of human size.
    SolveCancelled
        Raised by `progress`.
    """
    tracked = _is_tracked(motion.skeleton.names)
    if tracked:
        recording, columns = _all_joints(motion, source, tracking_state)
    else:
        found = humanoid_map or find_humanoid_map(motion.skeleton)
        recording, columns = _postures_of(motion, found)
    check_tracked(recording)
    check_size(recording)
    rebuilt = reconstruct(
        recording, postures, prior, settings=settings, progress=within(progress, 0.0, 0.9)
    )
    if tracked:
        turned = follow_joints(
            rebuilt.tracks,
            recording.parents,
            rebuilt.reliability.combined,
            skeleton=motion.skeleton,
        )
    else:
        turned = turn_to_postures(motion, posture_positions(rebuilt.tracks), humanoid_map)
    shape = (motion.n_frames, motion.n_joints)
    reliability, confidence = np.full(shape, np.nan), np.full(shape, np.nan)
    told, guessed = np.zeros(shape, bool), rebuilt_joints(recording, rebuilt)
    for joint, column in columns.items():
        reliability[:, joint] = rebuilt.reliability.combined[:, column]
        confidence[:, joint] = rebuilt.confidence[:, column]
        told[:, joint] = guessed[:, column]
    progress(1.0, "Done")
    remarks = tuple(gap_remarks(recording))
    return RebuiltMotion(turned, reliability, confidence, told, rebuilt.method, remarks)


def postures_recording(motion: Motion) -> JointRecording:
    """Return the joints of postures of a skeleton's motion, as a tracker would name them.

    Raises
    ------
    InvalidMotionError
        No body is recognised.
    """
    return _postures_of(motion, find_humanoid_map(motion.skeleton))[0]


def _is_tracked(names: tuple[str, ...]) -> bool:
    """Whether all joints are a known tracker's, and so hang together as is known."""
    return joint_parents(names).count(-1) == 1 and "hips" in joints_of_names(names)


def _all_joints(
    motion: Motion, source: JointRecording | None, state: NDArray[np.int8] | None
) -> tuple[JointRecording, dict[int, int]]:
    """Return where all joints are, and the column of each joint."""
    columns = {joint: joint for joint in range(motion.n_joints)}
    measured = None if source is None else measured_joints(motion, source)
    if measured is not None:
        return measured, columns
    positions = forward_kinematics(motion).positions
    tracks = Tracks(motion.skeleton.names, positions, motion.frame_rate)
    return JointRecording(tracks, state, Sensor.OTHER), columns


def _postures_of(
    motion: Motion, humanoid_map: HumanoidMap
) -> tuple[JointRecording, dict[int, int]]:
    """Return where the joints of postures are, under the names of a tracker."""
    positions = motion_postures(motion, humanoid_map)
    there = np.flatnonzero(np.isfinite(positions).all(axis=-1).any(axis=0))
    names = tuple(KINECT_V1[POSTURE_JOINTS[joint]] for joint in there)
    tracks = Tracks(names, positions[:, there], motion.frame_rate)
    places = humanoid_map.indices(motion.skeleton)
    columns = {
        places[role]: column
        for column, joint in enumerate(there)
        if (role := POSTURE_JOINTS[joint]) in places
    }
    return JointRecording(tracks, None, Sensor.OTHER), columns
