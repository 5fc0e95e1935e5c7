"""Directions and frames of many vectors at once; arrays of shape (..., 3)."""

import warnings

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def unit(vectors: Array) -> Array:
    """Return vectors of length one; NaN where there is no direction."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, np.nan))


def across(vectors: Array, axis: Array) -> Array:
    """Return the part of vectors that is at right angles to an axis of length one."""
    return np.asarray(vectors - dot(vectors, axis)[..., None] * axis)


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products, shape (...)."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def frame(first: int, along: Array, second: int, hint: Array) -> Array:
    """Return right-handed frames, shape (..., 3, 3), whose columns are their axes.

    Parameters
    ----------
    first, second : 0, 1 or 2
        Which axis lies along `along`, and which one lies as near to `hint` as can be.
    along, hint : shape (..., 3)
    """
    axes: list[Array] = [np.empty(0)] * 3
    axes[first] = unit(along)
    axes[second] = unit(across(hint, axes[first]))
    third = 3 - first - second
    sign = 1.0 if (third - first) % 3 == 2 else -1.0
    axes[third] = sign * np.cross(axes[first], axes[second])
    return np.stack(np.broadcast_arrays(*axes), axis=-1)


def swung(frames: Array, axis: Array, onto: Array) -> Array:
    """Turn frames the short way so that their own `axis`, shape (3,), points along `onto`.

    Opposite directions, which have no short way, give NaN.
    """
    start = frames @ axis
    stop = unit(onto)
    cross = np.cross(start, stop)
    agree = 1.0 + dot(start, stop)
    agree = np.where(agree > 1e-9, agree, np.nan)
    skew = skewed(cross)
    turn = np.eye(3) + skew + skew @ skew / agree[..., None, None]
    return np.asarray(turn @ frames)


def skewed(vectors: Array) -> Array:
    """Return the matrices that make the cross product from the left, shape (..., 3, 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = [zero, -z, y, z, zero, -x, -y, x, zero]
    return np.asarray(np.stack(rows, axis=-1).reshape(*vectors.shape, 3))


def turned_by(vectors: Array) -> Array:
    """Return the rotation matrices of rotation vectors (Rodrigues), shape (..., 3, 3)."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    skew = skewed(vectors)
    small = angle < 1e-8
    safe = np.where(small, 1.0, angle)
    first = np.where(small, 1.0, np.sin(angle) / safe)
    second = np.where(small, 0.5, (1.0 - np.cos(angle)) / safe**2)
    return np.asarray(np.eye(3) + first * skew + second * skew @ skew)


def median(values: Array) -> Array:
    """Return the median over frames, leaving out NaN; 0 where there is nothing else."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of all-NaN columns
        return np.asarray(np.nan_to_num(np.nanmedian(values, axis=0)))
