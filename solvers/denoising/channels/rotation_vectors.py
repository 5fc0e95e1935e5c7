"""Rotation vectors of joints that are continuous over time, beyond half a turn too."""

import numpy as np

from ...arrays import Array
from ...rotations import (
    FULL_TURN_RAD,
    IDENTITY,
    angle_between,
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
    unwrap_rotation_vectors,
)
from ...signals import fill_channel_gaps, smooth_gaussian
from .travel_path import MAX_ANGLE_RAD, UNWRAP_S, smooth_angles, unwrap_angles


def continuous_rotation_vectors(rotations: Array, frame_rate: float) -> tuple[Array, Array]:
    """Return rotation vectors without jumps, about a reference that rotates where it must.

    Vectors of a joint that stays within 120 degrees of its mean are nearest to the vector of
    this mean. Other vectors are unwrapped along time: each is the equivalent nearest to that
    of the local mean rotation, so that neither noise nor spikes add up to full turns. Near a
    full turn rotation vectors are singular. Those of a joint that turns by more than 240
    degrees are therefore relative to a smooth rotation about the axis of these turns, as the
    body is to its heading.

    Parameters
    ----------
    rotations : shape (n_frames, n_joints, 4)
        NaN where missing.
    frame_rate : float, hertz

    Returns
    -------
    vectors : Array
        Shape (n_frames, n_joints, 3), radians.
    references : Array
        Shape (n_frames, n_joints, 4). The rotations are these times those of the vectors.
    """
    means = mean_rotation(rotations)
    vectors = nearest_equivalents(
        rotation_vector_from_quaternion(rotations), rotation_vector_from_quaternion(means)
    )
    references = np.tile(IDENTITY, (*rotations.shape[:2], 1))
    distance = np.nan_to_num(angle_between(means, rotations))
    for joint in np.flatnonzero(distance.max(axis=0) > MAX_ANGLE_RAD):
        vectors[:, joint], references[:, joint] = _unwrapped(
            rotations[:, joint], vectors[:, joint], means[joint], frame_rate
        )
    return vectors, references


def nearest_equivalents(vectors: Array, near: Array) -> Array:
    """Return equivalent rotation vectors (..., 3), radians, that are nearest to others."""
    angles = np.linalg.norm(vectors, axis=-1, keepdims=True)
    axes = vectors / np.maximum(angles, 1e-150)
    turns = np.round(((near - vectors) * axes).sum(axis=-1, keepdims=True) / FULL_TURN_RAD)
    return np.asarray(vectors + FULL_TURN_RAD * turns * axes)


def _unwrapped(
    rotations: Array, vectors: Array, mean: Array, frame_rate: float
) -> tuple[Array, Array]:
    """Return continuous vectors and references of one joint."""
    smooth = _local_means(rotations, UNWRAP_S * frame_rate)
    near = _unwrap(smooth, mean)
    if np.linalg.norm(near, axis=-1).max() <= 2.0 * MAX_ANGLE_RAD:
        return nearest_equivalents(vectors, near), np.tile(IDENTITY, (len(rotations), 1))
    axis = _turning_axis(smooth)
    twists = 2.0 * np.arctan2(rotations[:, 1:] @ axis, rotations[:, 0].copy())
    angles = smooth_angles(unwrap_angles(twists, UNWRAP_S * frame_rate), frame_rate)
    references = quaternion_from_rotation_vector(angles[:, None] * axis)
    references = multiply(references, mean_rotation(multiply(inverse(references), rotations)))
    local = rotation_vector_from_quaternion(multiply(inverse(references), rotations))
    near = _unwrap(multiply(inverse(references), smooth), IDENTITY)
    return nearest_equivalents(local, near), references


def _unwrap(rotations: Array, mean: Array) -> Array:
    """Return vectors that change least from frame to frame, from the one nearest the mean."""
    vectors = rotation_vector_from_quaternion(rotations)
    start = int(angle_between(mean, rotations).argmin())
    mean_vector = rotation_vector_from_quaternion(mean)
    vectors[start] = nearest_equivalents(vectors[start], mean_vector)
    vectors[start:] = unwrap_rotation_vectors(vectors[start:])
    vectors[: start + 1] = unwrap_rotation_vectors(vectors[start::-1])[::-1]
    return vectors


def _local_means(rotations: Array, width: float) -> Array:
    """Return the chordal mean around every frame (`mean_rotation`), shape (n_frames, 4)."""
    outer = np.einsum("fi,fj->fij", rotations, rotations).reshape(len(rotations), -1)
    smooth = smooth_gaussian(fill_channel_gaps(outer), width).reshape(-1, 4, 4)
    return np.asarray(np.linalg.eigh(smooth)[1][..., -1])


def _turning_axis(rotations: Array) -> Array:
    """Return the axis, shape (3,), about which rotations (n_frames, 4) turn farthest."""
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    return np.asarray(np.linalg.eigh(steps.T @ steps)[1][:, -1])
