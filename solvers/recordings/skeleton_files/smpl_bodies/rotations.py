"""Rotations of SMPL bodies as rotation vectors, however video models store them."""

from collections.abc import Collection, Mapping

import numpy as np

from ....arrays import Array, Flags
from ....rotations import quaternion_from_matrix, rotation_vector_from_quaternion

MAX_DEVIATION = 1e-2
"""Difference from 1 and 0 of the products of a matrix's rows, a ratio. It guards arrays of
something else, such as three people's vectors; networks give rotations to 32 bits."""


def with_rotation_vectors(
    arrays: Mapping[str, Array], names: Collection[str]
) -> dict[str, Array]:
    """Return arrays with rotation vectors in place of rotation matrices.

    Parameters
    ----------
    arrays : mapping from name to array
    names : names of arrays of rotations
        Of shape (..., 3, 3) if they hold matrices; they get the shape (..., 3). Rows of
        matrices, shape (n * 9,), become rows of vectors.
    """
    return {
        name: _rotation_vectors(array) if name in names and _are_rotations(array) else array
        for name, array in arrays.items()
    }


def _are_rotations(array: Array) -> bool:
    """Return whether an array holds rotation matrices, or NaN or zeros where there is none."""
    is_row = array.ndim == 1 and array.size % 9 == 0
    if not is_row and (array.ndim < 3 or array.shape[-2:] != (3, 3)):
        return False
    matrices = array.reshape(-1, 3, 3)
    matrices = matrices[_is_known(matrices)]
    products = matrices @ np.swapaxes(matrices, 1, 2) - np.eye(3)
    return (
        len(matrices) > 0
        and bool(np.abs(products).max() < MAX_DEVIATION)
        and bool((np.linalg.det(matrices) > 0.0).all())
    )


def _rotation_vectors(array: Array) -> Array:
    matrices = array.reshape(-1, 3, 3)
    known = _is_known(matrices)
    vectors = np.full((len(matrices), 3), np.nan)
    vectors[known] = rotation_vector_from_quaternion(quaternion_from_matrix(matrices[known]))
    return vectors.reshape(array.shape[:-1] if array.ndim > 1 else -1)


def _is_known(matrices: Array) -> Flags:
    """Return which matrices are there; programs write zeros where they detected no person."""
    known: Flags = np.isfinite(matrices).all(axis=(1, 2)) & matrices.any(axis=(1, 2))
    return known
