"""Convert motion to channels: rotation vectors about mean rotations; the root about its
path."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ...arrays import Array
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
from .channels import CENTIMETERS, Channels
from .travel_path import TravelPath, fit_travel_path

ROOT_POSITION = "place"
"""Key of the root position relative to its path: sideways, forward, above the ground."""
ORIGIN = np.zeros(3)


class Rig(NamedTuple):
    """The encoded joints, and how their rest pose differs from the T-pose."""

    joints: list[int]
    keys: tuple[str, ...]
    parent_alignment: Array
    """From the T-pose to the rest pose, of each joint's parent, shape (n, 4)."""
    joint_alignment: Array
    """The same for the joint itself."""


def encode_motion(motion: Motion, references: Mapping[str, Array] | None = None) -> Channels:
    """Encode every joint as its rotation vector about a mean rotation, in degrees.

    The root's rotation is relative to the smooth heading of its path. Its position, in
    centimeters, is relative to the path and the ground. A walk in another direction or
    elsewhere therefore has the same channels. End sites are omitted.

    Parameters
    ----------
    motion : Motion
    references : mapping of key to array, optional
        Of another encoding. Joints of the same humanoid role use the same mean, as if they had
        the same rest pose, on any rig. Other joints use the motion's own means.
    """
    references = references or {}
    rig = _rig(motion.skeleton)
    path = _fit_path(motion)
    rotations = motion.rotations[:, rig.joints]
    rotations[:, 0] = multiply(inverse(path.rotations), rotations[:, 0])
    own_references = np.concatenate(
        [mean_rotation(rotations), rig.parent_alignment, rig.joint_alignment], axis=1
    )
    references_used = np.array([
        references.get(key, row) for key, row in zip(rig.keys, own_references, strict=True)
    ])
    before, after = _conversion_between_rigs(rig, references_used)
    converted = multiply(multiply(before, rotations), after)
    from_mean = multiply(inverse(references_used[:, :4]), converted)
    rotation_vectors = _nearest_rotation_vectors(
        rotation_vector_from_quaternion(from_mean), mean_rotation(from_mean)
    )
    root = motion.root_positions.copy()
    root[:, :2] -= path.ground_positions
    root = rotate(inverse(path.rotations), root)
    observed = np.isfinite(root).all(axis=1)
    median_root = np.median(root[observed], axis=0) if observed.any() else ORIGIN
    values = np.concatenate(
        [np.degrees(rotation_vectors), CENTIMETERS * (root - median_root)[:, None]], axis=1
    )
    references_by_key = dict(zip(rig.keys, references_used, strict=True)) | {
        ROOT_POSITION: median_root
    }
    return Channels(
        (*rig.keys, ROOT_POSITION), values, np.array([*rig.joints, 0]), references_by_key, path
    )


def _nearest_rotation_vectors(rotation_vectors: Array, mean: Array) -> Array:
    """Return the rotation vectors nearest to that of their mean, even beyond 180 degrees.

    Joints encoded about the mean of another rig may be half a turn away from it.

    Parameters
    ----------
    rotation_vectors : shape (n_frames, n_joints, 3)
    mean : shape (n_joints, 4)
    """
    mean_vector = rotation_vector_from_quaternion(mean)
    angles = np.linalg.norm(rotation_vectors, axis=-1, keepdims=True)
    opposite = rotation_vectors * (1.0 - 2.0 * np.pi / np.maximum(angles, 1e-150))
    is_farther = ((rotation_vectors - mean_vector) ** 2).sum(axis=-1) > (
        (opposite - mean_vector) ** 2
    ).sum(axis=-1)
    return np.where(is_farther[..., None], opposite, rotation_vectors)


def decode_motion(motion: Motion, channels: Channels, values: Array) -> Motion:
    """Return the motion with these channel values; inverts `encode_motion`.

    Parameters
    ----------
    motion : Motion
        The encoded motion.
    channels : Channels
    values : shape (n_frames, n_parts, 3)
    """
    rig, path = _rig(motion.skeleton), channels.path
    references_used = np.array([channels.references[key] for key in rig.keys])
    before, after = _conversion_between_rigs(rig, references_used)
    converted = multiply(
        references_used[:, :4], quaternion_from_rotation_vector(np.radians(values[:, :-1]))
    )
    local = multiply(multiply(inverse(before), converted), inverse(after))
    local[:, 0] = multiply(path.rotations, local[:, 0])
    rotations = np.where(np.isfinite(motion.rotations), motion.rotations, IDENTITY)
    rotations[:, rig.joints] = local
    roots = rotate(
        path.rotations, values[:, -1] / CENTIMETERS + channels.references[ROOT_POSITION]
    )
    roots[:, :2] += path.ground_positions
    return motion.with_poses(rotations, roots)


def _rig(skeleton: Skeleton) -> Rig:
    humanoid = find_humanoid_map(skeleton)
    alignment = t_pose_alignment(skeleton, humanoid)
    parent_alignment = np.concatenate([IDENTITY[None], alignment[list(skeleton.parents[1:])]])
    joints = [joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)]
    names = [skeleton.names[joint] for joint in joints]
    keys = tuple(humanoid.role(name) or f"joint {name}" for name in names)
    return Rig(joints, keys, parent_alignment[joints], alignment[joints])


def _conversion_between_rigs(rig: Rig, references_used: Array) -> tuple[Array, Array]:
    """Return the factors that convert local rotations to those of the references' rig.

    With B and A the alignments of parent and joint, a local rotation L of this rig is
    B^-1 L A from the T-pose (see `canonical_rotations`), and so B' B^-1 L A A'^-1 in the other.
    """
    parent_alignment, joint_alignment = references_used[:, 4:8], references_used[:, 8:12]
    return multiply(parent_alignment, inverse(rig.parent_alignment)), multiply(
        rig.joint_alignment, inverse(joint_alignment)
    )


def _fit_path(motion: Motion) -> TravelPath:
    root = motion.rotations[:, 0]
    headings = 2.0 * np.arctan2(root[:, 3], root[:, 0])
    return fit_travel_path(motion.root_positions[:, :2], headings, motion.frame_rate)
