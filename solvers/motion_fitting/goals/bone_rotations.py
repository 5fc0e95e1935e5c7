"""Keep the world rotation of a bone: as in the source, or still."""

from dataclasses import dataclass

from ...arrays import Array
from ...rotations import inverse, multiply, rotation_vector_from_quaternion
from .. import FittedMotion, NormalEquations


@dataclass(frozen=True, eq=False)
class FollowRotation:
    """Keep the world rotation of a bone near that of the source.

    Attributes
    ----------
    bone : int
    wanted : quaternions, shape (n_frames, 4)
    tolerance : float, radians
    """

    bone: int
    wanted: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        rotation_changes = multiply(fitted.poses.rotations[:, self.bone], inverse(self.wanted))
        jacobian = fitted.rotation_jacobian(self.bone)
        equations.add_frames(
            rotation_vector_from_quaternion(rotation_changes) / self.tolerance,
            jacobian / self.tolerance,
        )


@dataclass(frozen=True, eq=False)
class StayStill:
    """Keep a bone from rotating.

    Attributes
    ----------
    bone : int
    weight : shape (n_frames - 1, 3), 0 to 1
        Of the rotation between frames about each axis of the world.
    tolerance : float, radians per second
    """

    bone: int
    weight: Array
    tolerance: float

    def add_to(self, equations: NormalEquations, fitted: FittedMotion) -> None:
        """Add residuals and derivatives at the present poses."""
        rotations = fitted.poses.rotations[:, self.bone]
        rotation_changes = rotation_vector_from_quaternion(
            multiply(rotations[1:], inverse(rotations[:-1]))
        )
        scale = self.weight * (fitted.motion.frame_rate / self.tolerance)
        jacobian = fitted.rotation_jacobian(self.bone)
        equations.add_steps(
            rotation_changes * scale,
            -jacobian[:-1] * scale[..., None],
            jacobian[1:] * scale[..., None],
        )
