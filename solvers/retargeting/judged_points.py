"""The points by which a pose is judged: all joints, and what shows how hands and feet turn."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton
from ..motion.skeletons import WorldPoses
from ..rotations import rotate

Array = NDArray[np.float64]

SHORTEST = 0.05
"""Metres from a joint without children to the points that show how it turns, at least."""


@dataclass(frozen=True, eq=False)
class ErrorPoints:
    """Points fixed to joints, which together show every error of every joint.

    Attributes
    ----------
    carriers : int array, shape (n_points,)
        The joint that carries each point.
    offsets : shape (n_points, 3), metres
        In the joint's own frame.
    chains : tuple of int arrays
        Joints that move each point, from the topmost to the carrier.
    """

    carriers: NDArray[np.intp]
    offsets: Array
    chains: tuple[NDArray[np.intp], ...]

    def positions(self, poses: WorldPoses) -> Array:
        """Return where the points are in the world, shape (n_frames, n_points, 3), metres."""
        turned = rotate(poses.rotations[:, self.carriers], self.offsets)
        return np.asarray(poses.positions[:, self.carriers] + turned)


def find_error_points(skeleton: Skeleton) -> ErrorPoints:
    """Return all joints, and two points more for each that turns but has no children.

    A hand without fingers turns without moving any joint. Two points, ahead of it and aside by
    the length of the bone above, show its turns.
    """
    rows: list[tuple[int, Array]] = []
    for joint in range(skeleton.n_joints):
        rows.append((joint, np.zeros(3)))
        if skeleton.children[joint] or skeleton.is_end_site(joint):
            continue
        bone = skeleton.offsets[joint] if joint else np.zeros(3)
        length = max(float(np.linalg.norm(bone)), SHORTEST)
        ahead = bone / np.linalg.norm(bone) if bone.any() else np.array([0.0, 0.0, 1.0])
        aside = np.cross(ahead, np.eye(3)[np.abs(ahead).argmin()])
        rows += [(joint, length * ahead), (joint, length * aside / np.linalg.norm(aside))]
    carriers = np.array([joint for joint, _ in rows])
    chains = tuple(
        np.array([joint, *skeleton.ancestors(joint)][::-1], dtype=np.intp) for joint in carriers
    )
    return ErrorPoints(carriers, np.array([offset for _, offset in rows]), chains)
