"""Rotation channels, quaternion or Euler, in which a rig keys a joint."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array
from ..errors import InvalidMotionError
from ..rotations import (
    IDENTITY,
    euler_from_quaternion,
    inverse,
    multiply,
    normalize,
    quaternion_from_euler,
    unroll,
    unwrap_euler,
)

ORDERS = ("", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


@dataclass(frozen=True, eq=False)
class RotationChannels:
    """Rotation mode of a joint: quaternion or Euler angles about its own axes.

    Attributes
    ----------
    order : str
        Euler order, as in `quaternion_from_euler`: "ZYX" for Blender's XYZ; ""
        for a quaternion.
    axes : shape (4,)
        Unit quaternion from the world's axes to the joint's in the rest pose, such as the
        rotation of a Blender bone's `matrix_local`.
    """

    order: str = ""
    axes: Array = field(default_factory=IDENTITY.copy)

    def __post_init__(self) -> None:
        axes = np.array(self.axes, dtype=np.float64)
        if self.order not in ORDERS or axes.shape != (4,) or not np.isfinite(axes).all():
            raise InvalidMotionError(
                "Rotation channels need one of the orders"
                f" {', '.join(ORDERS[1:])} or none, and axes as a quaternion; not"
                f" {self.order!r} and {axes.tolist()}."
            )
        object.__setattr__(self, "axes", normalize(axes))

    def from_rotations(self, rotations: Array) -> Array:
        """Return the channels, continuous in time, shape (n_frames, 4 or 3)."""
        own = multiply(multiply(inverse(self.axes), rotations), self.axes)
        if not self.order:
            return unroll(own)
        return unwrap_euler(euler_from_quaternion(own, self.order))

    def to_rotations(self, channels: Array) -> Array:
        """Return local rotations in the world's axes, shape (n_frames, 4)."""
        quaternions = quaternion_from_euler(channels, self.order) if self.order else channels
        own = normalize(quaternions)
        return multiply(multiply(self.axes, own), inverse(self.axes))
