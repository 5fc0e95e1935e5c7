"""Read the body of a generated control rig as Blender shows it: constraints decide there."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.arrays import Array
from ...solvers.motion import HUMANOID_ROLES, HumanoidMap, Motion, Skeleton
from ...solvers.motion.humanoid import SIDES
from ...solvers.rotations import IDENTITY, inverse, multiply, quaternion_from_matrix, rotate
from ..actions.take import ArmatureTake
from ..blender import compat
from ..blender.block_references import BlockReference, SourceReference
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, should_yield
from ..scene.rig import placement_of
from .animated_values import values_kept
from .rigify import original_of

ABOVE = {
    "spine": "hips", "chest": "spine", "upperChest": "chest", "neck": "upperChest",
    "head": "neck", "Shoulder": "upperChest", "UpperArm": "Shoulder", "LowerArm": "UpperArm",
    "Hand": "LowerArm", "UpperLeg": "hips", "LowerLeg": "UpperLeg", "Foot": "LowerLeg",
    "Toes": "Foot",
}  # fmt: skip
"""Parent of each body part."""
PHALANGES = ("Distal", "Intermediate", "Proximal", "Metacarpal")


def body_bones(roles: HumanoidMap, bones: Mapping[str, object]) -> HumanoidMap:
    """Return, for controls by role, the bones that show where those parts are."""
    shown = {
        role: original_of(control, bones.keys())
        for role, control in roles.joints.items()
        if control in bones
    }
    return HumanoidMap(
        {role: bone for role, bone in shown.items() if bone in bones}, roles.score
    )


@Sliced
def with_body_shown(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    take: ArmatureTake,
    body: HumanoidMap,
    source: Source,
) -> Steps[ArmatureTake]:
    """Return the take whose body is that of the evaluated pose; the scene stays as it is.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
    take : ArmatureTake
        Read from the controls; its frames and placement are used.
    body : HumanoidMap
        Bones by role, with any parents.
    source : action and slot
        Played for as long as it takes.
    """
    rig, rest = take.rig, take.rest
    ordered = [role for role in HUMANOID_ROLES if role in body.joints]
    names = tuple(body.joints[role] for role in ordered)
    index = [rig.bones.index(name) for name in names]
    rotations, root_positions = yield from _visible_poses(scene, armature, names, take, source)
    upright = multiply(rest.rotations[0], rig.rest_rotations[index])
    world = multiply(rotations, inverse(upright))
    parents = tuple(_parent(role, ordered) for role in ordered)
    heads = rest.scale * rotate(rest.rotations[0], rig.heads[index]) + rest.origins[0]
    offsets = heads - np.where(np.array(parents)[:, None] < 0, 0.0, heads[list(parents)])
    above = [world[:, up] if up >= 0 else np.broadcast_to(IDENTITY, world[:, 0].shape)
             for up in parents]  # fmt: skip
    local = multiply(inverse(np.stack(above, axis=1)), world)
    skeleton = Skeleton(names, parents, offsets)
    motion = Motion(skeleton, local, root_positions, take.parts[0].motion.frame_rate)
    shown = replace(take.parts[0], motion=motion, bones=tuple(index))
    return replace(take, parts=(shown, *take.parts[1:]))


def _visible_poses(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    names: tuple[str, ...],
    take: ArmatureTake,
    source: Source,
) -> Steps[tuple[Array, Array]]:
    """Return world rotations of bones, (n_frames, n_bones, 4), and positions of the first, m.

    Before each turn of Blender's the armature plays its own action again.
    """
    lasting = BlockReference.of(scene), BlockReference.of(armature), SourceReference.of(source)
    rotations: list[Array] = []
    positions: list[Array] = []
    while len(rotations) < len(take.frames):
        if rotations:
            yield len(rotations) / len(take.frames)
        scene, armature, source = (each.find() for each in lasting)
        with values_kept(armature, source), _playing(scene, armature, source):
            for frame in take.frames[len(rotations) :]:
                pose_rotations, position = _pose_at(scene, armature, names, frame)
                rotations.append(pose_rotations)
                positions.append(take.rest.scale * position)
                if should_yield():
                    break
    return np.stack(rotations), np.stack(positions)


def _pose_at(
    scene: bpy.types.Scene, armature: bpy.types.Object, names: tuple[str, ...], frame: float
) -> tuple[Array, Array]:
    """Return world rotations of bones at a frame, and the first one's head at scale 1."""
    scene.frame_set(int(np.floor(frame)), subframe=float(frame - np.floor(frame)))
    shown = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    rotation, _, scale = placement_of(shown.matrix_world, armature.name)
    pose = np.array([shown.pose.bones[name].matrix for name in names])
    linear = pose[:, :3, :3] / np.linalg.norm(pose[:, :3, :3], axis=1, keepdims=True)
    head = np.array(shown.matrix_world @ Matrix(pose[0]).translation)
    return multiply(rotation, quaternion_from_matrix(linear)), head / scale


@contextmanager
def _playing(
    scene: bpy.types.Scene, armature: bpy.types.Object, source: Source
) -> Iterator[None]:
    """Let the armature play an action temporarily, then restore its own and the frame."""
    before = scene.frame_current, scene.frame_subframe
    animation = armature.animation_data
    played = animation.action, animation.action_slot
    other = played != source
    try:
        if other:
            compat.assign(armature, *source)
        yield
    finally:
        if other:
            compat.assign(armature, *played)
        scene.frame_set(before[0], subframe=before[1])


def _parent(role: str, ordered: list[str]) -> int:
    """Return the index of the nearest existing part above; -1 for the hips."""
    while (above := _role_above(role)) and above not in ordered:
        role = above
    return ordered.index(above) if above else -1


def _role_above(role: str) -> str:
    side = next((side for side in SIDES if role.startswith(side)), "")
    part = role.removeprefix(side)
    for inner, outer in pairwise(PHALANGES):
        if part.endswith(inner):
            return f"{side}{part.removesuffix(inner)}{outer}"
    if part.endswith("Metacarpal"):
        return f"{side}Hand"
    if role == "hips":
        return ""
    above = ABOVE.get(part, "head")
    return above if above == above.lower() or above == "upperChest" else f"{side}{above}"
