"""Motion as channels: rotation vectors about mean rotations; the root relative to its path."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion import Motion, Skeleton, find_humanoid_map, t_pose_alignment
from ...rotations import (
    IDENTITY,
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from .channels import CENTIMETRES, Channels
from .travel_path import Path, smooth_path

Array = NDArray[np.float64]

PLACE = "place"
"""Key of the root's position relative to its path: beside it, along it, above the ground."""
NOWHERE = np.zeros(3)


class Rig(NamedTuple):
    """The joints that are encoded, and how their rest pose differs from the T-pose."""

    joints: list[int]
    keys: tuple[str, ...]
    above: Array
    """From the T-pose to the rest pose, of each joint's parent, shape (n, 4)."""
    own: Array
    """The same of the joint itself."""


def encode_motion(motion: Motion, references: Mapping[str, Array] | None = None) -> Channels:
    """Tell every joint by its rotation vector about a mean rotation, in degrees.

    The root's rotation is told relative to the smooth heading of its path, and its position,
    in centimetres, relative to the path and the ground: a walk in another direction or at
    another place has the same channels. End sites are left out.

    Parameters
    ----------
    motion : Motion
    references : mapping of key to array, optional
        Of another encoding. Joints of the same humanoid role are told about the same mean, as
        if they rested in the same pose, whatever the rig; joints without one, or unheard of,
        are told about the motion's own means.
    """
    references = references or {}
    rig = _rig(motion.skeleton)
    path = _path(motion)
    rotations = motion.rotations[:, rig.joints]
    rotations[:, 0] = multiply(inverse(path.turns), rotations[:, 0])
    own = np.concatenate([mean_rotation(rotations), rig.above, rig.own], axis=1)
    told = np.array([references.get(key, row) for key, row in zip(rig.keys, own, strict=True)])
    before, after = _changes(rig, told)
    moved = multiply(multiply(before, rotations), after)
    turned = multiply(inverse(told[:, :4]), moved)
    vectors = _unwrapped(rotation_vector_from_quaternion(turned), mean_rotation(turned))
    place = motion.root_positions.copy()
    place[:, :2] -= path.places
    place = rotate(inverse(path.turns), place)
    known = np.isfinite(place).all(axis=1)
    middle = np.median(place[known], axis=0) if known.any() else NOWHERE
    values = np.concatenate(
        [np.degrees(vectors), CENTIMETRES * (place - middle)[:, None]], axis=1
    )
    used = dict(zip(rig.keys, told, strict=True)) | {PLACE: middle}
    return Channels((*rig.keys, PLACE), values, np.array([*rig.joints, 0]), used, path)


def _unwrapped(vectors: Array, mean: Array) -> Array:
    """Tell turns by the rotation vector nearer to their mean's, even beyond 180 degrees.

    Joints that are told about the mean of another rig may lie half a turn from it.

    Parameters
    ----------
    vectors : shape (n_frames, n_joints, 3)
    mean : shape (n_joints, 4)
    """
    centre = rotation_vector_from_quaternion(mean)
    angles = np.linalg.norm(vectors, axis=-1, keepdims=True)
    other = vectors * (1.0 - 2.0 * np.pi / np.maximum(angles, 1e-150))
    farther = ((vectors - centre) ** 2).sum(axis=-1) > ((other - centre) ** 2).sum(axis=-1)
    return np.where(farther[..., None], other, vectors)


def decode_motion(motion: Motion, channels: Channels, values: Array) -> Motion:
    """Return the motion that has these channel values; undoes `encode_motion`.

    Parameters
    ----------
    motion : Motion
        What was encoded.
    channels : Channels
    values : shape (n_frames, n_parts, 3)
    """
    rig, path = _rig(motion.skeleton), channels.path
    told = np.array([channels.references[key] for key in rig.keys])
    before, after = _changes(rig, told)
    moved = multiply(told[:, :4], quaternion_from_rotation_vector(np.radians(values[:, :-1])))
    local = multiply(multiply(inverse(before), moved), inverse(after))
    local[:, 0] = multiply(path.turns, local[:, 0])
    rotations = np.where(np.isfinite(motion.rotations), motion.rotations, IDENTITY)
    rotations[:, rig.joints] = local
    roots = rotate(path.turns, values[:, -1] / CENTIMETRES + channels.references[PLACE])
    roots[:, :2] += path.places
    return motion.with_poses(rotations, roots)


def _rig(skeleton: Skeleton) -> Rig:
    humanoid = find_humanoid_map(skeleton)
    alignment = t_pose_alignment(skeleton, humanoid)
    above = np.concatenate([IDENTITY[None], alignment[list(skeleton.parents[1:])]])
    joints = [joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)]
    names = [skeleton.names[joint] for joint in joints]
    keys = tuple(humanoid.role(name) or f"joint {name}" for name in names)
    return Rig(joints, keys, above[joints], alignment[joints])


def _changes(rig: Rig, told: Array) -> tuple[Array, Array]:
    """Return what turns local rotations into those of the rig that the references are of.

    With B and A the alignments of parent and joint, a local rotation L of this rig is
    B^-1 L A from the T-pose (see `motion.canonical`), and so B' B^-1 L A A'^-1 in the other.
    """
    above, own = told[:, 4:8], told[:, 8:12]
    return multiply(above, inverse(rig.above)), multiply(rig.own, inverse(own))


def _path(motion: Motion) -> Path:
    root = motion.rotations[:, 0]
    headings = 2.0 * np.arctan2(root[:, 3], root[:, 0])
    return smooth_path(motion.root_positions[:, :2], headings, motion.frame_rate)
