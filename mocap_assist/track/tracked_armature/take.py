"""Convert a tracked armature's action to a motion of the body, and back."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import bpy
import numpy as np
from mathutils import Matrix

from ....solvers.arrays import Array
from ....solvers.depth_tracking.body import JOINTS, SEGMENTS, body_skeleton
from ....solvers.errors import InvalidMotionError
from ....solvers.motion import Motion
from ...actions.bone_channels import animated_curves, read_bone, rotation_curves
from ...actions.curves import Channel
from ...actions.frames import MAX_GRID_OFFSET_STEPS, Grid
from ...actions.take import ArmatureTake, BoneChannels, TakePart, part_of
from ...blender.block_references import BlockReference, SourceReference
from ...blender.compat import Source
from ...blender.time_slices import Sliced, Steps, should_yield
from ...scene.rig import Placement, Rig, placement_of, read_rig
from .body import TrackedBody, armature_from_motion, bones_of
from .checks import check_keyed, check_posed

IDENTITY = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class TrackedTake:
    """An action sampled at the times of the depth images, in the space of the tracking."""

    tracked: TrackedBody
    bones: dict[str, str]
    """The bone of each joint of the body."""
    first: int
    """Index of the depth image of the first frame."""
    frames: Array
    """Scene frames, shape (n_frames,)."""
    rig: Rig
    channels: tuple[BoneChannels, ...]
    space: Placement
    """From the armature's space to the motion's; one row."""
    rate: float

    @property
    def motion(self) -> Motion:
        """Motion of the body; hands and toes, which do not rotate, are at rest."""
        return self._of_body(self._part(self.channels, len(self.frames)))

    def pose(self, armature: bpy.types.Object) -> Motion:
        """Return the current pose of the armature, keyed or not, as one frame.

        Raises InvalidMotionError if it differs from the visible pose; see `check_posed`.
        """
        bpy.context.view_layer.update()
        bones = [armature.pose.bones[name] for name in self.rig.bones]
        channels = tuple(
            BoneChannels(
                np.array([bone.matrix_basis.to_quaternion()], dtype=np.float64),
                np.array([bone.matrix_basis.translation], dtype=np.float64),
                False,
                False,
            )
            for bone in bones
        )
        pose = self._of_body(self._part(channels, 1))
        check_posed(armature, self.tracked, pose)
        return pose

    def with_motion(self, motion: Motion, first: int, last: int) -> ArmatureTake:
        """Return frames of a motion of the body for `write_take`."""
        rows = slice(first, last + 1)
        part = self._part(self.channels, len(self.frames))
        joints = self._joints(part)
        rotations = np.array(part.motion.rotations[rows])
        rotations[:, joints] = motion.rotations[rows, : len(SEGMENTS)]
        segment = replace(
            part.motion, rotations=rotations, root_positions=motion.root_positions[rows]
        )
        carrier = self._carrier(last + 1 - first)
        frames = self.frames[rows]
        grid = Grid(frames, self.tracked.shown.step, (True, True))
        parts = (TakePart(segment, part.bones, carrier),)
        return ArmatureTake(self.rig, grid, parts, None, self.channels, self.space)

    def _part(self, channels: tuple[BoneChannels, ...], n_frames: int) -> TakePart:
        root = self.rig.bones.index(self.bones["hips"])
        bones, carrier = self.rig.subtree(root), self._carrier(n_frames)
        return part_of(self.rig, bones, channels, carrier, self.space, self.rate)

    def _carrier(self, n_frames: int) -> Placement:
        rotations, positions = (
            np.tile(each, (n_frames, 1)) for each in (self.space.rotations, self.space.origins)
        )
        return Placement(rotations, positions, self.space.scale)

    def _joints(self, part: TakePart) -> list[int]:
        """Return the index of each of the `SEGMENTS` among the joints of a part."""
        owners = [self.rig.bones[bone] if bone >= 0 else "" for bone in part.bones]
        return [owners.index(self.bones[name]) for name in SEGMENTS]

    def _of_body(self, part: TakePart) -> Motion:
        motion = part.motion
        rotations = np.tile(IDENTITY, (motion.n_frames, len(JOINTS), 1))
        rotations[:, : len(SEGMENTS)] = motion.rotations[:, self._joints(part)]
        skeleton = body_skeleton(self.tracked.body)
        return Motion(skeleton, rotations, motion.root_positions, self.rate)


@Sliced
def read_tracked_take(
    armature: bpy.types.Object, source: Source, n_images: int, rate: float
) -> Steps[TrackedTake]:
    """Read an action of a tracked armature at the times of the depth images.

    Raises
    ------
    InvalidMotionError
        The armature stores no body, its bones have changed or have no keys, or the keys of the
        hips are outside the recording.
    """
    tracked = TrackedBody.read(armature)
    bones, rig = bones_of(armature), read_rig(armature)
    if rig.parents[rig.bones.index(bones["hips"])] >= 0:
        raise InvalidMotionError(
            f"{bones['hips']} has a parent bone now. Clear its parent, then track again."
        )
    curves = animated_curves(*source)
    check_keyed(armature, curves)
    keyed = rotation_curves(armature.pose.bones[bones["hips"]], curves).values()
    frames, first = _sample_times(keyed, tracked, n_images, source[0].name)
    references, channels = (BlockReference.of(armature), SourceReference.of(source)), []
    for number, bone in enumerate(rig.bones):
        channels.append(read_bone(armature.pose.bones[bone], curves, frames, gaps=False))
        if should_yield():
            yield number / len(rig.bones)
            armature, source = (each.find() for each in references)
            curves = animated_curves(*source)
            bones_of(armature)  # raises if one was deleted meanwhile
    motion_from_armature = np.linalg.inv(armature_from_motion(armature, tracked.body))
    rotation, origin, scale = placement_of(Matrix(motion_from_armature.tolist()), armature.name)
    space = Placement(rotation[np.newaxis], origin[np.newaxis], scale)
    return TrackedTake(tracked, bones, first, frames, rig, tuple(channels), space, rate)


def _sample_times(
    keyed: Iterable[Channel], tracked: TrackedBody, n_images: int, name: str
) -> tuple[Array, int]:
    """Return the frames of the images that these curves cover, and the first image."""
    shown = tracked.shown
    ends = np.concatenate([channel.keys[[0, -1], 0] for channel in keyed])
    start, stop = ((frame - shown.start) / shown.step for frame in (ends.min(), ends.max()))
    first = max(int(np.ceil(start - MAX_GRID_OFFSET_STEPS)), 0)
    last = min(int(np.floor(stop + MAX_GRID_OFFSET_STEPS)), n_images - 1)
    if last < first:
        raise InvalidMotionError(
            f"{name} has no keys within the recording. Move its keys back to their original"
            " frames."
        )
    return shown.start + shown.step * np.arange(first, last + 1), first
