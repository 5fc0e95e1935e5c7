"""Rebuild the postures of a recording from those of clean clips."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import body_lengths, joints_of_names, normalise, posture_positions
from ...motion.skeletons import INFERRED
from ...progress import Progress, unwatched, within
from ..joint_rotations import (
    LimbTwists,
    Reconstruction,
    find_anchors,
    motion_from_positions,
    positions_from_postures,
)
from ..pose_library import PostureLibrary, load_posture_library
from ..reliability import Reliability, measure_reliability, posture_reliability
from .complete_postures import complete_postures
from .settings import DEFAULT_SETTINGS, PostureMethod, PostureSettings

Array = NDArray[np.float64]

MIN_JOINTS = 3
"""Joints of postures that must be seen together in some frame."""


class CompletedJoints(NamedTuple):
    """Joints, and what is known of them: see `Reconstruction`."""

    tracks: Tracks
    confidence: Array
    method: str
    twists: LimbTwists | None


def reconstruct_postures(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    *,
    settings: PostureSettings = DEFAULT_SETTINGS,
    reliability: Reliability | None = None,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Rebuild what a depth camera lost, with postures of clean clips [1]_.

    For each frame the postures of the library that are like what was seen, joint by joint as
    trusted, span a space of principal components (local PCA), in which the posture is chosen.
    Joints that were trusted then stay where they were seen; how the others differ from what
    was chosen leads over from before to after their loss. The library is brought to the actor's
    bone lengths and to the tracker's idea of a body, so that joints need not be.

    Parameters
    ----------
    recording : JointRecording
        15 to 32 joints, among them the hips.
    postures : PostureLibrary, optional
        The one that is shipped by default.
    settings : PostureSettings
    reliability : Reliability, optional
        That of `measure_reliability` by default.
    progress : Progress

    Returns
    -------
    Reconstruction
        Every joint in every frame; those that are never seen where the library has them, with
        the usual share of the body's size. Bones of lost joints have the actor's lengths as
        nearly as trusted joints allow; those of the motion have them exactly.

    Raises
    ------
    InvalidMotionError
        No body is recognised in the names, or hardly a joint was ever seen.
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
        recording, postures, reliability.combined, settings, within(progress, 0.1, 0.9)
    )
    motion = motion_from_positions(
        rebuilt.tracks, recording.parents, reliability.combined, twists=rebuilt.twists
    )
    progress(1.0, "Reconstructed")
    return Reconstruction(
        rebuilt.tracks, motion, reliability, rebuilt.confidence, rebuilt.method, rebuilt.twists
    )


def complete_joints(
    recording: JointRecording,
    postures: PostureLibrary | None,
    combined: Array,
    settings: PostureSettings,
    progress: Progress,
) -> CompletedJoints:
    """Rebuild what a depth camera lost: `reconstruct_postures` without a motion.

    `combined` is the reliability of the joints, shape (n_frames, n_joints).
    """
    library = load_posture_library() if postures is None else postures
    positions = posture_positions(recording)
    seen = np.isfinite(positions).all(axis=-1)
    trust = np.where(seen, posture_reliability(recording, combined), 0.0)
    _check_observed(recording, positions, trust)
    rate = recording.frame_rate
    body = normalise(positions, rate, trust, ahead=not settings.causal)
    lengths = body_lengths(body.postures, trust)
    found = complete_postures(body, trust, rate, lengths, library, settings, progress)
    tracks = recording.tracks
    after = body.put_back(found.postures)
    joints = positions_from_postures(tracks.names, tracks.positions, combined, positions, after)
    confidence = found.confidence[:, find_anchors(tracks.names)]
    words = _describe_method(settings, library)
    return CompletedJoints(tracks.with_positions(joints), confidence, words, found.twists)


def _check_observed(recording: JointRecording, positions: Array, trust: Array) -> None:
    """Raise InvalidMotionError where no frame has joints enough, and say why."""
    if _max_joints(trust > 0.0) >= MIN_JOINTS:
        return
    known = joints_of_names(recording.names)
    if len(known) < MIN_JOINTS:
        raise InvalidMotionError(
            f"Only {len(known)} joints have recognized names ({', '.join(known)}). Use a"
            f" recording with at least {MIN_JOINTS}, including the hips and limbs."
        )
    state = recording.tracking_state
    if state is None or _max_joints(np.isfinite(positions)[..., 0]) < MIN_JOINTS:
        raise InvalidMotionError(
            f"No frame shows {MIN_JOINTS} joints of a body. Choose a recording of a tracked"
            " actor."
        )
    if (state == INFERRED).any():
        raise InvalidMotionError(
            f"No frame has {MIN_JOINTS} tracked joints; the tracker infers the others. Raise"
            " the setting `inferred` to use inferred joints."
        )
    raise InvalidMotionError(
        f"No frame has {MIN_JOINTS} joints with the tracking state `tracked`, although"
        " positions exist. If the positions are right, remove the tracking states from the recording."
    )


def _max_joints(seen: NDArray[np.bool_]) -> int:
    """Return how many joints are seen in the frame that has most, of (n_frames, n_joints)."""
    return int(seen.sum(axis=1).max(initial=0))


def _describe_method(settings: PostureSettings, library: PostureLibrary) -> str:
    ways = {
        PostureMethod.PROBABLE: "most probable postures",
        PostureMethod.PUBLISHED: "postures by stochastic search",
    }
    when = ", causal" if settings.causal else ""
    of = f" ({library.trained_on})" if library.trained_on else ""
    return (
        f"{ways[settings.method]} among {settings.n_neighbours} neighbours of"
        f" {library.n_postures}{of}{when}"
    )
