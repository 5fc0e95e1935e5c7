"""Directions, flexion and axial rotation of limbs."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...rotations import cross

Complex = NDArray[np.complex128]

MIN_LENGTH = 1e-9
"""Length in meters below which a vector has no direction. It guards divisions."""


def unit_vectors(vectors: Array, fill: float = 0.0) -> Array:
    """Return vectors (..., 3) of length 1; zero vectors become `fill`, and NaN stays NaN."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    is_zero = lengths <= MIN_LENGTH
    return np.asarray(np.where(is_zero, fill, vectors / np.where(is_zero, 1.0, lengths)))


def measure_flexion(upper: Array, lower: Array) -> tuple[Array, Array]:
    """Return flexion axes of limbs and their flexion angles, in radians.

    From the unit vectors, (..., 3), of the segments above and below the hinge.
    """
    normals = cross(upper, lower)
    along = np.einsum("...i,...i->...", upper, lower)
    return normals, np.arctan2(np.linalg.norm(normals, axis=-1), along)


def axial_angles(directions: Array, untwisted: Array, hinges: Array) -> Complex:
    """Return rotations from untwisted to actual hinges, as complex numbers of length 1.

    All of shape (..., 3), `hinges` of any length; NaN where one is NaN or no angle exists.
    """
    cos = np.einsum("...i,...i->...", untwisted, hinges)
    sin = np.einsum("...i,...i->...", cross(untwisted, hinges), directions)
    size = np.hypot(cos, sin)
    is_defined = size > MIN_LENGTH
    return np.asarray(
        np.where(is_defined, cos + 1j * sin, np.nan) / np.where(is_defined, size, 1.0)
    )
