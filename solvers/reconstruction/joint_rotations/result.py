"""Result class of all reconstruction methods."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion, Tracks
from ..reliability import Reliability
from .trunk_twist import LimbTwists


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Clean poses of a recording.

    Attributes
    ----------
    tracks : Tracks
        All joints of the recording under their names, without missing frames.
    motion : Motion
        Motion of a skeleton with constant bone lengths, fitted to these joints.
    reliability : Reliability
        Reliability of each joint of the recording, and its terms.
    confidence : shape (n_frames, n_joints), 0 to 1
        Confidence of each joint of the result.
    method : str
        Description of the methods, neighbors and training data.
    twists : LimbTwists, optional
        Axial rotations of upper arms and thighs from a library, if one was used.
    shift : shape (n_frames, n_joints, 3), meters, optional
        Constant offset of the sensor that was corrected: how far it moved each joint. None if
        none was.
    """

    tracks: Tracks
    motion: Motion
    reliability: Reliability
    confidence: NDArray[np.float64]
    method: str = ""
    twists: LimbTwists | None = None
    shift: NDArray[np.float64] | None = None
