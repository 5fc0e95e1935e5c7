"""Hold the loaded points of a body part in place, and at their height."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import WorldPoses
from ...rotations import rotate
from .. import FittedMotion, NormalEquations


class BonePoint(NamedTuple):
    """A point that is fixed to a bone."""

    bone: int
    offset: Array
    """From the joint, in the axes of the rest pose, shape (3,), meters."""

    def position(self, poses: WorldPoses) -> Array:
        """Return its position in the world, (n_frames, 3)."""
        return np.asarray(
            poses.positions[:, self.bone] + rotate(poses.rotations[:, self.bone], self.offset)
        )


def loaded_jacobian(points: Sequence[BonePoint], load: Array, fitted: FittedMotion) -> Array:
    """Return the derivative of the loaded mean of points, (n_frames, 3, n_variables)."""
    jacobian = np.zeros((len(load), 3, fitted.n_variables))
    for index, point in enumerate(points):
        derivative = fitted.point_jacobian(point.position(fitted.poses), point.bone)
        jacobian += load[:, index, None, None] * derivative
    return jacobian


@dataclass(frozen=True, eq=False)
class StayInPlace:
    """Keep the loaded part of a sole or hand from moving, or let it move as wanted.

    Attributes
    ----------
    points : sequence of BonePoint
    load : shape (n_frames - 1, n_points)
        Fraction of the load on each point in each step.
    weight : shape (n_frames - 1, 3), 0 to 1
        Of each step in each direction.
    tolerance : float, meters per second
    wanted : shape (n_frames - 1, 3) or a number, meters
        The displacement from each frame to the next; by default none.
    """

    points: Sequence[BonePoint]
    load: Array
    weight: Array
    tolerance: float
    wanted: Array | float = 0.0

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        positions = np.stack([point.position(fitted.poses) for point in self.points], axis=1)
        moved = np.einsum("fp,fpi->fi", self.load, np.diff(positions, axis=0)) - self.wanted
        scale = self.weight * (fitted.motion.frame_rate / self.tolerance)
        before = np.zeros((len(moved), 3, fitted.n_variables))
        after = np.zeros_like(before)
        for index, point in enumerate(self.points):
            derivative = fitted.point_jacobian(positions[:, index], point.bone)
            before -= self.load[:, index, None, None] * derivative[:-1]
            after += self.load[:, index, None, None] * derivative[1:]
        equations.add_steps(moved * scale, before * scale[..., None], after * scale[..., None])


@dataclass(frozen=True, eq=False)
class StayAtHeight:
    """Keep the loaded part of a sole at a height.

    Attributes
    ----------
    points : sequence of BonePoint
    load : shape (n_frames, n_points)
    above : shape (n_points,), meters
        Height of each point above the floor while the whole sole rests.
    height : float or shape (n_frames,), meters
        Of the floor.
    weight : shape (n_frames,), 0 to 1
    tolerance : float, meters
    """

    points: Sequence[BonePoint]
    load: Array
    above: Array
    height: Array | float
    weight: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        heights = np.stack(
            [point.position(fitted.poses)[:, 2] for point in self.points], axis=1
        )
        error = np.sum(self.load * (heights - self.above), axis=1) - self.height
        scale = self.weight / self.tolerance
        jacobian = loaded_jacobian(self.points, self.load, fitted)[:, 2:]
        equations.add_frames((error * scale)[:, None], jacobian * scale[:, None, None])


@dataclass(frozen=True, eq=False)
class FollowPosition:
    """Keep a point of a bone near a path.

    Attributes
    ----------
    point : BonePoint
    wanted : shape (n_frames, 3), meters
    weight : shape (n_frames, 3), 0 or more
        In each direction.
    tolerance : float, meters
    """

    point: BonePoint
    wanted: Array
    weight: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        position, scale = self.point.position(fitted.poses), self.weight / self.tolerance
        jacobian = fitted.point_jacobian(position, self.point.bone)
        equations.add_frames((position - self.wanted) * scale, jacobian * scale[..., None])


@dataclass(frozen=True, eq=False)
class StayAbove:
    """Keep a point of a bone above a height.

    Attributes
    ----------
    point : BonePoint
    minimum : shape (n_frames,), meters
    tolerance : float, meters
    """

    point: BonePoint
    minimum: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        position = self.point.position(fitted.poses)
        below = np.minimum(position[:, 2] - self.minimum, 0.0) / self.tolerance
        jacobian = fitted.point_jacobian(position, self.point.bone)[:, 2:] / self.tolerance
        jacobian[below == 0.0] = 0.0
        equations.add_frames(below[:, None], jacobian)


@dataclass(frozen=True, eq=False)
class KeepSeparation:
    """Keep one point at a displacement from another.

    Attributes
    ----------
    point, other : BonePoint
    wanted : shape (n_frames, 3), meters
        From the other to the point.
    weight : shape (n_frames,), 0 to 1
    tolerance : float, meters
    """

    point: BonePoint
    other: BonePoint
    wanted: Array
    weight: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        position, other = (each.position(fitted.poses) for each in (self.point, self.other))
        scale = self.weight[:, None] / self.tolerance
        jacobian = fitted.point_jacobian(position, self.point.bone)
        jacobian -= fitted.point_jacobian(other, self.other.bone)
        equations.add_frames(
            (position - other - self.wanted) * scale, jacobian * scale[..., None]
        )
