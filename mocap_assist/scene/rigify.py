"""How Rigify's control rigs are keyed."""

from collections.abc import Collection, Mapping

from .control_plan import Limbs, Plan, RigPlan

SIDES = {"left": "L", "right": "R"}
LIMB_CONTROLS = {"Arm": ("upper_arm", "hand", "Hand"), "Leg": ("thigh", "foot", "Foot")}
HELPERS = ("DEF-", "ORG-", "MCH-", "VIS_", "WGT-")
IK_PARENT_ROOT = 1
"""Of the properties IK_parent and pole_parent: 0 is no parent, 1 the root."""


def is_rigify(bones: Collection[str]) -> bool:
    """Tell whether bones are those of a generated rig."""
    return "MCH-torso.parent" in bones or ("torso" in bones and "ORG-spine" in bones)


def controls_among(bones: Collection[str]) -> list[str]:
    """Return the bones that animators use."""
    return [bone for bone in bones if not bone.startswith(HELPERS)]


def rigify_plan(
    roles: Mapping[str, str], bones: Collection[str], limbs: Limbs, on_root: bool
) -> RigPlan:
    """Return how a generated rig is keyed for these roles.

    The torso carries both ends of the spine, which turn about the joint at its middle: the
    controls below that are turned by the parts above them.
    """
    plans = [Plan("root", "root", "root", moves=True)] if on_root and "root" in bones else []
    joint_bones = {role: original_of(control, bones) for role, control in roles.items()}
    switches: dict[tuple[str, str], float] = {("torso", "torso_parent"): 1.0}
    switches |= {("torso", f"{part}_follow"): 1.0 for part in ("neck", "head")}
    keyed_by_ik = {
        f"{side}{part}" for side in SIDES for limb in LIMB_CONTROLS for part in _parts(limb)
    } | {f"{side}Toes" for side in SIDES}
    for role, control in roles.items():
        if limbs is Limbs.IK and role in keyed_by_ik:
            continue
        if role == "hips":
            plans += _torso(control, roles, bones)
        else:
            plans.append(Plan(control, role, role))
    for side, letter in SIDES.items():
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
    """Return the bone that shows where a control's part of the body really is."""
    named = {"torso": "ORG-spine", "hips": "ORG-spine"}
    original = named.get(control, "ORG-" + control.replace("_fk", ""))
    return original if original in bones else control


def _torso(control: str, roles: Mapping[str, str], bones: Collection[str]) -> list[Plan]:
    """The torso turns with the hips but lies at the middle of the spine, as its joints do."""
    middle = next((role for role in ("chest", "upperChest") if role in roles), "hips")
    plans = [Plan(control, "hips", middle, moves=True)]
    if "spine" in roles and "spine_fk" in bones:
        plans.append(Plan("spine_fk", "hips", "hips"))
    return plans


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
            turns=False, moves=True, limb=side + limb,
        ),
    ]  # fmt: skip
    if limb == "Leg" and f"{side}Toes" in roles:
        plans.append(Plan(f"toe_ik.{letter}", f"{side}Toes", f"{side}Toes"))
    return plans
