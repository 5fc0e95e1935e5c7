"""Find the body parts that bones belong to. Knows nothing about Blender."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Skeleton, find_humanoid_map
from ...solvers.motion.humanoid import SIDES
from ...solvers.retrieval import FindSettings

LIMBS = {
    f"{side}_{limb}": tuple(f"{side}{bone}" for bone in bones)
    for side in SIDES
    for limb, bones in (
        ("arm", ("Shoulder", "UpperArm", "LowerArm", "Hand")),
        ("leg", ("UpperLeg", "LowerLeg", "Foot", "Toes")),
    )
}
"""Roles whose names begin with one of these; fingers are part of the arm."""
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
TRUNK = ("hips", "spine", "chest", "upperChest", "neck", "head")


def parts_of_bones(
    skeleton: Skeleton, bones: Collection[str], settings: FindSettings
) -> FindSettings:
    """Return the settings with only the parts that any of the bones belongs to.

    Raises InvalidMotionError where none of them is part of a body.
    """
    roles = {bone: role for role, bone in find_humanoid_map(skeleton).joints.items()}
    parts = {_part(roles[bone]) for bone in bones if bone in roles} - {""}
    if not parts:
        raise InvalidMotionError(
            "The selected bones do not belong to the trunk, arms or legs. Select others, or"
            " choose body parts."
        )
    chosen: dict[str, Any] = {name: name in parts for name in ("trunk", *LIMBS)}
    return replace(settings, **chosen)


def _part(role: str) -> str:
    if role in TRUNK:
        return "trunk"
    for side in SIDES:
        if role.startswith(tuple(f"{side}{finger}" for finger in FINGERS)):
            return f"{side}_arm"
    return next((part for part, names in LIMBS.items() if role.startswith(names)), "")
