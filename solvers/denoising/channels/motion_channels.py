"""Convert motion to channels: rotation vectors about mean rotations; the body about its
path."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Motion, find_humanoid_map, t_pose_alignment
from ...rotations import (
    IDENTITY,
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from .channels import CENTIMETERS, Channels
from .heading_joint import HeadingJoint, find_heading_joint, to_local, to_world
from .rotation_vectors import continuous_rotation_vectors
from .travel_path import fit_travel_path

BODY_POSITION = "place"
"""Key of the hips' position relative to their path: sideways, forward, above the ground."""
ORIGIN = np.zeros(3)


class EncodedJoints(NamedTuple):
    """The encoded joints, and how their rest pose differs from the T-pose."""

    joints: list[int]
    keys: tuple[str, ...]
    parent_alignment: Array
    """From the T-pose to the rest pose, of each joint's parent, shape (n, 4)."""
    joint_alignment: Array
    """The same for the joint itself."""
    heading: HeadingJoint
    heading_part: int
    """Index of the heading joint among the encoded joints."""


def encode_motion(motion: Motion, references: Mapping[str, Array] | None = None) -> Channels:
    """Encode every joint as its rotation vector about a mean rotation, in degrees.

    The rotation of the hips in the world is relative to the smooth heading of their path. Their
    position, in centimeters, is relative to the path and the ground. A walk in another
    direction or elsewhere therefore has the same channels, and a bone above the hips changes
    none of them. End sites are omitted.

    Parameters
    ----------
    motion : Motion
    references : mapping of key to array, optional
        Of another encoding. Joints of the same humanoid role use the same mean, as if they had
        the same rest pose, on any rig. Other joints use the motion's own means, and so do
        joints above the hips, which no heading is taken out of.
    """
    references = references or {}
    rig = _rig(motion)
    world, positions = to_world(motion, rig.heading)
    path = fit_travel_path(
        positions[:, :2],
        _headings(multiply(world, rig.joint_alignment[rig.heading_part])),
        motion.frame_rate,
    )
    rotations = motion.rotations[:, rig.joints]
    rotations[:, rig.heading_part] = multiply(inverse(path.rotations), world)
    own_references = np.concatenate(
        [mean_rotation(rotations), rig.parent_alignment, rig.joint_alignment], axis=1
    )
    references_used = np.array([
        row if joint in rig.heading.above else references.get(key, row)
        for joint, key, row in zip(rig.joints, rig.keys, own_references, strict=True)
    ])
    before, after = _conversion_between_rigs(rig, references_used)
    converted = multiply(multiply(before, rotations), after)
    from_mean = multiply(inverse(references_used[:, :4]), converted)
    vectors, moving_references = continuous_rotation_vectors(from_mean, motion.frame_rate)
    body = positions.copy()
    body[:, :2] -= path.ground_positions
    body = rotate(inverse(path.rotations), body)
    observed = np.isfinite(body).all(axis=1)
    median_position = np.median(body[observed], axis=0) if observed.any() else ORIGIN
    values = np.concatenate(
        [np.degrees(vectors), CENTIMETERS * (body - median_position)[:, None]], axis=1
    )
    return Channels(
        (*rig.keys, BODY_POSITION),
        values,
        np.array([*rig.joints, rig.heading.joint]),
        dict(zip(rig.keys, references_used, strict=True)) | {BODY_POSITION: median_position},
        path,
        moving_references,
        _parents(motion, rig),
    )


def decode_motion(motion: Motion, channels: Channels, values: Array) -> Motion:
    """Return the motion with these channel values; inverts `encode_motion`.

    Parameters
    ----------
    motion : Motion
        The encoded motion.
    channels : Channels
    values : shape (n_frames, n_parts, 3)
    """
    rig, path = _rig(motion), channels.path
    references_used = np.array([channels.references[key] for key in rig.keys])
    before, after = _conversion_between_rigs(rig, references_used)
    assert channels.moving_references is not None
    converted = multiply(
        multiply(references_used[:, :4], channels.moving_references),
        quaternion_from_rotation_vector(np.radians(values[:, :-1])),
    )
    decoded = multiply(multiply(inverse(before), converted), inverse(after))
    rotations = np.where(np.isfinite(motion.rotations), motion.rotations, IDENTITY)
    rotations[:, rig.joints] = decoded
    world = multiply(path.rotations, decoded[:, rig.heading_part])
    positions = rotate(
        path.rotations, values[:, -1] / CENTIMETERS + channels.references[BODY_POSITION]
    )
    positions[:, :2] += path.ground_positions
    posed = motion.with_poses(rotations)
    rotations[:, rig.heading.joint], root_positions = to_local(
        posed, rig.heading, world, positions
    )
    return motion.with_poses(rotations, root_positions)


def _rig(motion: Motion) -> EncodedJoints:
    skeleton = motion.skeleton
    humanoid = find_humanoid_map(skeleton)
    heading = find_heading_joint(motion, humanoid)
    alignment = t_pose_alignment(skeleton, humanoid)
    parent_alignment = np.concatenate([IDENTITY[None], alignment[list(skeleton.parents[1:])]])
    parent_alignment[heading.joint] = IDENTITY  # its rotations are those in the world
    joints = [joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)]
    names = [skeleton.names[joint] for joint in joints]
    keys = tuple(humanoid.role(name) or f"joint {name}" for name in names)
    return EncodedJoints(
        joints,
        keys,
        parent_alignment[joints],
        alignment[joints],
        heading,
        joints.index(heading.joint),
    )


def _parents(motion: Motion, rig: EncodedJoints) -> NDArray[np.intp]:
    """Return the part of each part's parent; the root position has none."""
    part_of = {joint: part for part, joint in enumerate(rig.joints)}
    parents = (part_of.get(motion.skeleton.parents[joint], -1) for joint in rig.joints)
    return np.array([*parents, -1])


def _conversion_between_rigs(rig: EncodedJoints, references_used: Array) -> tuple[Array, Array]:
    """Return the factors that convert local rotations to those of the references' rig.

    With B and A the alignments of parent and joint, a local rotation L of this rig is
    B^-1 L A from the T-pose (see `canonical_rotations`), and so B' B^-1 L A A'^-1 in the other.
    """
    parent_alignment, joint_alignment = references_used[:, 4:8], references_used[:, 8:12]
    return multiply(parent_alignment, inverse(rig.parent_alignment)), multiply(
        rig.joint_alignment, inverse(joint_alignment)
    )


def _headings(rotations: Array) -> Array:
    """Return the twist about Z of world rotations (n_frames, 4), radians, not unwrapped."""
    return np.asarray(2.0 * np.arctan2(rotations[:, 3].copy(), rotations[:, 0].copy()))
