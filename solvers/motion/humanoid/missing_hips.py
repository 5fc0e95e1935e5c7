"""Hips that a tracker never saw, from the legs that hang on them."""

from dataclasses import replace

from ..skeletons import JointRecording
from .posture_joints import posture_joint_indices

UPPER_LEG_ROLES = ("leftUpperLeg", "rightUpperLeg")


def fill_missing_hips(recording: JointRecording) -> JointRecording:
    """Return the recording with hips that no frame shows between the legs.

    Their tracking state is that of the less sure leg. A recording without hips or legs among
    its joints is returned as it is, as is one whose hips were ever seen.
    """
    tracks, state = recording.tracks, recording.tracking_state
    places = posture_joint_indices(tracks.names)
    legs = [places[role] for role in UPPER_LEG_ROLES if role in places]
    hips = places.get("hips")
    if hips is None or tracks.visible[:, hips].any() or len(legs) < len(UPPER_LEG_ROLES):
        return recording
    positions = tracks.positions.copy()
    positions[:, hips] = positions[:, legs].mean(axis=1)
    if state is not None:
        state = state.copy()
        state[:, hips] = state[:, legs].min(axis=1)
    return replace(recording, tracks=tracks.with_positions(positions), tracking_state=state)
