"""A take: an armature's action as motions for solvers, and back."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import Motion, Skeleton, Tracks
from ...solvers.rotations import inverse, multiply, rotate
from ..blender.time_slices import Sliced, Steps, in_thread, should_yield
from ..scene.rig import Placement, Rig
from .frames import Grid


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """Channels of one bone over the frames of the take, from the action and the pose."""

    rotations: Array
    """Pose-bone rotation (Blender's basis), shape (n_frames, 4); NaN in gaps."""
    locations: Array
    """Pose-bone location, shape (n_frames, 3), in the armature's unit; NaN in gaps.

    Zero for connected bones, which ignore theirs.
    """
    rotation_keyed: bool
    location_keyed: bool

    @cached_property
    def travels(self) -> bool:
        """Whether its location is keyed and does change."""
        known = self.locations[np.isfinite(self.locations).all(axis=1)]
        return self.location_keyed and bool((known != known[:1]).any())


@dataclass(frozen=True, eq=False)
class TakePart:
    """One tree of bones as a Motion; its root may have parents outside the tree."""

    motion: Motion
    bones: tuple[int, ...]
    """Rig bone of each joint; -1 for end sites."""
    carrier: Placement
    """Armature space, moved by the bones above the root as it is at each frame."""


@dataclass(frozen=True, eq=False)
class ArmatureTake:
    """Data of a take in the form that solvers use.

    `parts[0]` is the body: the tree of hips, spine and limbs, in the world. Further trees, such
    as props and IK controls, follow, each in the space in which its parent rests. `offsets`
    are the locations of bones inside the trees, in their parents' rest axes, meters.
    """

    rig: Rig
    grid: Grid
    parts: tuple[TakePart, ...]
    offsets: Tracks | None
    channels: tuple[BoneChannels, ...]
    rest: Placement

    @property
    def frames(self) -> Array:
        """Scene frames, shape (n_frames,)."""
        return self.grid.frames

    @property
    def recordings(self) -> tuple[Motion | Tracks, ...]:
        """Everything to be solved, the body first."""
        motions = tuple(part.motion for part in self.parts)
        return motions if self.offsets is None else (*motions, self.offsets)

    def with_recordings(self, recordings: tuple[Motion | Tracks, ...]) -> "ArmatureTake":
        """Return the take with its motions replaced."""
        motions = [each for each in recordings if isinstance(each, Motion)]
        parts = tuple(
            replace(part, motion=motion)
            for part, motion in zip(self.parts, motions, strict=True)
        )
        offsets = [each for each in recordings if isinstance(each, Tracks)]
        return replace(self, parts=parts, offsets=None if self.offsets is None else offsets[0])

    def bone_poses(self) -> "BonePoses":
        """Return the rotations and locations of all bones that have them."""
        return BonePoses(self.bone_rotations(), self.bone_locations())

    def bone_rotations(self) -> dict[int, Array]:
        """Return the pose-bone rotation, shape (n_frames, 4), of every bone in a part."""
        found: dict[int, Array] = {}
        for part in self.parts:
            found |= basis_rotations(part, self.rig, self.rest)
        return found

    def bone_locations(self) -> dict[int, Array]:
        """Return the pose-bone location, shape (n_frames, 3), of every bone that has one."""
        found = {}
        for part in self.parts:
            found[part.bones[0]] = root_locations(part, self.rig)
        if self.offsets is not None:
            for index, name in enumerate(self.offsets.names):
                bone = self.rig.bones.index(name)
                axes = multiply(self.rest.rotations[0], self.rig.rest_rotations[bone])
                shift = self.offsets.positions[:, index] / self.rest.scale
                found[bone] = rotate(inverse(axes), shift)
        return found


class BonePoses(NamedTuple):
    """Pose-bone channels at each frame, by index of the bone in the rig."""

    rotations: dict[int, Array]
    """Quaternions, shape (n_frames, 4)."""
    locations: dict[int, Array]
    """Shape (n_frames, 3), in units of the rig."""


@Sliced
def part_of(
    rig: Rig,
    bones: list[int],
    channels: tuple[BoneChannels, ...],
    carrier: Placement,
    rest: Placement,
    frame_rate: float,
) -> Steps[TakePart]:
    """Turn pose-bone channels into local rotations about world axes, L = A B A^-1.

    A is the rest orientation of the bone in the world. No forward kinematics is needed, since
    a joint's local rotation and Blender's basis are one rotation about different axes.
    The root's rotation is then carried into the world. Constant location keys of the other
    bones are part of the skeleton.
    """
    world = multiply(rest.rotations[0], rig.rest_rotations)
    rotations = []
    for number, bone in enumerate(bones):
        rotation = multiply(
            multiply(world[bone], channels[bone].rotations), inverse(world[bone])
        )
        rotations.append(rotation)
        if should_yield():
            yield 0.7 + 0.3 * number / len(bones)
    build = partial(
        _assemble_part, rig, bones, channels, carrier, rest, frame_rate, world, rotations
    )
    return (yield from in_thread.steps(build))


def _assemble_part(
    rig: Rig,
    bones: list[int],
    channels: tuple[BoneChannels, ...],
    carrier: Placement,
    rest: Placement,
    frame_rate: float,
    world: Array,
    rotations: list[Array],
) -> TakePart:
    """Return the part whose bones have these rotations; the root's is carried to the world."""
    carried = multiply(carrier.rotations, inverse(rest.rotations[0]))
    rotations = [multiply(carried, rotations[0]), *rotations[1:]]
    root = bones[0]
    moved = rotate(rig.rest_rotations[root], channels[root].locations)
    positions = carrier.points(rig.heads[root] + moved)
    skeleton, owners = skeleton_of(rig, bones, rest)
    skeleton = _with_keyed_lengths(skeleton, owners, channels, rest.scale, world)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (len(positions), 1))
    rotations += [still] * (len(owners) - len(bones))
    motion = Motion(skeleton, np.stack(rotations, axis=1), positions, frame_rate)
    return TakePart(motion, owners, carrier)


def _with_keyed_lengths(
    skeleton: Skeleton,
    owners: tuple[int, ...],
    channels: tuple[BoneChannels, ...],
    scale: float,
    world: Array,
) -> Skeleton:
    """Return a skeleton with the constant location keys of its bones, but the root's."""
    offsets = skeleton.offsets.copy()
    for joint, bone in enumerate(owners):
        if joint == 0 or bone < 0 or not channels[bone].location_keyed:
            continue
        if not channels[bone].travels:
            location = np.nan_to_num(channels[bone].locations[:1])
            offsets[joint] += scale * rotate(world[bone], location)[0]
    if (offsets == skeleton.offsets).all():
        return skeleton
    return Skeleton(skeleton.names, skeleton.parents, offsets)


def basis_rotations(part: TakePart, rig: Rig, rest: Placement) -> dict[int, Array]:
    """Undo `part_of`: the pose-bone rotation, shape (n_frames, 4), of each bone."""
    local = np.array(part.motion.rotations)
    carried = multiply(part.carrier.rotations, inverse(rest.rotations[0]))
    local[:, 0] = multiply(inverse(carried), local[:, 0])
    world = multiply(rest.rotations[0], rig.rest_rotations)
    return {
        bone: multiply(multiply(inverse(world[bone]), local[:, joint]), world[bone])
        for joint, bone in enumerate(part.bones)
        if bone >= 0
    }


def root_locations(part: TakePart, rig: Rig) -> Array:
    """Undo `part_of`: the pose-bone location, shape (n_frames, 3), of the part's root."""
    root = part.bones[0]
    moved = part.carrier.points_back(part.motion.root_positions) - rig.heads[root]
    return rotate(inverse(rig.rest_rotations[root]), moved)


def skeleton_of(
    rig: Rig, bones: list[int], rest: Placement
) -> tuple[Skeleton, tuple[int, ...]]:
    """Joints at the bones' heads, and an end site at the tail of each last bone."""
    joint_of = {bone: joint for joint, bone in enumerate(bones)}
    names = [rig.bones[bone] for bone in bones]
    parents = [-1, *(joint_of[rig.parents[bone]] for bone in bones[1:])]
    points = [rig.heads[bone] for bone in bones]
    for joint, bone in enumerate(bones):
        end = f"{rig.bones[bone]}_end"
        last = bone not in rig.parents and not (
            rig.ends[bone] or rig.bones[bone].endswith("_end")
        )
        if last and end not in rig.bones:
            names.append(end)
            parents.append(joint)
            points.append(rig.tails[bone])
    axes, scale = rest.rotations[0], rest.scale
    where = scale * rotate(axes, np.array(points)) + rest.origins[0]
    offsets = where - np.where(np.array(parents)[:, None] < 0, 0.0, where[parents])
    owners = (*bones, *[-1] * (len(names) - len(bones)))
    return Skeleton(tuple(names), tuple(parents), offsets), owners
