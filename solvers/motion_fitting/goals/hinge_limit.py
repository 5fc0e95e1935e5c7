"""Keep a knee or elbow from bending the wrong way."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...rotations import inverse, rotate
from .. import FittedMotion, NormalEquations


@dataclass(frozen=True, eq=False)
class HingeLimit:
    """Keep the flexion of a hinge above a limit.

    Attributes
    ----------
    joint : int
    end : int
        Joint at the far end of the lower bone.
    axis : shape (3,)
        About which the hinge bends, in the axes of its parent.
    minimum : shape (n_frames,), radians
    tolerance : float, radians
    """

    joint: int
    end: int
    axis: Array
    minimum: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        below = np.minimum(
            hinge_flexion(fitted, self.joint, self.end, self.axis) - self.minimum, 0.0
        )
        jacobian = np.zeros((len(below), 1, fitted.n_variables))
        jacobian[below < 0.0, 0, fitted.columns(self.joint)] = self.axis / self.tolerance
        equations.add_frames(below[:, None] / self.tolerance, jacobian)


def hinge_limits(
    fitted: FittedMotion, joint: int, end: int, reserve: float, tolerance: float
) -> list[HingeLimit]:
    """Return the goal that a hinge bends no less than recorded, or than `reserve` in radians.

    There is none for a hinge that never bends, whose axis is unknown.
    """
    axis = hinge_axis(fitted, joint, end)
    if axis is None:
        return []
    minimum = np.minimum(hinge_flexion(fitted, joint, end, axis), reserve)
    return [HingeLimit(joint, end, axis, minimum, tolerance)]


def bone_directions(fitted: FittedMotion, joint: int, end: int) -> tuple[Array, Array]:
    """Return the directions of upper and lower bone in the axes of the joint's parent."""
    skeleton, poses = fitted.motion.skeleton, fitted.poses
    parent = skeleton.parents[joint]
    turn = inverse(poses.rotations[:, parent])
    upper = rotate(turn, poses.positions[:, joint] - poses.positions[:, parent])
    lower = rotate(turn, poses.positions[:, end] - poses.positions[:, joint])
    return tuple(
        each / np.maximum(np.linalg.norm(each, axis=1, keepdims=True), 1e-9)
        for each in (upper, lower)
    )


def hinge_flexion(fitted: FittedMotion, joint: int, end: int, axis: Array) -> Array:
    """Return the signed angle between the bones about an axis, radians, 0 straight."""
    upper, lower = bone_directions(fitted, joint, end)
    return np.arctan2(np.cross(upper, lower) @ axis, np.sum(upper * lower, axis=1))


def hinge_axis(fitted: FittedMotion, joint: int, end: int) -> Array | None:
    """Return the mean axis about which a joint bends; None if it never bends."""
    upper, lower = bone_directions(fitted, joint, end)
    axis = np.cross(upper, lower).sum(axis=0)
    length = float(np.linalg.norm(axis))
    return axis / length if length > 1e-6 else None
