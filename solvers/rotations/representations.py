"""Rotations as unit quaternions w x y z, arrays of shape (..., 4); leading axes broadcast.

NaN in a rotation gives NaN in its results only.
"""

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from .matrix_quaternions import quaternions_of_matrices
from .quaternion_algebra import (
    Components,
    cross,
    multiply_components,
    product_of,
    rotate_components,
)

IDENTITY: Array = np.array([1.0, 0.0, 0.0, 0.0])
_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])
SMALL_ANGLE_RAD = 1e-6  # below it, series replace quotients: what they leave out is rounding
FULL_TURN_RAD = 2.0 * np.pi
GIMBAL_LOCK_COSINE = 1e-7
"""Cosine of the middle Euler angle below which the others share one axis, up to rounding."""
QUATERNIONS_PER_BLOCK = 8192
"""Quaternions multiplied at a time, so that they fit into the processor's cache."""
_CROSS_FLAT = np.zeros((3, 9))
"""v @ _CROSS_FLAT is the matrix [v]x, flat."""
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    _CROSS_FLAT[_i, 3 * _k + _j], _CROSS_FLAT[_i, 3 * _j + _k] = 1.0, -1.0


def multiply(a: Array, b: Array) -> Array:
    """Return the rotation, (..., 4), that applies `b` first, then `a`: the product A B."""
    a, b = np.asarray(a), np.asarray(b)
    product = np.broadcast(a, b)
    if product.size <= 4 * QUATERNIONS_PER_BLOCK:
        return product_of(multiply_components, a, b)
    result = np.empty(product.shape)
    flat_a, flat_b, flat = (x.reshape(-1, 4) for x in (*np.broadcast_arrays(a, b), result))
    for start in range(0, len(flat), QUATERNIONS_PER_BLOCK):
        block = slice(start, start + QUATERNIONS_PER_BLOCK)
        flat[block] = multiply(flat_a[block], flat_b[block])
    return result


def inverse(rotations: Array) -> Array:
    """Return the inverses of unit quaternions, shape (..., 4)."""
    return np.asarray(np.asarray(rotations) * _CONJUGATE)


def rotate(rotations: Array, vectors: ArrayLike) -> Array:
    """Rotate vectors, shape (..., 3), by rotations, shape (..., 4)."""
    rotations, vectors = np.asarray(rotations), np.asarray(vectors, dtype=np.float64)
    return product_of(rotate_components, rotations, vectors)


def normalize(rotations: Array) -> Array:
    """Return quaternions or vectors, shape (..., n), of length 1; NaN for those of length 0."""
    norms = np.linalg.norm(rotations, axis=-1, keepdims=True)
    return np.asarray(rotations / np.where(norms > 0.0, norms, np.nan))


def quaternion_from_rotation_vector(vectors: ArrayLike) -> Array:
    """Return quaternions of rotation vectors (exponential map), shape (..., 3), radians.

    Exact at zero: for small angles the series of sin(x/2)/x replaces the quotient.
    """
    vectors = np.asarray(vectors, dtype=np.float64)
    angle = np.linalg.norm(vectors, axis=-1, keepdims=True)
    small = angle < SMALL_ANGLE_RAD
    quotient = np.sin(angle / 2) / np.where(small, 1.0, angle)
    scale = np.where(small, 0.5 - angle**2 / 48.0, quotient)
    return np.concatenate([np.cos(angle / 2), scale * vectors], axis=-1)


def rotation_vector_from_quaternion(rotations: Array) -> Array:
    """Return rotation vectors (logarithm), shape (..., 3), radians, of length at most pi."""
    rotations = np.asarray(rotations)
    rotations = np.where(rotations[..., :1] < 0.0, -rotations, rotations)
    w, axis = rotations[..., :1].copy(), rotations[..., 1:]
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    small = sine < SMALL_ANGLE_RAD
    # 2 atan2(s, w) / s tends to 2/w as s tends to 0, and w is near 1 there.
    scale = np.where(small, 2.0, 2.0 * np.arctan2(sine, w) / np.where(small, 1.0, sine))
    return np.asarray(scale * axis)


def matrix_from_quaternion(rotations: Array) -> Array:
    """Return rotation matrices, shape (..., 3, 3), whose columns are the rotated axes."""
    components = np.ascontiguousarray(np.moveaxis(np.asarray(rotations), -1, 0))
    columns = [np.stack(rotate_components(components, axis), axis=-1) for axis in np.eye(3)]
    return np.stack(columns, axis=-1)


def quaternion_from_matrix(matrices: ArrayLike) -> Array:
    """Return quaternions, shape (..., 4), w >= 0, of rotation matrices, shape (..., 3, 3).

    A nearly orthogonal matrix gives the rotation that SciPy finds for it; NaN gives NaN.
    """
    matrices = np.asarray(matrices, dtype=np.float64)
    flat = matrices.reshape(-1, 3, 3)
    valid = np.isfinite(flat).all(axis=(1, 2))
    result = np.full((len(flat), 4), np.nan)
    if valid.any():
        result[valid] = quaternions_of_matrices(flat[valid])
    return result.reshape(*matrices.shape[:-2], 4)


def quaternion_from_euler(angles: ArrayLike, order: str) -> Array:
    """Return quaternions of intrinsic Euler angles, applied in the listed order.

    Parameters
    ----------
    angles : shape (..., 3), radians
        In the order of `order`.
    order : str
        Such as "ZYX" for Rz Ry Rx: the order of BVH channels, and the reverse of Blender's
        name ("XYZ").
    """
    halves = np.moveaxis(np.asarray(angles, dtype=np.float64), -1, 0).copy() / 2
    result: Components = IDENTITY
    for axis, half in zip(order, halves, strict=True):
        rotation = np.zeros((4, *half.shape))
        rotation[0], rotation[1 + "XYZ".index(axis)] = np.cos(half), np.sin(half)
        result = multiply_components(result, rotation)
    return np.stack(tuple(result), axis=-1)


def euler_from_quaternion(rotations: Array, order: str) -> Array:
    """Return Euler angles in radians, shape (..., 3); inverse of `quaternion_from_euler`.

    The order names three different axes. The middle angle is within a quarter turn; at gimbal
    lock the last angle is zero. For continuous angles over time see `unwrap_euler`.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    matrix = np.moveaxis(matrix_from_quaternion(rotations), (-2, -1), (0, 1)).copy()
    # R = R_i(a) R_j(b) R_k(c): row i is (cos b cos c, -+cos b sin c, +-sin b) in i, j, k.
    cosine = np.hypot(matrix[i, i], matrix[i, j])
    locked = cosine < GIMBAL_LOCK_COSINE
    first = np.where(
        locked,
        np.arctan2(sign * matrix[k, j], matrix[j, j]),
        np.arctan2(-sign * matrix[j, k], matrix[k, k]),
    )
    last = np.where(locked, 0.0, np.arctan2(-sign * matrix[i, j], matrix[i, i]))
    return np.stack([first, np.arctan2(sign * matrix[i, k], cosine), last], axis=-1)


def unwrap_euler(angles: Array) -> Array:
    """Choose in each frame the equivalent Euler angles nearest to those of the frame before.

    Parameters
    ----------
    angles : shape (n_frames, ..., 3), radians, about three different axes

    Returns
    -------
    Array
        Same rotations without jumps: every triple has the two forms (a, b, c) and
        (a + pi, pi - b, c + pi), each modulo full turns. NaN frames are skipped.
    """
    angles = np.array(angles, dtype=np.float64)
    if not len(angles):
        return angles
    valid = np.isfinite(angles).all(axis=-1)
    frames = np.arange(len(angles)).reshape(-1, *[1] * (valid.ndim - 1))
    last = np.maximum.accumulate(np.where(valid, frames, -1), axis=0)
    continuous = np.take_along_axis(angles, np.maximum(last, 0)[..., None], axis=0)
    continuous[last < 0] = 0.0
    # Both forms change by the same amount between frames, so that the choice does not depend
    # on the form chosen before and all frames are computed at once.
    other = continuous * (1, -1, 1) + np.pi
    cost_same, cost_other = (
        np.abs(_within_half_turn(form[1:] - continuous[:-1])).sum(axis=-1)
        for form in (continuous, other)
    )
    use_other = np.cumsum(cost_other < cost_same, axis=0) % 2 == 1
    continuous[1:] = np.where(use_other[..., None], other[1:], continuous[1:])
    continuous[1:] = continuous[0] + np.cumsum(
        _within_half_turn(np.diff(continuous, axis=0)), axis=0
    )
    return np.where(valid[..., None], continuous, np.nan)


def unroll(rotations: Array) -> Array:
    """Choose signs along the first axis so that consecutive quaternions share a hemisphere.

    Shape (n_frames, ..., 4). NaN frames are skipped.
    """
    result = np.array(rotations, dtype=np.float64)
    valid = np.isfinite(result).all(axis=-1)
    frames = np.arange(len(result)).reshape(-1, *[1] * (valid.ndim - 1))
    last = np.maximum.accumulate(np.where(valid, frames, -1), axis=0)
    continuous = np.take_along_axis(result, np.maximum(last, 0)[..., None], axis=0)
    agreement = np.einsum("...i,...i->...", continuous[1:], continuous[:-1])
    signs = np.cumprod(np.where(agreement < 0.0, -1.0, 1.0), axis=0)
    result[1:] *= signs[..., None]
    return result


def unwrap_rotation_vectors(vectors: Array) -> Array:
    """Return equivalent rotation vectors that change least along the first axis.

    Rotation by an angle about an axis equals rotation by the angle plus full turns. The first
    valid vector stays as it is, so a result may be longer than pi. NaN frames are skipped.

    Parameters
    ----------
    vectors : shape (n_frames, ..., 3), radians
    """
    result = np.array(vectors, dtype=np.float64)
    valid = np.isfinite(result).all(axis=-1)
    angles = np.linalg.norm(np.where(valid[..., None], result, 0.0), axis=-1, keepdims=True)
    # A rotation by nearly nothing has no axis of its own.
    last = np.maximum.accumulate(np.indices(angles.shape)[0] * (angles > SMALL_ANGLE_RAD))
    directions = np.nan_to_num(result / np.maximum(angles, SMALL_ANGLE_RAD))
    axes = np.take_along_axis(directions, last, axis=0)
    agreement = np.einsum("...i,...i->...", axes[1:], axes[:-1])
    along = np.einsum("...i,...i->...", result, axes)
    is_first = valid & (np.cumsum(valid, axis=0) == 1)
    turns, angle = np.zeros(valid.shape), along[:1].sum(axis=0)
    for frame in range(1, len(result)):
        change = np.where(is_first[frame], 0.0, angle * agreement[frame - 1] - along[frame])
        turns[frame] = np.round(change / FULL_TURN_RAD)
        angle = np.where(valid[frame], along[frame] + FULL_TURN_RAD * turns[frame], angle)
    return np.asarray(result + FULL_TURN_RAD * turns[..., None] * axes)


def slerp(start: Array, stop: Array, fraction: ArrayLike) -> Array:
    """Interpolate along the shortest rotation; `fraction`, shape (...), is 0 to 1."""
    between = rotation_vector_from_quaternion(multiply(inverse(start), stop))
    step = quaternion_from_rotation_vector(np.asarray(fraction)[..., None] * between)
    return multiply(start, step)


def angle_between(a: Array, b: Array) -> Array:
    """Return the geodesic angle in radians, shape (...), 0 to pi."""
    return np.asarray(
        np.linalg.norm(rotation_vector_from_quaternion(multiply(inverse(a), b)), axis=-1)
    )


def mean_rotation(rotations: Array, weights: Array | None = None) -> Array:
    """Return the mean over the first axis, shape (..., 4), that minimizes chordal distances.

    The sum of squared chordal distances is least (Markley et al. 2007, doi:10.2514/1.28949).
    NaN rotations are left out; where all are NaN the mean is the identity. `weights` have the
    shape of the rotations without their components, (n, ...), and are not negative.
    """
    valid = np.isfinite(rotations).all(axis=-1)
    weight = valid * (1.0 if weights is None else weights)
    safe = np.where(valid[..., None], rotations, 0.0)
    outer = np.einsum("f...,f...i,f...j->...ij", weight, safe, safe)
    mean = np.linalg.eigh(outer)[1][..., -1]
    mean = np.where(weight.any(axis=0)[..., None], mean, IDENTITY)
    return np.asarray(np.where(mean[..., :1] < 0.0, -mean, mean))


def rotation_between(start: ArrayLike, stop: ArrayLike) -> Array:
    """Return the shortest rotation from directions `start` to `stop`, shape (..., 3).

    Opposite directions use any perpendicular axis; zero vectors give the identity.
    """
    start, stop = np.asarray(start, float), np.asarray(stop, float)
    lengths = np.linalg.norm(start, axis=-1) * np.linalg.norm(stop, axis=-1)
    result = np.empty((*lengths.shape, 4))
    result[..., 0] = lengths + np.einsum("...i,...i->...", start, stop)
    result[..., 1:] = cross(start, stop)
    opposite = result[..., 0] <= 1e-12 * lengths
    if opposite.any():
        half_turn = np.zeros_like(result)
        half_turn[..., 1:] = cross(start, np.eye(3)[np.abs(start).argmin(axis=-1)])
        half_turn[lengths == 0.0] = IDENTITY
        result = np.where(opposite[..., None], half_turn, result)
    return normalize(result)


def twist_about(rotations: Array, axis: ArrayLike) -> Array:
    """Return the twist of each rotation about the unit vector `axis`, shape (..., 3).

    This is the swing-twist decomposition: `multiply(rotations, inverse(twist))` is the swing,
    the shortest rotation of the axis. If the swing is a half turn, the twist is the identity.
    """
    rotations = np.asarray(rotations)
    axis = np.asarray(axis, dtype=np.float64)
    along = np.einsum("...i,...i->...", rotations[..., 1:], axis)[..., None]
    twist = np.concatenate([rotations[..., :1], along * axis], axis=-1)
    norms = np.linalg.norm(twist, axis=-1, keepdims=True)
    return np.where(norms < 1e-12, IDENTITY, twist / np.where(norms < 1e-12, 1.0, norms))


def skew_matrices(vectors: Array) -> Array:
    """Return the matrices [v]x of the cross product, [v]x @ u = v x u, shape (..., 3, 3)."""
    return np.asarray((vectors @ _CROSS_FLAT).reshape(*vectors.shape, 3))


def _within_half_turn(angles: Array) -> Array:
    return np.asarray(angles - 2 * np.pi * np.round(angles / (2 * np.pi)))
