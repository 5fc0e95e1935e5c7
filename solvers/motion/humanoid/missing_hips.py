"""Fill in hips that a tracker does not report."""

from dataclasses import replace

from ..skeletons import JointRecording
from .posture_joints import posture_joint_indices

UPPER_LEG_ROLES = ("leftUpperLeg", "rightUpperLeg")


def fill_missing_hips(recording: JointRecording) -> JointRecording:
    """Return the recording with missing hips placed between the upper legs.

    Their tracking state is the lower one of both legs. A recording without a joint for the hips
    or the legs, or with hips observed in any frame, is returned unchanged.
    """
    tracks, state = recording.tracks, recording.tracking_state
    indices = posture_joint_indices(tracks.names)
    legs = [indices[role] for role in UPPER_LEG_ROLES if role in indices]
    hips = indices.get("hips")
    if hips is None or tracks.visible[:, hips].any() or len(legs) < len(UPPER_LEG_ROLES):
        return recording
    positions = tracks.positions.copy()
    positions[:, hips] = positions[:, legs].mean(axis=1)
    if state is not None:
        state = state.copy()
        state[:, hips] = state[:, legs].min(axis=1)
    return replace(recording, tracks=tracks.with_positions(positions), tracking_state=state)
