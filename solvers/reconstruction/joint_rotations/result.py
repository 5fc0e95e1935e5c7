"""What every way of reconstruction returns."""

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
        All joints of the recording under their names; every one in every frame.
    motion : Motion
        A skeleton of these joints with constant bone lengths that follows them.
    reliability : Reliability
        How far each joint of the recording was trusted, and why.
    confidence : shape (n_frames, n_joints), 0 to 1
        How sure each joint of the result is.
    method : str
        What was done, in words: methods used, neighbours, training.
    twists : LimbTwists, optional
        How like postures have upper arms and thighs twisted, where a library was asked.
    """

    tracks: Tracks
    motion: Motion
    reliability: Reliability
    confidence: NDArray[np.float64]
    method: str = ""
    twists: LimbTwists | None = None
