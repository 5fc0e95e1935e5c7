"""Result class of all reconstruction methods."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion, Skeleton, Tracks, joint_parents
from ...progress import Progress, unwatched
from ..reliability import Reliability
from .motion_from_positions import motion_from_positions
from .trunk_twist import LimbTwists


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Clean poses of a recording.

    Attributes
    ----------
    tracks : Tracks
        All joints of the recording under their names, without missing frames.
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
    reliability: Reliability
    confidence: NDArray[np.float64]
    method: str = ""
    twists: LimbTwists | None = None
    shift: NDArray[np.float64] | None = None

    @cached_property
    def motion(self) -> Motion:
        """Motion of a skeleton with constant bone lengths, fitted to these joints."""
        return self.motion_of(None)

    def motion_of(self, skeleton: Skeleton | None, progress: Progress = unwatched) -> Motion:
        """Return the motion of a given skeleton, fitted to these joints.

        The skeleton and the errors are those of `motion_from_positions`.
        """
        return motion_from_positions(
            self.tracks,
            joint_parents(self.tracks.names),
            self.reliability.combined,
            skeleton=skeleton,
            twists=self.twists,
            progress=progress,
        )
