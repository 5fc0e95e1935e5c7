"""A bone's rotation channels, in any of Blender's modes, as quaternions w x y z, and back."""

import numpy as np

from ...solvers.arrays import Array
from ...solvers.rotations import (
    IDENTITY,
    euler_from_quaternion,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    unroll,
    unwrap_euler,
)

PROPERTIES = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
MIN_SINE = 1e-9
"""Sine of half an angle below which a rotation has no axis. It guards a division."""


def rotation_property(mode: str) -> tuple[str, int]:
    """Return the property that a rotation mode reads, and how many channels it has."""
    name = PROPERTIES.get(mode, "rotation_euler")
    return name, 3 if name == "rotation_euler" else 4


def quaternions_from_channels(channels: Array, mode: str) -> Array:
    """Return rotations, shape (n_frames, 4), from channels, (n_frames, 3 or 4), radians.

    As Blender does, quaternions and axes of any length count by their direction, and
    those without one for no rotation at all. A channel that is not a number makes the rotation
    missing: NaN.
    """
    if mode == "QUATERNION":
        norms = np.linalg.norm(channels, axis=-1, keepdims=True)
        return np.where(norms <= MIN_SINE, IDENTITY, channels / np.maximum(norms, MIN_SINE))
    if mode == "AXIS_ANGLE":
        norms = np.linalg.norm(channels[:, 1:], axis=-1, keepdims=True)
        axes = np.where(norms <= MIN_SINE, 0.0, channels[:, 1:] / np.maximum(norms, MIN_SINE))
        return quaternion_from_rotation_vector(channels[:, :1] * axes)
    order, columns = _moving_order(mode)
    return quaternion_from_euler(channels[:, columns], order)


def channels_from_quaternions(rotations: Array, mode: str, reference: Array) -> Array:
    """Return channels, shape (n_frames, 3 or 4), without jumps from frame to frame.

    Of the numbers that mean the same rotation, those are chosen that lie nearest to `near`,
    the channels that they replace, at the first frame; and from there on to the frame before.
    """
    if mode == "QUATERNION":
        return unroll(np.concatenate([reference[:1], rotations]))[1:]
    if mode == "AXIS_ANGLE":
        return _axis_angles(unroll(rotations), reference[0])
    order, columns = _moving_order(mode)
    angles = np.concatenate([reference[:1, columns], euler_from_quaternion(rotations, order)])
    return unwrap_euler(angles)[1:][:, np.argsort(columns)]


def _moving_order(mode: str) -> tuple[str, list[int]]:
    """Return the intrinsic order: Blender's XYZ is about fixed axes, so intrinsic Z Y X."""
    order = mode[::-1]
    return order, ["XYZ".index(axis) for axis in order]


def _axis_angles(rotations: Array, reference: Array) -> Array:
    """Angle and axis of unrolled quaternions; the axis turns smoothly and keeps its side."""
    sines = np.linalg.norm(rotations[:, 1:], axis=-1)
    rotating = sines > MIN_SINE
    axes = np.where(rotating[:, None], rotations[:, 1:], reference[1:])
    axes = np.concatenate([reference[None, 1:], axes])
    norms = np.linalg.norm(axes, axis=-1, keepdims=True)
    axes = np.where(norms > MIN_SINE, axes / np.maximum(norms, MIN_SINE), (0.0, 1.0, 0.0))
    sides = np.cumprod(np.where((axes[1:] * axes[:-1]).sum(-1) < 0.0, -1.0, 1.0))
    half = np.arctan2(sides * sines, rotations[:, 0].copy())
    angles = 2.0 * np.unwrap(half)
    angles += 2.0 * np.pi * np.round((reference[0] - angles[0]) / (2.0 * np.pi))
    return np.column_stack([angles, sides[:, None] * axes[1:]])
