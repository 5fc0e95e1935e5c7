"""Make pose frames of segments with positions and rotations in the world."""

from collections.abc import Sequence

import numpy as np

from ....arrays import Array
from ....motion import Skeleton
from ....rotations import inverse, multiply, rotate
from ..frames import PoseFrame
from .humanoid import standing

MAX_CHANGE_M = 0.02
"""Change of a bone in meters from which the body is another one. It guards against rounding and
against joints that slide a little, as those of suits do."""


class SegmentPoses:
    """Makes frames whose skeleton stays the same as long as the bones do."""

    def __init__(self) -> None:
        self._skeleton: Skeleton | None = None

    def frame(
        self,
        time: float,
        body: int,
        names: Sequence[str],
        parents: Sequence[int],
        positions: Array,
        rotations: Array,
    ) -> PoseFrame:
        """Return a frame of segments that are parallel to the world in their rest pose.

        Parameters
        ----------
        time : float, seconds
        body : int
        names, parents : of the segments, parents first
        positions : shape (n_segments, 3), meters
            Of their joints.
        rotations : shape (n_segments, 4)
            In the world, w x y z.
        """
        above = np.maximum(parents, 0)
        from_world = inverse(rotations[above])
        offsets = rotate(from_world, positions - positions[above])
        local = multiply(from_world, rotations)
        local[0] = rotations[0]
        skeleton = self._skeleton_of(tuple(names), parents, offsets)
        return PoseFrame(time, body, skeleton, local, positions[0])

    def _skeleton_of(
        self, names: tuple[str, ...], parents: Sequence[int], offsets: Array
    ) -> Skeleton:
        last = self._skeleton
        if (
            last is None
            or last.names != names
            or np.abs(last.offsets[1:] - offsets[1:]).max(initial=0.0) > MAX_CHANGE_M
        ):
            self._skeleton = last = standing(names, parents, offsets)
        return last
