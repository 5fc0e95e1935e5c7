"""Keep knees, elbows and toes to their hinges."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...motion import Skeleton
from ...motion.humanoid import UP
from ...motion.skeletons import MIN_BONE_M
from ...rotations import inverse, rotate
from .. import FittedMotion, NormalEquations

START_RAD = np.radians(3.0)
"""Radians by which a straight limb is bent before the fit. It guards limbs that are exactly
straight."""
MIN_BEND = np.sin(np.radians(10.0))
"""Sine of the flexion at which the axis that a limb shows counts as much as its usual one; with
a mean flexion below it is unknown. It guards straight limbs, whose bones have an angle by
noise, and knees that bend backward by a few degrees."""
HINGE_RAD = np.radians(1.0)
"""Radians by which a hinge may pass its limit. It guards knees, elbows and toes against bending
the wrong way."""
FORWARD = np.array([0.0, -1.0, 0.0])


@dataclass(frozen=True, eq=False)
class HingeLimit:
    """Keep the flexion of a hinge above a limit.

    Attributes
    ----------
    joint : int
    end : int
        Joint at the far end of the lower bone.
    axis : shape (3,) or (n_frames, 3)
        About which the hinge bends, in the axes of its parent.
    minimum : shape (n_frames,), radians
    tolerance : float, radians
    """

    joint: int
    end: int
    axis: Array
    minimum: Array
    tolerance: float = HINGE_RAD

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        below = np.minimum(
            hinge_flexion(fitted, self.joint, self.end, self.axis) - self.minimum, 0.0
        )
        jacobian = np.zeros((len(below), 1, fitted.n_variables))
        slope = (self.axis[..., None, :] @ fitted.axes_of(self.joint))[..., 0, :]
        jacobian[:, 0, fitted.columns(self.joint)] = slope / self.tolerance
        jacobian[below == 0.0] = 0.0
        equations.add_frames(below[:, None] / self.tolerance, jacobian)


def knee_limit(fitted: FittedMotion, knee: int, ankle: int, reserve: float) -> HingeLimit:
    """Return the goal that a knee bends no less than recorded, or than `reserve` in radians.

    A leg that hardly bends, or backward by a few degrees, does not show its axis: then it is
    the one across the foot in the rest pose.
    """
    axis = hinge_axis(fitted, knee, ankle)
    if axis is None:
        axis = _axis_across_foot(fitted.motion.skeleton, ankle)
    return hinge_limit(fitted, knee, ankle, axis, reserve)


def _axis_across_foot(skeleton: Skeleton, ankle: int) -> Array:
    """Return the horizontal axis across a foot of the rest pose, about which its knee bends."""
    rest, children = skeleton.rest_positions, skeleton.children[ankle]
    forward = rest[children[0]] - rest[ankle] if children else FORWARD
    across = np.cross(UP, forward)
    length = float(np.linalg.norm(across))
    return np.asarray(across / length if length > MIN_BONE_M else np.cross(UP, FORWARD))


def hinge_limit(
    fitted: FittedMotion, joint: int, end: int, axis: Array, reserve: float
) -> HingeLimit:
    """Return the goal that a hinge bends no less than recorded, or than `reserve` radians.

    It bends about `axis`, (3,), in the axes of the joint's parent.
    """
    minimum = np.minimum(hinge_flexion(fitted, joint, end, axis), reserve)
    return HingeLimit(joint, end, axis, minimum)


def with_bent_hinge(fitted: FittedMotion, limit: HingeLimit) -> FittedMotion:
    """Return a start of the fit in which no frame has a straight limb.

    A straight limb does not get shorter to first order, whichever way it bends.
    """
    flexion = hinge_flexion(fitted, limit.joint, limit.end, limit.axis)
    step = np.zeros((len(flexion), fitted.n_variables))
    missing = np.where(np.abs(flexion) < START_RAD, START_RAD - flexion, 0.0)
    own = (limit.axis[..., None, :] @ fitted.axes_of(limit.joint))[..., 0, :]
    step[:, fitted.columns(limit.joint)] = missing[:, None] * own
    return fitted.moved(step)


def bone_directions(fitted: FittedMotion, joint: int, end: int) -> tuple[Array, Array]:
    """Return the directions of both bones, (n_frames, 3), in the axes of the joint's parent."""
    skeleton, poses = fitted.motion.skeleton, fitted.poses
    parent = skeleton.parents[joint]
    parent_from_world = inverse(poses.rotations[:, parent])
    upper = rotate(parent_from_world, poses.positions[:, joint] - poses.positions[:, parent])
    lower = rotate(parent_from_world, poses.positions[:, end] - poses.positions[:, joint])
    return tuple(
        each / np.maximum(np.linalg.norm(each, axis=1, keepdims=True), 1e-9)
        for each in (upper, lower)
    )


def hinge_flexion(fitted: FittedMotion, joint: int, end: int, axis: Array) -> Array:
    """Return the angle between the bones about an axis, radians, (n_frames,); 0 is straight."""
    upper, lower = bone_directions(fitted, joint, end)
    sine = np.sum(np.cross(upper, lower) * axis, axis=1)
    return np.asarray(np.arctan2(sine, np.sum(upper * lower, axis=1)))


def hinge_axis(fitted: FittedMotion, joint: int, end: int) -> Array | None:
    """Return the mean axis, (3,), about which a joint bends; None if it hardly bends."""
    upper, lower = bone_directions(fitted, joint, end)
    axis = np.cross(upper, lower).mean(axis=0)
    length = float(np.linalg.norm(axis))
    return axis / length if length > MIN_BEND else None


def flexion_in_reserve(limb: Array, fraction: float) -> float:
    """Return the flexion in radians at which a limb is shorter by a fraction of its length.

    `limb` are the rest positions of its three joints, shape (3, 3).
    """
    upper, lower = np.linalg.norm(np.diff(limb, axis=0), axis=1)
    reach = (1.0 - fraction) * (upper + lower)
    cosine = (reach**2 - upper**2 - lower**2) / max(2.0 * upper * lower, 1e-12)
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))
