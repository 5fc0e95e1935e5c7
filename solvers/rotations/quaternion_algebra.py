"""Quaternion products of separate component arrays, the inner loops of `rotations`.

A quaternion is four arrays w, x, y, z; a vector is three. All shapes broadcast. numpy is
several times faster on one array per component than on interleaved components, and plain
numbers take a tenth of the time of arrays of one number.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np

from ..arrays import Array

Components: TypeAlias = Iterable[Array]
Product: TypeAlias = Callable[[Any, Any], tuple[Any, ...]]


def components_of(array: Array) -> tuple[Array, ...]:
    """Return views of the components of quaternions or vectors, shape (..., component)."""
    return tuple(array[..., index] for index in range(array.shape[-1]))


def joined(components: Sequence[Array]) -> Array:
    """Return components of one shape as one array, shape (..., component).

    As `np.stack` along the last axis, at a third of its cost for single poses.
    """
    result = np.empty((*components[0].shape, len(components)), components[0].dtype)
    for index, component in enumerate(components):
        result[..., index] = component
    return result


def product_of(product: Product, a: Array, b: Array) -> Array:
    """Return the product of quaternions or vectors, shape (..., component)."""
    if a.size == a.shape[-1] and b.size == b.shape[-1]:
        single = np.array(product(a.ravel().tolist(), b.ravel().tolist()))
        return single.reshape((1,) * (max(a.ndim, b.ndim) - 1) + (-1,))
    return joined(product(components_of(a), components_of(b)))


def multiply_components(a: Components, b: Components) -> tuple[Array, Array, Array, Array]:
    """Return the rotation that applies `b` first, then `a`; components of equal shape."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def cross_components(a: Components, b: Components) -> tuple[Array, Array, Array]:
    """Return the cross product of vectors, whose x, y and z are arrays of any shape."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def rotate_components(rotation: Components, vector: Components) -> tuple[Array, Array, Array]:
    """Return the rotated vectors, v + 2 w (u x v) + 2 u x (u x v), as arrays of any shape."""
    w, *axis = rotation
    x, y, z = (2.0 * component for component in cross_components(axis, vector))
    vx, vy, vz = vector
    ux, uy, uz = cross_components(axis, (x, y, z))
    return vx + w * x + ux, vy + w * y + uy, vz + w * z + uz


def cross(a: Array, b: Array) -> Array:
    """Return the cross product, shape (..., 3), at a third of the cost of `np.cross`."""
    return product_of(cross_components, a, b)
