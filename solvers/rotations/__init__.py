"""Unit quaternions (w x y z): conversions, algebra, interpolation and least-squares fits."""

from .quaternion_algebra import multiply_components, rotate_components
from .representations import (
    IDENTITY,
    angle_between,
    euler_from_quaternion,
    inverse,
    matrix_from_quaternion,
    mean_rotation,
    multiply,
    normalize,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
    rotation_vector_from_quaternion,
    slerp,
    twist_about,
    unroll,
    unwrap_euler,
)
from .rigid_fit import fit_rotations

__all__ = [
    "IDENTITY",
    "angle_between",
    "euler_from_quaternion",
    "fit_rotations",
    "inverse",
    "matrix_from_quaternion",
    "mean_rotation",
    "multiply",
    "multiply_components",
    "normalize",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_from_rotation_vector",
    "rotate",
    "rotate_components",
    "rotation_between",
    "rotation_vector_from_quaternion",
    "slerp",
    "twist_about",
    "unroll",
    "unwrap_euler",
]
