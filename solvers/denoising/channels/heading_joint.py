"""Find the joint that turns with the body, and express it in the world."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import HumanoidMap, Motion
from ...motion.skeletons import still_joints
from ...rotations import inverse, multiply, rotate
from ...signals import fill_rotation_gaps


class HeadingJoint(NamedTuple):
    """The hips, and the joints above them.

    Many rigs have a bone above the hips that stands still or carries the travel. The rotation
    and position of the hips in the world do not depend on it.
    """

    joint: int
    above: tuple[int, ...]
    """Joints from the root down to the parent."""


def find_heading_joint(motion: Motion, humanoid: HumanoidMap) -> HeadingJoint:
    """Return the hips, or else the first joint that rotates, or else the root."""
    joint = humanoid.indices(motion.skeleton).get("hips")
    if joint is None:
        joint = int(still_joints(motion).argmin())
    above: list[int] = []
    parent = motion.skeleton.parents[joint]
    while parent >= 0:
        above.insert(0, parent)
        parent = motion.skeleton.parents[parent]
    return HeadingJoint(joint, tuple(above))


def to_world(motion: Motion, heading: HeadingJoint) -> tuple[Array, Array]:
    """Return world rotations (n_frames, 4) and positions (n_frames, 3) of the heading joint.

    NaN where the joint or the root position is missing. Missing rotations of the joints above
    are interpolated.
    """
    rotation, displacement = _above(motion, heading)
    return (
        multiply(rotation, motion.rotations[:, heading.joint]),
        motion.root_positions + displacement,
    )


def to_local(
    motion: Motion, heading: HeadingJoint, world: Array, positions: Array
) -> tuple[Array, Array]:
    """Return local rotations of the joint, (n_frames, 4), and root positions, (n_frames, 3).

    It inverts `to_world`.
    """
    rotation, displacement = _above(motion, heading)
    return multiply(inverse(rotation), world), positions - displacement


def _above(motion: Motion, heading: HeadingJoint) -> tuple[Array, Array]:
    """Return the rotation of the parent, and the position relative to the root."""
    rotation = np.tile([1.0, 0.0, 0.0, 0.0], (motion.n_frames, 1))
    displacement = np.zeros((motion.n_frames, 3))
    if not heading.above:
        return rotation, displacement
    joints = list(heading.above)
    filled = fill_rotation_gaps(motion.rotations[:, joints])
    for index, child in enumerate((*joints[1:], heading.joint)):
        rotation = multiply(rotation, filled[:, index])
        displacement += rotate(rotation, motion.skeleton.offsets[child])
    return rotation, displacement
