"""Hips that a tracker never saw, from the legs that hang on them."""

from dataclasses import replace

from ..skeletons import JointRecording
from .posture_joints import joints_of_names

LEGS = ("leftUpperLeg", "rightUpperLeg")


def with_hips(recording: JointRecording) -> JointRecording:
    """Return the recording with hips that no frame shows between the legs.

    Their tracking state is that of the less sure leg. A recording without hips or legs among
    its joints is returned as it is, as is one whose hips were ever seen.
    """
    tracks, state = recording.tracks, recording.tracking_state
    places = joints_of_names(tracks.names)
    legs = [places[role] for role in LEGS if role in places]
    hips = places.get("hips")
    if hips is None or tracks.visible[:, hips].any() or len(legs) < len(LEGS):
        return recording
    positions = tracks.positions.copy()
    positions[:, hips] = positions[:, legs].mean(axis=1)
    if state is not None:
        state = state.copy()
        state[:, hips] = state[:, legs].min(axis=1)
    return replace(recording, tracks=tracks.with_positions(positions), tracking_state=state)
