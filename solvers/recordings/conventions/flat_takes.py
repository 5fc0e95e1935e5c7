"""Question takes without any depth, which programs of 2D poses write."""

import numpy as np

from ...arrays import Array
from ...motion import JointRecording, Motion, Tracks, world_poses
from .axes import MIN_BODY_JOINTS
from .body_unit import stature

N_SAMPLED_FRAMES = 100
"""Number of frames, evenly spaced, that are evaluated. It bounds the run time."""
MAX_DEPTH_FRACTION = 1e-3
"""Thickness of a take in one plane, relative to the stature. It guards rounding of numbers:
joints of people who stand in a T-pose differ by 2 % and more."""


def question_of_depth(recording: Motion | Tracks | JointRecording) -> str:
    """Ask about a take whose joints are all in one plane; nothing otherwise."""
    tall = None if isinstance(recording, Tracks) else stature(recording)
    if tall is None:
        return ""
    points = _points(recording)
    points = points[np.isfinite(points).all(axis=2)]
    if len(points) < MIN_BODY_JOINTS:
        return ""
    thickness = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[-1]
    if thickness / np.sqrt(len(points)) > MAX_DEPTH_FRACTION * tall:
        return ""
    return (
        "All joints are in one plane, as poses of images are; use the 3D output of the tracker"
    )


def _points(recording: Motion | Tracks | JointRecording) -> Array:
    step = max(1, recording.n_frames // N_SAMPLED_FRAMES)
    if isinstance(recording, Motion):
        return world_poses(
            recording.skeleton, recording.rotations[::step], recording.root_positions[::step]
        ).positions
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.positions[::step]
