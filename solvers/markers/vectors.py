"""Vector algebra on arrays of shape (..., 3)."""

import warnings

import numpy as np

from ..arrays import Array
from ..rotations import normalize, skew_matrices


def perpendicular(vectors: Array, axis: Array) -> Array:
    """Return the component of vectors perpendicular to a unit axis, shape (..., 3)."""
    return np.asarray(vectors - dot(vectors, axis)[..., None] * axis)


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products, shape (...)."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


def frame(first: int, along: Array, second: int, hint: Array) -> Array:
    """Return right-handed frames, shape (..., 3, 3), whose columns are their axes.

    Parameters
    ----------
    first, second : 0, 1 or 2
        Index of the axis along `along`, and of the axis nearest to `hint`.
    along, hint : shape (..., 3)
    """
    axes: list[Array] = [np.empty(0)] * 3
    axes[first] = normalize(along)
    axes[second] = normalize(perpendicular(hint, axes[first]))
    third = 3 - first - second
    sign = 1.0 if (third - first) % 3 == 2 else -1.0
    axes[third] = sign * np.cross(axes[first], axes[second])
    return np.stack(np.broadcast_arrays(*axes), axis=-1)


def swing_frames(frames: Array, axis: Array, onto: Array) -> Array:
    """Rotate frames by the shortest rotation that points their `axis` along `onto`.

    Opposite directions, without a shortest rotation, give NaN.

    Parameters
    ----------
    frames : shape (..., 3, 3)
        Columns are axes.
    axis : shape (3,)
        In each frame.
    onto : shape (..., 3)
    """
    start = frames @ axis
    stop = normalize(onto)
    cross = np.cross(start, stop)
    agreement = 1.0 + dot(start, stop)
    agreement = np.where(agreement > 1e-9, agreement, np.nan)
    skew = skew_matrices(cross)
    rotation = np.eye(3) + skew + skew @ skew / agreement[..., None, None]
    return np.asarray(rotation @ frames)


def matrix_from_rotation_vector(vectors: Array) -> Array:
    """Return the rotation matrices of rotation vectors (Rodrigues), shape (..., 3, 3).

    Rounded otherwise than that of depth tracking, which shares terms with its derivative.
    """
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    skew = skew_matrices(vectors)
    small = angle < 1e-8
    safe = np.where(small, 1.0, angle)
    first = np.where(small, 1.0, np.sin(angle) / safe)
    second = np.where(small, 0.5, (1.0 - np.cos(angle)) / safe**2)
    return np.asarray(np.eye(3) + first * skew + second * skew @ skew)


def nan_median(values: Array) -> Array:
    """Return medians of values, (n, ...), over the first axis without NaN; NaN if all are."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of all-NaN columns
        return np.asarray(np.nanmedian(values, axis=0))


def median_or_zero(values: Array) -> Array:
    """Return medians of values, (n, ...), over the first axis without NaN; 0 if all are NaN."""
    return np.nan_to_num(nan_median(values))
