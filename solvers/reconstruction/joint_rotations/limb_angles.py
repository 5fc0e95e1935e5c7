"""Directions of limbs, how far these bend, and how far they are turned about themselves."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MIN_LENGTH = 1e-9


def unit_vectors(vectors: Array, of_none: float = 0.0) -> Array:
    """Return vectors of length 1; those of no length become `of_none`, and NaN stays NaN."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    none = lengths <= MIN_LENGTH
    return np.asarray(np.where(none, of_none, vectors / np.where(none, 1.0, lengths)))


def measure_flexion(upper: Array, lower: Array) -> tuple[Array, Array]:
    """Return the axes about which limbs are bent, and by how much, in radians.

    From the unit vectors, (..., 3), of what is above and below the hinge.
    """
    normals = np.cross(upper, lower)
    along = np.einsum("...i,...i->...", upper, lower)
    return normals, np.arctan2(np.linalg.norm(normals, axis=-1), along)


def axial_angles(directions: Array, plain: Array, hinges: Array) -> Complex:
    """Return by how much hinges are turned from the plain ones, as numbers of length 1.

    All of shape (..., 3), `hinges` of any length; NaN where one is NaN or has no angle.
    """
    cos = np.einsum("...i,...i->...", plain, hinges)
    sin = np.einsum("...i,...i->...", np.cross(plain, hinges), directions)
    size = np.hypot(cos, sin)
    told = size > MIN_LENGTH
    return np.asarray(np.where(told, cos + 1j * sin, np.nan) / np.where(told, size, 1.0))
