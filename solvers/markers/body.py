"""Body model with joints and markers, and its forward kinematics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .body_tables import JointPrior, MarkerPrior


class Poses(NamedTuple):
    """Poses of a body over frames."""

    rotations: Array
    """Local rotations, shape (n_frames, n_joints, 3, 3)."""
    roots: Array
    """Positions of the root, shape (n_frames, 3), meters."""


class WorldBody(NamedTuple):
    """A body in world space."""

    frames: Array
    """Axes of all bones, shape (n_frames, n_joints, 3, 3)."""
    joints: Array
    """Shape (n_frames, n_joints, 3), meters."""
    markers: Array
    """Shape (n_frames, n_markers, 3), meters."""


@dataclass(frozen=True, eq=False)
class MarkerBody:
    """Joints and markers with their offsets."""

    joints: tuple[JointPrior, ...]
    """Parents precede children."""
    markers: tuple[MarkerPrior, ...]
    offsets: Array
    """Offset of each joint from its parent in the T-pose, shape (n_joints, 3), meters."""
    marker_offsets: Array
    """Offset of each marker from its anchor in bone axes, shape (n_markers, 3), meters."""

    @cached_property
    def index(self) -> dict[str, int]:
        """Index of each joint by its name."""
        return {joint.name: index for index, joint in enumerate(self.joints)}

    @cached_property
    def parents(self) -> tuple[int, ...]:
        """Index of each joint's parent; -1 for the first."""
        return tuple(self.index.get(joint.parent, -1) for joint in self.joints)

    @cached_property
    def rotating_joints(self) -> NDArray[np.intp]:
        """Joints whose rotations are fitted."""
        return np.flatnonzero([joint.rotates for joint in self.joints])

    @cached_property
    def bones(self) -> NDArray[np.intp]:
        """Index of the bone of each marker."""
        return np.array([self.index[marker.bone] for marker in self.markers])

    @cached_property
    def anchors(self) -> NDArray[np.intp]:
        """Index of the joint from which each marker has its offset."""
        return np.array([self.index[marker.anchor] for marker in self.markers])

    @cached_property
    def noise(self) -> Array:
        """Standard deviation of each marker on its bone, meters."""
        return np.array([marker.noise for marker in self.markers])

    def path(self, joint: int) -> list[int]:
        """Return the joint and all its ancestors."""
        path_to_root = []
        while joint >= 0:
            path_to_root.append(joint)
            joint = self.parents[joint]
        return path_to_root

    def body_in_pose(self, poses: Poses) -> WorldBody:
        """Return the world positions of joints and markers (forward kinematics)."""
        frames, joints = np.empty_like(poses.rotations), np.empty(poses.rotations.shape[:-1])
        frames[:, 0], joints[:, 0] = poses.rotations[:, 0], poses.roots
        for joint, parent in enumerate(self.parents[1:], start=1):
            frames[:, joint] = frames[:, parent] @ poses.rotations[:, joint]
            joints[:, joint] = joints[:, parent] + frames[:, parent] @ self.offsets[joint]
        arms = np.einsum("fmij,mj->fmi", frames[:, self.bones], self.marker_offsets)
        return WorldBody(frames, joints, joints[:, self.anchors] + arms)

    def with_offsets(self, offsets: Array, marker_offsets: Array) -> "MarkerBody":
        """Return the body with other offsets."""
        return replace(self, offsets=offsets, marker_offsets=marker_offsets)


def local_rotations(
    frames: Mapping[str, Array], joints: Sequence[JointPrior], n_frames: int
) -> Array:
    """Return local rotations, shape (n_frames, n_joints, 3, 3), from the axes of bones.

    A joint without axes, or with missing axes in a frame, follows its parent.
    """
    world: dict[str, Array] = {"": np.broadcast_to(np.eye(3), (n_frames, 3, 3))}
    rotations = np.empty((n_frames, len(joints), 3, 3))
    for index, joint in enumerate(joints):
        parent_axes = world[joint.parent]
        axes = frames.get(joint.name, parent_axes)
        valid = np.isfinite(axes).all(axis=(-1, -2), keepdims=True)
        world[joint.name] = np.where(valid, axes, parent_axes)
        rotations[:, index] = np.swapaxes(parent_axes, -1, -2) @ world[joint.name]
    return rotations
