"""Find the joints that a reconstruction filled or moved."""

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording
from ..reconstruction import Reconstruction

MIN_CHANGE_M = 0.05
"""Minimum distance in meters from the tracked position for a joint to count as rebuilt."""


def find_changed_joints(recording: JointRecording, result: Reconstruction) -> NDArray[np.bool_]:
    """Return which joints were missing or moved, shape (n_frames, n_joints)."""
    moved = np.linalg.norm(result.tracks.positions - recording.tracks.positions, axis=-1)
    return np.asarray(~(moved <= MIN_CHANGE_M))  # missing joints are NaN
