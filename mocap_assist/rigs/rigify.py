"""Plan of the keys of Rigify's control rigs."""

import re
from collections.abc import Collection, Mapping

import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import roles_by_name
from .control_plan import Limbs, Plan, RigPlan

SIDE_LETTERS = {"left": "L", "right": "R"}
LIMB_CONTROLS = {"Arm": ("upper_arm", "hand", "Hand"), "Leg": ("thigh", "foot", "Foot")}
SPINE = re.compile(r"spine_fk\.\d+$")
SPINE_ROLES = ("spine", "chest", "upperChest")
HELPERS = ("DEF-", "ORG-", "MCH-", "VIS_", "WGT-")
MAX_HEAD_DISTANCE = 1e-4
"""Distance of two heads, relative to the rig's unit, that is only rounding."""
IK_PARENT_ROOT = 1
"""Of the properties IK_parent and pole_parent: 0 is no parent, 1 the root."""


def is_rigify(bones: Collection[str]) -> bool:
    """Return whether bones are those of a generated rig."""
    return "MCH-torso.parent" in bones or ("torso" in bones and "ORG-spine" in bones)


def rigify_roles(bones: Collection[str]) -> dict[str, str]:
    """Return controls by role; all controls of the spine have one."""
    controls = [bone for bone in bones if not bone.startswith(HELPERS)]
    roles = roles_by_name(controls)
    spine = sorted(bone for bone in controls if SPINE.match(bone))
    if not spine:
        return roles
    kept = {role: bone for role, bone in roles.items() if role not in SPINE_ROLES}
    chosen = (spine[0], spine[len(spine) // 2], spine[-1])
    return dict(zip(SPINE_ROLES, dict.fromkeys(chosen), strict=False)) | kept


def rigify_plan(
    roles: Mapping[str, str], heads: Mapping[str, Array], limbs: Limbs, on_root: bool
) -> RigPlan:
    """Return how a generated rig is keyed for these roles.

    `heads` are the places of all bones at rest, shape (3,) each.
    The torso carries both ends of the spine, which turn about the joint at its middle: the
    controls below that are turned by the parts above them.
    """
    bones = heads.keys()
    plans = [Plan("root", "root", "root", moves=True)] if on_root and "root" in bones else []
    joint_bones = {role: original_of(control, bones) for role, control in roles.items()}
    switches: dict[tuple[str, str], float] = {("torso", "torso_parent"): 1.0}
    switches |= {("torso", f"{part}_follow"): 1.0 for part in ("neck", "head")}
    keyed_by_ik = {
        f"{side}{part}"
        for side in SIDE_LETTERS
        for limb in LIMB_CONTROLS
        for part in _parts(limb)
    } | {f"{side}Toes" for side in SIDE_LETTERS}
    for role, control in roles.items():
        if limbs is Limbs.IK and role in keyed_by_ik:
            continue
        if role == "hips":
            plans += _torso(control, roles, heads)
        else:
            plans.append(Plan(control, role, role))
    for side, letter in SIDE_LETTERS.items():
        for limb, (upper, end, end_role) in LIMB_CONTROLS.items():
            if not all(f"{side}{part}" in roles for part in _parts(limb)):
                continue
            parent = f"{upper}_parent.{letter}"
            values = {
                "IK_FK": float(limbs is not Limbs.IK), "FK_limb_follow": 0.0,
                "pole_vector": 1.0, "IK_parent": IK_PARENT_ROOT, "pole_parent": IK_PARENT_ROOT,
            }  # fmt: skip
            switches |= {(parent, name): value for name, value in values.items()}
            if limbs is not Limbs.FK:
                plans += _ik(side, letter, limb, upper, end, end_role, roles)
    return RigPlan(tuple(plan for plan in plans if plan.bone in bones), joint_bones, switches)


def _parts(limb: str) -> tuple[str, str, str]:
    return f"Upper{limb}", f"Lower{limb}", LIMB_CONTROLS[limb][2]


def original_of(control: str, bones: Collection[str]) -> str:
    """Return the bone at the true position of a control's body part."""
    named = {"torso": "ORG-spine", "hips": "ORG-spine"}
    original = named.get(control, "ORG-" + control.replace("_fk", ""))
    return original if original in bones else control


def _torso(control: str, roles: Mapping[str, str], heads: Mapping[str, Array]) -> list[Plan]:
    """The torso turns with the hips but lies at the middle of the spine, as its joints do.

    Controls of the lower spine lie at the upper ends of their bones.
    """
    spine = {role: roles[role] for role in SPINE_ROLES if role in roles}
    lower = [
        role
        for role, bone in spine.items()
        if np.linalg.norm(heads[bone] - heads[original_of(bone, heads)]) > MAX_HEAD_DISTANCE
    ]
    upper = [role for role in spine if role not in lower]
    if not (lower and upper and "spine_fk" in heads):
        return [Plan(control, "hips", "hips", moves=True)]
    return [Plan(control, "hips", upper[0], moves=True), Plan("spine_fk", "hips", "hips")]


def _ik(
    side: str,
    letter: str,
    limb: str,
    upper: str,
    end: str,
    end_role: str,
    roles: Mapping[str, str],
) -> list[Plan]:
    role = side + end_role
    plans = [
        Plan(f"{end}_ik.{letter}", role, role, moves=True),
        Plan(
            f"{upper}_ik_target.{letter}", f"{side}Upper{limb}", f"{side}Upper{limb}",
            rotates=False, moves=True, limb=side + limb,
        ),
    ]  # fmt: skip
    if limb == "Leg" and f"{side}Toes" in roles:
        plans.append(Plan(f"toe_ik.{letter}", f"{side}Toes", f"{side}Toes"))
    return plans
