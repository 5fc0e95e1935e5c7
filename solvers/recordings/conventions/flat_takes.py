"""Question takes without any depth, and refuse those whose joints are all at one point."""

from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
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


def refuse_single_point(path: Path | str, recording: Motion | Tracks | JointRecording) -> None:
    """Raise InvalidFileError if several joints are at one point wherever they are observed."""
    points = _points(recording)
    points = points[np.isfinite(points).all(axis=2).sum(axis=1) > 1]
    if len(points) and np.nanmax(np.nanmax(points, axis=1) - np.nanmin(points, axis=1)) == 0.0:
        raise InvalidFileError(
            f"{path} has all joints at one point. Export the positions of joints, or a skeleton"
            " with bone lengths."
        )


def _points(recording: Motion | Tracks | JointRecording) -> Array:
    step = max(1, recording.n_frames // N_SAMPLED_FRAMES)
    if isinstance(recording, Motion):
        return world_poses(
            recording.skeleton, recording.rotations[::step], recording.root_positions[::step]
        ).positions
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.positions[::step]
