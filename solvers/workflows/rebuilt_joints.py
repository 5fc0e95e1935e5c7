"""Which joints of a result are guesses rather than what was recorded."""

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording
from ..reconstruction.result import Reconstruction

CORRECTED = 0.05
"""Metres from where it was tracked, beyond which a joint is told as rebuilt."""
UNSURE = 0.5
"""Confidence of the result below which a joint is told as rebuilt."""


def rebuilt_joints(recording: JointRecording, result: Reconstruction) -> NDArray[np.bool_]:
    """Tell the joints that were lost, put elsewhere, or guessed, shape (n_frames, n_joints)."""
    moved = np.linalg.norm(result.tracks.positions - recording.tracks.positions, axis=-1)
    kept = moved <= CORRECTED  # False where it was not seen
    return np.asarray(~kept | (result.confidence < UNSURE))
