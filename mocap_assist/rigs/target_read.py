"""Read the target rig of a retargeted motion."""

from collections.abc import Collection, Mapping

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import HumanoidMap, Skeleton, find_humanoid_map
from ...solvers.motion.humanoid import ESSENTIAL_ROLES, SIDES
from ...solvers.rotations import inverse, multiply, quaternion_from_matrix, rotate
from ..actions.take import skeleton_of
from ..scene.controls import NO_CONTROL, Control, TargetRig
from ..scene.rig import Placement, Rig, placement_of, read_rig
from ..scene.units import meters_per_unit
from .control_plan import ROOT, Limbs, Plan, RigPlan, plain_plan, role_above
from .probing import find_carriers, location_axes
from .rigify import is_rigify, rigify_plan, rigify_roles

ROOT_NAMES = ("root", "Root", "c_traj", "c_pos", "master", "Armature", "reference")


def find_roles(armature: bpy.types.Object) -> HumanoidMap:
    """Find the bone of a rig to key for each role.

    Of rigs by Rigify only the controls are considered.
    """
    rig = read_rig(armature)
    if is_rigify(rig.bones):
        joints = rigify_roles(rig.bones)
        found = sum(role in joints for role in ESSENTIAL_ROLES)
        return HumanoidMap(joints, found / len(ESSENTIAL_ROLES))
    tops = [bone for bone, parent in enumerate(rig.parents) if parent < 0]
    trees = [rig.subtree(top) for top in tops]
    stage, _ = stage_of(armature)
    skeletons = (skeleton_of(rig, tree, stage)[0] for tree in trees)
    return max((find_humanoid_map(each) for each in skeletons), key=lambda each: each.score)


def stage_of(armature: bpy.types.Object) -> tuple[Placement, Array]:
    """Return the position of the armature's space on its stage, and the stage's rotation.

    The stage is upright, with the armature's rotation about the vertical.
    """
    rotation, _, scale = placement_of(armature.matrix_world, armature.name)
    about = vertical_part(rotation)
    upright = multiply(inverse(about), rotation)
    return Placement(upright[None], np.zeros((1, 3)), scale), about


def vertical_part(rotation: Array) -> Array:
    """Return the rotation about the vertical of a rotation, shape (4,)."""
    part = np.array([rotation[0], 0.0, 0.0, rotation[3]])
    length = np.linalg.norm(part)
    return np.asarray(part / length if length > 1e-6 else [1.0, 0.0, 0.0, 0.0])


def read_target(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    roles: HumanoidMap,
    limbs: Limbs,
    on_root: bool,
) -> tuple[TargetRig, Mapping[tuple[str, str], float]]:
    """Read the rest pose of a rig and the carriers of its controls; it is not changed.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
        May be linked or overridden.
    roles : HumanoidMap
        Names of bones to be keyed, by role.
    limbs : Limbs
    on_root : bool
        Whether a bone above the hips is to take the travel.

    Returns
    -------
    TargetRig, and the custom properties to be keyed, by bone and name

    Raises
    ------
    InvalidMotionError
        A bone is missing, or its motion cannot be followed.
    """
    rig = read_rig(armature)
    joints = {role: bone for role, bone in roles.joints.items() if bone in rig.bones}
    if "hips" not in joints:
        raise InvalidMotionError(
            f"No bone of {armature.name} has the role hips. Choose one in the list of bones."
        )
    if armature.data.pose_position == "REST":
        raise InvalidMotionError(
            f"{armature.name} is in Rest Position, so nothing moves. Switch it to Pose Position"
            " in its data properties."
        )
    plan = _plan(rig, joints, limbs, on_root)
    stage, _ = stage_of(armature)
    root = rig.bones.index(plan.joint_bones["hips"])
    meters = meters_per_unit(scene, rig, _top_of(rig, root), stage.scale)
    stage = stage.in_unit(meters)
    _check_movers(rig, plan, armature.name)
    bones_to_probe = [(each.bone, each.moves) for each in plan.plans]
    carriers = find_carriers(scene, armature, bones_to_probe, plan.switches)
    skeleton, order = _skeleton(rig, plan.joint_bones, stage)
    joint_indices = {role: index for index, role in enumerate(order)} | {ROOT: NO_CONTROL}
    names = [each.bone for each in plan.plans]
    controls = tuple(
        _control(armature, rig, each, stage, joint_indices, _carrier(each, names, carriers))
        for each in plan.plans
    )
    humanoid = HumanoidMap({role: skeleton.names[joint_indices[role]] for role in joints})
    return TargetRig(skeleton, humanoid, controls, stage.scale), plan.switches


def _plan(rig: Rig, joints: Mapping[str, str], limbs: Limbs, on_root: bool) -> RigPlan:
    if is_rigify(rig.bones):
        heads = dict(zip(rig.bones, rig.heads, strict=True))
        return rigify_plan(joints, heads, limbs, on_root)
    return plain_plan(joints, _root_bone(rig, joints) if on_root else "")


def _root_bone(rig: Rig, joints: Mapping[str, str]) -> str:
    """Return the topmost bone above the hips that plays no role, or nothing."""
    above = [rig.bones[bone] for bone in rig.chain_to(rig.bones.index(joints["hips"]))]
    free = [bone for bone in above if bone not in joints.values()]
    named = [bone for bone in ROOT_NAMES if bone in rig.bones and not above]
    return next(iter((*free, *named)), "")


def _top_of(rig: Rig, bone: int) -> int:
    return next(iter(rig.chain_to(bone)), bone)


def _check_movers(rig: Rig, plan: RigPlan, armature: str) -> None:
    for each in plan.plans:
        if each.moves and rig.connected[rig.bones.index(each.bone)]:
            raise InvalidMotionError(
                f"{each.bone} of {armature} is connected to the bone above it and cannot be"
                " moved. Turn off Connected in Edit Mode, or choose another bone."
            )


def _carrier(plan: Plan, names: list[str], carriers: Mapping[str, str | None]) -> int:
    found = carriers[plan.bone]
    if found is None:
        raise InvalidMotionError(
            f"Could not determine what drives {plan.bone}. Remove it from the bone list, or"
            " mute the constraints above it."
        )
    return names.index(found) if found else NO_CONTROL


def _skeleton(
    rig: Rig, joint_bones: Mapping[str, str], stage: Placement
) -> tuple[Skeleton, list[str]]:
    """Return the joints of the roles, each hung on the role above it, and their roles."""
    order = sorted(joint_bones, key=lambda role: _depth(role, joint_bones))
    names, parents, points = [], [], []
    for role in order:
        above = role_above(role, tuple(joint_bones)) or ("" if role == "hips" else "hips")
        names.append(joint_bones[role])
        parents.append(order.index(above) if above else -1)
        points.append(rig.heads[rig.bones.index(joint_bones[role])])
    for joint, name in enumerate(names[: len(order)]):
        if joint not in parents and f"{name}_end" not in names:
            names.append(f"{name}_end")
            parents.append(joint)
            points.append(rig.tails[rig.bones.index(name)])
    where = stage.scale * rotate(stage.rotations[0], np.array(points))
    offsets = where - np.where(np.array(parents)[:, None] < 0, 0.0, where[parents])
    return Skeleton(tuple(names), tuple(parents), offsets), order


def _depth(role: str, played: Collection[str]) -> int:
    depth = 0
    while role:
        role, depth = role_above(role, tuple(played)), depth + 1
    return depth


def _control(
    armature: bpy.types.Object,
    rig: Rig,
    plan: Plan,
    stage: Placement,
    joint_indices: Mapping[str, int],
    carrier: int,
) -> Control:
    bone = rig.bones.index(plan.bone)
    axes = np.array(location_axes(armature.data.bones[plan.bone]))
    upright = stage.rotations[0]
    limb = None
    if plan.limb:
        side = next(side for side in SIDES if plan.limb.startswith(side))
        part = plan.limb.removeprefix(side)
        end = "Hand" if part == "Arm" else "Foot"
        roles = (f"{side}Upper{part}", f"{side}Lower{part}", f"{side}{end}")
        limb = (joint_indices[roles[0]], joint_indices[roles[1]], joint_indices[roles[2]])
    return Control(
        bone=plan.bone,
        joint=joint_indices[plan.role],
        anchor=joint_indices[plan.anchor],
        carrier=carrier,
        axes=multiply(upright, rig.rest_rotations[bone]),
        location_axes=multiply(upright, quaternion_from_matrix(axes)),
        head=stage.scale * rotate(upright, rig.heads[bone]),
        rotates=plan.rotates,
        moves=plan.moves,
        limb=limb,
    )
