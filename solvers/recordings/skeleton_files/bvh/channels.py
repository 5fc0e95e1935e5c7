"""Convert the channels of a BVH file to the motion of rigid bones."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....motion import Motion, Skeleton
from ....progress import Progress
from ....rotations import inverse, multiply, quaternion_from_euler, rotate, rotation_between
from ...conventions import (
    file_conventions,
    rotations_z_up_from_y_up,
    unit_of_skeleton,
    z_up_from_y_up,
)
from .hierarchy import BvhJoint

FRAMES_AT_ONCE = 2000


class BvhPoses(NamedTuple):
    """Rigid bones and their motion, in units of the file."""

    offsets: NDArray[np.float64]
    """Shape (n_joints, 3), Y up."""
    rotations: NDArray[np.float64]
    """Local quaternions in our axes, shape (n_frames, n_joints, 4)."""
    root: NDArray[np.float64]
    """Positions of the root in our axes, shape (n_frames, 3)."""
    offset_added: bool = False
    """Whether position channels were added to the OFFSET."""


class BvhChannels:
    """The recorded channels of a BVH file, in its axes and units.

    Parameters
    ----------
    joints : sequence of BvhJoint
    rows : float array, shape (n_frames, n_channels)
        Degrees and units of the file; NaN where missing.
    """

    def __init__(self, joints: Sequence[BvhJoint], rows: NDArray[np.float64]) -> None:
        self.joints = joints
        self.rows = rows
        self.file_offsets = np.array([joint.offset for joint in joints])
        first = np.cumsum([0, *(len(joint.channels) for joint in joints)])
        self.columns = [
            {channel: int(start) + index for index, channel in enumerate(joint.channels)}
            for joint, start in zip(joints, first, strict=False)
        ]

    def poses(self, progress: Progress) -> BvhPoses:
        """Return rigid bones and their motion, as `read_bvh` describes them."""
        rotations = self._rotations(progress)
        offsets = self.file_offsets.copy()
        for joint in range(1, len(offsets)):
            offsets[joint] = _median_position(
                self._relative_positions(joint, self.offset_added)
            )
        root = z_up_from_y_up(self._relative_positions(0, self.offset_added))
        root = np.broadcast_to(root, (len(self.rows), 3))
        rotation = rotations[:, 0]
        for joint in self.trunk:
            displacement = self._relative_positions(joint, self.offset_added) - offsets[joint]
            root = root + rotate(rotation, z_up_from_y_up(displacement))
            rotation = multiply(rotation, rotations[:, joint])
        self._rotate_toward_only_children(rotations, offsets)
        return BvhPoses(offsets, rotations, root, self.offset_added)

    @cached_property
    def offset_added(self) -> bool:
        """Whether position channels are relative to the OFFSET instead of the parent.

        That is rarer. Each joint of the body has one vote: its
        channels are nearer to zero than to its OFFSET, or not. The root and the joints below
        it that carry the body travel, and vote only where no other joint has channels; of the
        root only the height counts.
        """
        voters = [joint for joint in range(1, len(self.joints)) if joint not in self.trunk]
        votes = sum(map(self._vote_for_offset, voters))
        if not votes:
            votes = sum(map(self._vote_for_offset, self.trunk)) or self._vote_for_offset(0)
        return votes > 0

    def _vote_for_offset(self, joint: int) -> int:
        """Return the vote of a joint (`vote_for_offset`); 0 where it has no channels."""
        observed = np.array([f"{axis}position" in self.columns[joint] for axis in "xyz"])
        observed &= (True, True, True) if joint else (False, True, False)
        return vote_for_offset(
            observed * self.file_offsets[joint],
            observed * _median_position(self._relative_positions(joint)),
        )

    def _relative_positions(
        self, joint: int, offset_added: bool = False
    ) -> NDArray[np.float64]:
        """Return the position of a joint relative to its parent, shape (n_frames, 3).

        Without position channels a single row represents all frames.
        """
        columns = self.columns[joint]
        moves = any(channel.endswith("position") for channel in columns)
        positions = np.tile(self.file_offsets[joint], (len(self.rows) if moves else 1, 1))
        for axis, name in enumerate("xyz"):
            if (column := columns.get(f"{name}position")) is not None:
                positions[:, axis] = self.rows[:, column] + (
                    positions[:, axis] if offset_added else 0.0
                )
        return positions

    def _rotations(self, progress: Progress) -> NDArray[np.float64]:
        """Return local quaternions in our axes, shape (n_frames, n_joints, 4).

        Joints with the same rotation order are converted together, in blocks of frames, which
        is fast and needs little memory.
        """
        groups: dict[str, tuple[list[int], list[list[int]]]] = {}
        for joint, columns in enumerate(self.columns):
            rotation_channels = [channel for channel in columns if channel.endswith("rotation")]
            order = "".join(channel[0].upper() for channel in rotation_channels)
            members, angles = groups.setdefault(order, ([], []))
            members.append(joint)
            angles.append([columns[channel] for channel in rotation_channels])
        groups.pop("", None)
        rotations = np.zeros((len(self.rows), len(self.joints), 4))
        rotations[..., 0] = 1.0
        for start in range(0, len(self.rows), FRAMES_AT_ONCE):
            block = slice(start, start + FRAMES_AT_ONCE)
            for order, (members, angles) in groups.items():
                block_rotations = quaternion_from_euler(
                    np.radians(self.rows[block][:, angles]), order
                )
                block_rotations[np.isnan(block_rotations).any(axis=-1)] = np.nan
                rotations[block, members] = rotations_z_up_from_y_up(block_rotations)
            progress(min(1.0, block.stop / len(self.rows)), "Reading")
        return rotations

    def _rotate_toward_only_children(
        self, rotations: NDArray[np.float64], offsets: NDArray[np.float64]
    ) -> None:
        """Change rotations so that joints with recorded positions keep their direction.

        Files of Perception Neuron place a foot up to 10 cm off the end of its shank, at the
        right distance. The rotation that moves it there is added to the shank and removed from
        the foot.
        """
        for joint, children in enumerate(self.children):
            if len(children) != 1 or children[0] in self.trunk:
                continue
            positions = self._relative_positions(children[0], self.offset_added)
            if len(positions) == 1:
                continue
            positions[~np.isfinite(positions).all(axis=1)] = offsets[children[0]]
            swing = rotations_z_up_from_y_up(rotation_between(offsets[children[0]], positions))
            rotations[:, joint] = multiply(rotations[:, joint], swing)
            rotations[:, children[0]] = multiply(inverse(swing), rotations[:, children[0]])

    @cached_property
    def children(self) -> list[list[int]]:
        """Children of each joint, without end sites."""
        children: list[list[int]] = [[] for _ in self.joints]
        for index, joint in enumerate(self.joints):
            if index and joint.channels:
                children[joint.parent].append(index)
        return children

    @cached_property
    def trunk(self) -> dict[int, None]:
        """Joints from the root down to the first branch of the skeleton, in this order."""
        trunk: dict[int, None] = {}
        joint = 0
        while len(self.children[joint]) == 1:
            joint = self.children[joint][0]
            trunk[joint] = None
        return trunk


def vote_for_offset(offset: NDArray[np.float64], median: NDArray[np.float64]) -> int:
    """Return 1 if a median position, (3,), is nearer to zero than to an OFFSET, -1 if farther.

    Return 0 where both are as near.
    """
    length = float(offset @ offset)
    return int(np.sign(length / 2 - median @ offset)) if length > 0.0 else 0


def motion_from_poses(
    joints: Sequence[BvhJoint],
    poses: BvhPoses,
    frame_rate: float,
    scale: float | None,
    progress: Progress,
) -> Motion:
    """Return the motion in meters as `read_bvh` describes it, with Y of the file up."""
    parents = tuple(joint.parent for joint in joints)
    names = tuple(joint.name for joint in joints)
    skeleton = Skeleton(names, parents, z_up_from_y_up(poses.offsets))
    if scale is None:
        scale = unit_of_skeleton(skeleton, progress)
    skeleton = replace(skeleton, offsets=scale * skeleton.offsets)
    noted = replace(file_conventions("Y", unit=scale), offset_added=poses.offset_added)
    return Motion(skeleton, poses.rotations, scale * poses.root, frame_rate, noted)


def _median_position(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the median, shape (3,), over frames with a position; zero if there are none."""
    observed = positions[np.isfinite(positions).all(axis=1)]
    return np.median(observed, axis=0) if len(observed) else np.zeros(3)
