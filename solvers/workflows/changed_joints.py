"""Find the joints that a reconstruction filled or moved, and describe the offset of all."""

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording
from ..reconstruction import Reconstruction

MIN_CHANGE_M = 0.05
"""Minimum distance in meters from the tracked position for a joint to count as rebuilt. Chosen
by hand: 5 cm; no metric or test shows where it matters."""


def find_changed_joints(recording: JointRecording, result: Reconstruction) -> NDArray[np.bool_]:
    """Return which joints were missing or moved, shape (n_frames, n_joints).

    The constant offset of the sensor moves all joints and does not count.
    """
    moved = result.tracks.positions - recording.tracks.positions
    if result.shift is not None:
        moved = moved - result.shift
    return np.asarray(~(np.linalg.norm(moved, axis=-1) <= MIN_CHANGE_M))  # missing: NaN


def shift_remarks(result: Reconstruction) -> list[str]:
    """Report the size of the sensor's constant offset, if it was corrected."""
    if result.shift is None:
        return []
    distance_cm = 100.0 * float(np.linalg.norm(result.shift, axis=-1).mean())
    return [
        f"Joints moved by {distance_cm:.1f} cm on average, the constant offset of this kind of"
        " sensor; Reconstruct without Sensor Offset keeps them."
    ]
