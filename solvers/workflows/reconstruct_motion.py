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
from ..motion.humanoid import (
    POSTURE_JOINTS,
    joints_of_names,
    motion_postures,
    posture_positions,
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
from ..reconstruction.joint_rotations import follow_joints, turn_to_postures
from .joints_from_source import joints_from_source
from .rebuilt_joints import rebuilt_joints
from .standard_joints import KINECT_V1, check_size, check_tracked, gap_remarks

Array = NDArray[np.float64]
REBUILDING = ReconstructSettings()
SAME = 1e-6
"""Share of a length that is no change."""


@dataclass(frozen=True, eq=False)
class RebuiltMotion:
    """Clean motion of a skeleton.

    Attributes
    ----------
    motion : Motion
        Of the skeleton that was given; without gaps.
    reliability_terms : Reliability
        How far each joint was trusted, and why; NaN for joints that are not among those by
        which bodies are compared, and all NaN for a term of which the take tells nothing.
    confidence : shape (n_frames, n_joints), 0 to 1
        How sure the result is of each joint; NaN likewise.
    rebuilt : bool, shape (n_frames, n_joints)
        Which of these joints were lost, or are put elsewhere than they were recorded.
    method : str
        What was done, in words.
    remarks : tuple of str
        Sentences on what the animator should know.
    """

    motion: Motion
    reliability_terms: Reliability
    confidence: Array
    rebuilt: NDArray[np.bool_]
    method: str
    remarks: tuple[str, ...]

    @property
    def reliability(self) -> Array:
        """How far each joint was trusted, shape (n_frames, n_joints), 0 to 1."""
        return self.reliability_terms.combined

    @property
    def rebuilt_fraction(self) -> float:
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
        (`joints_from_source`).
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
            twists=rebuilt.twists,
            skeleton=motion.skeleton,
        )
    else:
        turned = turn_to_postures(motion, posture_positions(rebuilt.tracks), humanoid_map)
    trust, confidence, told = _of_skeleton(motion.n_joints, recording, rebuilt, columns)
    progress(1.0, "Done")
    remarks = tuple(gap_remarks(recording))
    return RebuiltMotion(turned, trust, confidence, told, rebuilt.method, remarks)


def _of_skeleton(
    n_joints: int, recording: JointRecording, rebuilt: Reconstruction, columns: dict[int, int]
) -> tuple[Reliability, Array, NDArray[np.bool_]]:
    """Return trust, confidence and what was rebuilt, of the joints of a skeleton."""
    joints, places = list(columns), list(columns.values())
    shape = (recording.n_frames, n_joints)

    def spread(values: Array) -> Array:
        result = np.full(shape, np.nan)
        result[:, joints] = values[:, places]
        return result

    found = rebuilt.reliability
    says_nothing = recording.tracking_state is None and recording.tracks.confidence is None
    trust = Reliability(
        spread(found.combined),
        spread(found.behaviour),
        np.full(shape, np.nan) if _never_vary(found.kinematics) else spread(found.kinematics),
        np.full(shape, np.nan) if says_nothing else spread(found.tracking),
    )
    told = np.zeros(shape, bool)
    told[:, joints] = rebuilt_joints(recording, rebuilt)[:, places]
    return trust, spread(rebuilt.confidence), told


def _never_vary(kinematics: Array) -> bool:
    """Whether lengths are the same in all frames, as those of any skeleton; 0 is not seen."""
    return bool(((kinematics < SAME) | (kinematics > 1.0 - SAME)).all())


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
    measured = None if source is None else joints_from_source(motion, source)
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
    seen = np.isfinite(positions).all(axis=-1).any(axis=0)
    there = np.flatnonzero(seen | ~seen.any())  # all, to be refused, where none is seen
    names = tuple(KINECT_V1[POSTURE_JOINTS[joint]] for joint in there)
    tracks = Tracks(names, positions[:, there], motion.frame_rate)
    places = humanoid_map.indices(motion.skeleton)
    columns = {
        places[role]: column
        for column, joint in enumerate(there)
        if (role := POSTURE_JOINTS[joint]) in places
    }
    return JointRecording(tracks, None, Sensor.OTHER), columns
