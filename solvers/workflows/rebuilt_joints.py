"""Which joints of a result are elsewhere than they were recorded."""

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording
from ..reconstruction import Reconstruction

CORRECTED = 0.05
"""Metres from where it was tracked, beyond which a joint is told as rebuilt."""


def rebuilt_joints(recording: JointRecording, result: Reconstruction) -> NDArray[np.bool_]:
    """Tell the joints that were lost, or are put elsewhere, shape (n_frames, n_joints)."""
    moved = np.linalg.norm(result.tracks.positions - recording.tracks.positions, axis=-1)
    return np.asarray(~(moved <= CORRECTED))  # lost ones are nowhere
