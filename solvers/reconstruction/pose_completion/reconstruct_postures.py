"""Reconstruct the poses of a recording from a library of clean poses."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import (
    estimate_bone_lengths,
    normalize_postures,
    posture_joint_indices,
    posture_positions,
)
from ...motion.skeletons import INFERRED
from ...progress import Progress, unwatched, within
from ...rotations import RIGID_POINTS
from ..joint_rotations import (
    JointOffsets,
    LimbTwists,
    Reconstruction,
    find_anchors,
    measure_joint_offsets,
    positions_from_postures,
)
from ..pose_library import PostureLibrary, load_posture_library
from ..reliability import Reliability, measure_reliability, posture_reliability
from .complete_postures import Completer, FittedLibrary, ObservedTake, complete_postures
from .settings import DEFAULT_SETTINGS, PostureSettings


class CompletedJoints(NamedTuple):
    """Completed joints and their confidence; see `Reconstruction`."""

    tracks: Tracks
    confidence: Array
    deviation: Array
    """Expected error on each axis, shape (n_frames, n_joints), meters."""
    method: str
    twists: LimbTwists | None
    lengths: Array
    """The actor's bone lengths, shape (20,), meters."""
    library: FittedLibrary | None
    joint_offsets: JointOffsets


def reconstruct_postures(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    *,
    settings: PostureSettings = DEFAULT_SETTINGS,
    reliability: Reliability | None = None,
    complete: Completer = complete_postures,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Reconstruct unreliable and missing joints from a library of clean poses [1]_.

    For each frame, the library poses nearest to the reliable joints span a space of principal
    components (local PCA), from which the pose is chosen. Reliable joints keep their observed
    positions. The residual between observed and chosen positions is interpolated across gaps.
    The library is first fitted to the actor's bone lengths and to the tracker's definition of
    joints.

    Parameters
    ----------
    recording : JointRecording
        15 to 32 joints, among them the hips.
    postures : PostureLibrary, optional
        The shipped library by default.
    settings : PostureSettings
    reliability : Reliability, optional
        Computed by `measure_reliability` by default.
    complete : callable
        Completes the poses; by default with the most probable ones.
    progress : Progress

    Returns
    -------
    Reconstruction
        Every joint in every frame; joints that are never observed follow the library at
        typical body proportions. Bones of missing joints have the actor's lengths as far as
        reliable joints allow; bones of the motion have them exactly.

    Raises
    ------
    InvalidMotionError
        The joint names do not describe a body, or almost no joint was observed.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Shum, Ho, Jiang, Takagi (2013). Real-time posture reconstruction for Microsoft
       Kinect. IEEE Transactions on Cybernetics 43(5), sections V and VI.
    """
    if reliability is None:
        reliability = measure_reliability(recording, progress=within(progress, 0.0, 0.1))
    rebuilt = complete_joints(
        recording,
        postures,
        reliability.combined,
        settings,
        within(progress, 0.1, 0.9),
        complete,
    )
    progress(1.0, "Reconstructed")
    return Reconstruction(
        rebuilt.tracks, reliability, rebuilt.confidence, rebuilt.method, rebuilt.twists
    )


def complete_joints(
    recording: JointRecording,
    postures: PostureLibrary | None,
    combined: Array,
    settings: PostureSettings,
    progress: Progress,
    complete: Completer = complete_postures,
) -> CompletedJoints:
    """Complete unreliable and missing joints.

    `combined` is the reliability of the joints, shape (n_frames, n_joints).
    """
    library = load_posture_library() if postures is None else postures
    positions = posture_positions(recording)
    observed = np.isfinite(positions).all(axis=-1)
    reliability = np.where(observed, posture_reliability(recording, combined), 0.0)
    _check_observed(recording, positions, reliability)
    rate = recording.frame_rate
    body = normalize_postures(positions, rate, reliability, causal=settings.causal)
    lengths = estimate_bone_lengths(body.postures, reliability)
    take = ObservedTake(body.postures, reliability, rate, lengths)
    completed = complete(take, library, settings, progress)
    tracks = recording.tracks
    world_positions = body.to_world(completed.postures)
    observations = (tracks.names, tracks.positions, combined, positions, world_positions)
    joint_offsets = measure_joint_offsets(*observations)
    joints = positions_from_postures(*observations, joint_offsets)
    anchors = find_anchors(tracks.names)
    description = _describe_method(completed.method, settings, library)
    return CompletedJoints(
        tracks.with_positions(joints), completed.confidence[:, anchors],
        completed.deviation[:, anchors], description, completed.twists,
        lengths, completed.library, joint_offsets,
    )  # fmt: skip


def _check_observed(recording: JointRecording, positions: Array, reliability: Array) -> None:
    """Raise InvalidMotionError with the reason if no frame has enough reliable joints."""
    if _max_joints(reliability > 0.0) >= RIGID_POINTS:
        return
    recognized = posture_joint_indices(recording.names)
    if len(recognized) < RIGID_POINTS:
        raise InvalidMotionError(
            f"Only {len(recognized)} joints have recognized names"
            f" ({', '.join(recognized)}). Use a recording with at least {RIGID_POINTS},"
            " including the hips and limbs."
        )
    state = recording.tracking_state
    if state is None or _max_joints(np.isfinite(positions)[..., 0]) < RIGID_POINTS:
        raise InvalidMotionError(
            f"No frame shows {RIGID_POINTS} joints of a body. Choose a recording of a tracked"
            " actor."
        )
    if (state == INFERRED).any():
        raise InvalidMotionError(
            f"No frame has {RIGID_POINTS} tracked joints; the tracker infers the others. Raise"
            " Inferred Weight (--inferred) to use those."
        )
    raise InvalidMotionError(
        f"No frame has {RIGID_POINTS} joints with the tracking state `tracked`, although"
        " positions exist. If the positions are right, remove the tracking states from the"
        " recording."
    )


def _max_joints(observed: NDArray[np.bool_]) -> int:
    """Return the largest number of observed joints of a frame, from (n_frames, n_joints)."""
    return int(observed.sum(axis=1).max(initial=0))


def _describe_method(method: str, settings: PostureSettings, library: PostureLibrary) -> str:
    causality = ", causal" if settings.causal else ""
    source = f" ({library.trained_on})" if library.trained_on else ""
    return (
        f"{method} among {settings.n_neighbors} neighbors of"
        f" {library.n_postures}{source}{causality}"
    )
