"""The body that markers are fitted with, and where it has its markers in a pose."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .body_tables import JointOf, MarkerOf

Array = NDArray[np.float64]


class Poses(NamedTuple):
    """How a body stands in some frames."""

    turns: Array
    """Local rotations, shape (n_frames, n_joints, 3, 3)."""
    roots: Array
    """Shape (n_frames, 3), metres."""


class Placed(NamedTuple):
    """A body in the world."""

    frames: Array
    """Axes of all bones, shape (n_frames, n_joints, 3, 3)."""
    joints: Array
    """Shape (n_frames, n_joints, 3), metres."""
    markers: Array
    """Shape (n_frames, n_markers, 3), metres."""


@dataclass(frozen=True, eq=False)
class Body:
    """Joints with their offsets, and markers with theirs."""

    joints: tuple[JointOf, ...]
    """Parents precede children."""
    markers: tuple[MarkerOf, ...]
    offsets: Array
    """Of each joint from its parent in the T-pose, shape (n_joints, 3), metres."""
    marker_offsets: Array
    """Of each marker from its anchor in the axes of its bone, shape (n_markers, 3), metres."""

    @cached_property
    def place(self) -> dict[str, int]:
        """Index of each joint by its name."""
        return {joint.name: index for index, joint in enumerate(self.joints)}

    @cached_property
    def parents(self) -> tuple[int, ...]:
        """Index of each joint's parent; -1 for the first."""
        return tuple(self.place.get(joint.parent, -1) for joint in self.joints)

    @cached_property
    def turning(self) -> NDArray[np.intp]:
        """Joints whose rotations are sought."""
        return np.flatnonzero([joint.turns for joint in self.joints])

    @cached_property
    def bones(self) -> NDArray[np.intp]:
        """The bone of each marker."""
        return np.array([self.place[marker.bone] for marker in self.markers])

    @cached_property
    def anchors(self) -> NDArray[np.intp]:
        """The joint from which each marker is placed."""
        return np.array([self.place[marker.anchor] for marker in self.markers])

    @cached_property
    def noise(self) -> Array:
        """Of each marker, metres."""
        return np.array([marker.noise for marker in self.markers])

    def path(self, joint: int) -> list[int]:
        """Return the joint and all above it."""
        found = []
        while joint >= 0:
            found.append(joint)
            joint = self.parents[joint]
        return found

    def place_in(self, poses: Poses) -> Placed:
        """Forward kinematics of joints and markers."""
        frames, joints = np.empty_like(poses.turns), np.empty(poses.turns.shape[:-1])
        frames[:, 0], joints[:, 0] = poses.turns[:, 0], poses.roots
        for joint, parent in enumerate(self.parents[1:], start=1):
            frames[:, joint] = frames[:, parent] @ poses.turns[:, joint]
            joints[:, joint] = joints[:, parent] + frames[:, parent] @ self.offsets[joint]
        arms = np.einsum("fmij,mj->fmi", frames[:, self.bones], self.marker_offsets)
        return Placed(frames, joints, joints[:, self.anchors] + arms)

    def with_offsets(self, offsets: Array, marker_offsets: Array) -> "Body":
        """Return a body of the same build and other measures."""
        return replace(self, offsets=offsets, marker_offsets=marker_offsets)


def local_turns(frames: Mapping[str, Array], joints: Sequence[JointOf], n_frames: int) -> Array:
    """Return local rotations, shape (n_frames, n_joints, 3, 3), from the axes of bones.

    A joint whose axes are not given, or not known in a frame, goes with its parent.
    """
    world: dict[str, Array] = {"": np.broadcast_to(np.eye(3), (n_frames, 3, 3))}
    turns = np.empty((n_frames, len(joints), 3, 3))
    for index, joint in enumerate(joints):
        above = world[joint.parent]
        own = frames.get(joint.name, above)
        known = np.isfinite(own).all(axis=(-1, -2), keepdims=True)
        world[joint.name] = np.where(known, own, above)
        turns[:, index] = np.swapaxes(above, -1, -2) @ world[joint.name]
    return turns
