"""Limits of joint rotations, as boxes of angles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidMotionError

ROTATION_VECTOR = ""
EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


@dataclass(frozen=True, eq=False)
class JointLimits:
    """Box of allowed angles for each joint.

    A local rotation L is transformed to left^-1 L right, and its three coordinates must be
    between `lower` and `upper`. A Limit Rotation constraint of Blender uses the bone's rest
    axes: left and right are both those axes, in world space. Learned limits are centered on the
    mean rotation and aligned with the principal directions of the joint's motion.

    Attributes
    ----------
    names : tuple of str
        Names of joints or, where `by_role`, humanoid roles.
    by_role : bool array, shape (n_limits,)
        True: the name is a humanoid role and the rotation is relative to the canonical T-pose,
        so that the limit holds for any rig. False: the name is that of a joint.
    left, right : shape (n_limits, 4), unit quaternions w x y z
    orders : tuple of str
        Euler order of each limit, as in `quaternion_from_euler` ("ZYX" for Blender's "XYZ"),
        and the order of its limited angles; "" for the rotation vector.
    lower, upper : shape (n_limits, 3), radians; -inf and inf where an axis is free
    """

    names: tuple[str, ...]
    by_role: NDArray[np.bool_]
    left: Array
    right: Array
    orders: tuple[str, ...]
    lower: Array
    upper: Array

    def __post_init__(self) -> None:
        n_limits = len(self.names)
        for name, width in (("left", 4), ("right", 4), ("lower", 3), ("upper", 3)):
            array = np.array(getattr(self, name), dtype=np.float64).reshape(-1, width)
            object.__setattr__(self, name, array)
        object.__setattr__(self, "by_role", np.array(self.by_role, dtype=np.bool_))
        lengths = {
            len(getattr(self, name))
            for name in ("by_role", "left", "right", "orders", "lower", "upper")
        }
        if lengths != {n_limits}:
            raise InvalidMotionError(
                f"{n_limits} joint limits need {n_limits} entries in every attribute."
            )
        unknown = [
            order for order in self.orders if order not in (ROTATION_VECTOR, *EULER_ORDERS)
        ]
        if unknown:
            raise InvalidMotionError(
                f"There are no such Euler orders: {', '.join(unknown)}. Use XYZ or another."
            )
        empty = ~(self.lower <= self.upper).all(axis=1)
        if empty.any():
            names = [name for name, is_empty in zip(self.names, empty, strict=True) if is_empty]
            raise InvalidMotionError(
                f"The lower limit must not exceed the upper one: {', '.join(names)}."
            )
