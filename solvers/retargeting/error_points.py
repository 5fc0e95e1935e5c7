"""Points at which the error of a pose is measured: joints, and two points on each end."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import Skeleton
from ..motion.skeletons import WorldPoses
from ..rotations import rotate

MIN_POINT_DISTANCE_M = 0.05
"""Minimum distance from a joint without children to the points that show its rotation. Half and
twice are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class ErrorPoints:
    """Points attached to joints that show every error of every joint.

    Attributes
    ----------
    carriers : int array, shape (n_points,)
        The joint that carries each point.
    offsets : shape (n_points, 3), meters
        In the joint's frame.
    chains : tuple of int arrays
        Joints that move each point, from the root to the carrier.
    """

    carriers: NDArray[np.intp]
    offsets: Array
    chains: tuple[NDArray[np.intp], ...]

    def positions(self, poses: WorldPoses) -> Array:
        """Return the world positions of the points, shape (n_frames, n_points, 3), meters."""
        rotated = rotate(poses.rotations[:, self.carriers], self.offsets)
        return np.asarray(poses.positions[:, self.carriers] + rotated)


def find_error_points(skeleton: Skeleton) -> ErrorPoints:
    """Return all joints, and two more points for each that rotates but has no children.

    The rotation of a hand without fingers moves no joint. Two points, along and across the bone
    at the length of the parent bone, show it.
    """
    rows: list[tuple[int, Array]] = []
    for joint in range(skeleton.n_joints):
        rows.append((joint, np.zeros(3)))
        if skeleton.children[joint] or skeleton.is_end_site(joint):
            continue
        bone = skeleton.offsets[joint] if joint else np.zeros(3)
        length = max(float(np.linalg.norm(bone)), MIN_POINT_DISTANCE_M)
        along = bone / np.linalg.norm(bone) if bone.any() else np.array([0.0, 0.0, 1.0])
        across = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        rows += [(joint, length * along), (joint, length * across / np.linalg.norm(across))]
    carriers = np.array([joint for joint, _ in rows])
    chains = tuple(
        np.array([joint, *skeleton.ancestors(joint)][::-1], dtype=np.intp) for joint in carriers
    )
    return ErrorPoints(carriers, np.array([offset for _, offset in rows]), chains)
