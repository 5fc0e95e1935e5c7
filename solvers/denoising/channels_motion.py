"""Motion as channels: rotation vectors about mean rotations; the root relative to its path."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion
from ..motion.rotations import (
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from .channels import CENTIMETRES, Channels
from .channels_path import Path, smooth_path

Array = NDArray[np.float64]

PLACE = "place"
"""Key of the root's position relative to its path: right of it, behind it, above ground."""


def encode_motion(motion: Motion, references: Mapping[str, Array] | None = None) -> Channels:
    """Tell every joint by its rotation vector about a mean rotation, in degrees.

    The root's rotation is told relative to the smooth heading of its path, and its position,
    in centimetres, relative to the path and the ground: a walk in another direction or at
    another place has the same channels. End sites are left out.

    Parameters
    ----------
    motion : Motion
    references : mapping of key to array, optional
        Means to use where the key is known; elsewhere, the motion's own.
    """
    references = references or {}
    skeleton = motion.skeleton
    path = motion_path(motion)
    joints = [joint for joint in range(motion.n_joints) if not skeleton.is_end_site(joint)]
    keys = (*(skeleton.names[joint] for joint in joints), PLACE)
    rotations = motion.rotations[:, joints]
    rotations[:, 0] = multiply(inverse(path.turns), rotations[:, 0])
    own = mean_rotation(rotations)
    means = np.array([references.get(key, mean) for key, mean in zip(keys, own, strict=False)])
    vectors = rotation_vector_from_quaternion(multiply(inverse(means), rotations))
    place = _relative_place(motion, path)
    middle = np.median(place[np.isfinite(place).all(axis=1)], axis=0) if _any(place) else 0.0
    anchor = np.asarray(references.get(PLACE, np.zeros(3) + middle))[:3]
    values = np.concatenate(
        [np.degrees(vectors), CENTIMETRES * (place - anchor)[:, None]], axis=1
    )
    used = {**dict(zip(keys, means, strict=False)), PLACE: anchor}
    return Channels(motion, keys, values, np.array([*joints, 0]), used, path)


def decode_motion(motion: Motion, channels: Channels, values: Array) -> Motion:
    """Return the motion that has these channel values; undoes `encode_motion`.

    Parameters
    ----------
    motion : Motion
        What was encoded.
    channels : Channels
    values : shape (n_frames, n_parts, 3)
    """
    path = channels.path
    means = np.array([channels.references[key] for key in channels.keys[:-1]])
    local = multiply(means, quaternion_from_rotation_vector(np.radians(values[:, :-1])))
    local[:, 0] = multiply(path.turns, local[:, 0])
    rotations = motion.rotations.copy()
    ends = [joint for joint in range(motion.n_joints) if motion.skeleton.is_end_site(joint)]
    rotations[:, ends] = np.where(
        np.isfinite(rotations[:, ends]), rotations[:, ends], (1.0, 0.0, 0.0, 0.0)
    )
    rotations[:, channels.joints[:-1]] = local
    place = values[:, -1] / CENTIMETRES + channels.references[PLACE]
    roots = rotate(path.turns, place)
    roots[:, :2] += path.places
    return motion.with_poses(rotations, roots)


def motion_path(motion: Motion) -> Path:
    """Return the smooth path of the root; its heading is the root's turn about Z."""
    root = motion.rotations[:, 0]
    headings = 2.0 * np.arctan2(root[:, 3], root[:, 0])
    return smooth_path(motion.root_positions[:, :2], headings, motion.frame_rate)


def _relative_place(motion: Motion, path: Path) -> Array:
    place = motion.root_positions.copy()
    place[:, :2] -= path.places
    return rotate(inverse(path.turns), place)


def _any(values: Array) -> bool:
    return bool(np.isfinite(values).all(axis=1).any())
