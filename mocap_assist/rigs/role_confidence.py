"""Confidence of the roles of a rig's bones, with reasons."""

import bpy

from ...solvers.motion import HumanoidMap, Reason, RoleEvidence, explain_roles
from ..actions.take import skeleton_of
from ..scene.rig import read_rig
from .rigify import is_rigify, rigify_roles
from .target_read import stage_of


def explain_rig_roles(
    armature: bpy.types.Object, roles: HumanoidMap
) -> dict[str, RoleEvidence]:
    """Return the evidence for each role of a map whose bone the armature has.

    Of rigs by Rigify only the names of the controls are compared.
    """
    rig = read_rig(armature)
    if is_rigify(rig.bones):
        controls = rigify_roles(rig.bones)
        reasons = {
            role: Reason.CONTROL if controls.get(role) == bone else Reason.NEITHER
            for role, bone in roles.joints.items()
            if bone in rig.bones
        }
        return {role: RoleEvidence(each, each.text) for role, each in reasons.items()}
    stage, _ = stage_of(armature)
    tops = [bone for bone, parent in enumerate(rig.parents) if parent < 0]
    mapped = set(roles.joints.values())
    tree = max(
        (rig.subtree(top) for top in tops),
        key=lambda bones: sum(rig.bones[bone] in mapped for bone in bones),
    )
    found = explain_roles(skeleton_of(rig, tree, stage)[0], roles)
    reason = Reason.NEITHER  # of bones in another tree than the body
    others = {
        role: RoleEvidence(reason, reason.text)
        for role, bone in roles.joints.items()
        if bone in rig.bones and role not in found
    }
    return {**found, **others}
