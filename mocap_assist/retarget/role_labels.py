"""Readable names of humanoid roles, such as "Upper Leg L" for leftUpperLeg."""

from ...solvers.motion import HUMANOID_ROLES
from ..languages import translated

PARTS = (
    "Hips", "Spine", "Chest", "Upper Chest", "Neck", "Head", "Shoulder", "Upper Arm",
    "Lower Arm", "Hand", "Upper Leg", "Lower Leg", "Foot", "Toes",
)  # fmt: skip
"""A role without its side is one of these without the space."""
FINGERS = ("Thumb", "Index Finger", "Middle Finger", "Ring Finger", "Little Finger")
"""A role of a finger starts with the first word, and ends with one of its bones."""
THUMB_BONES = ("Metacarpal", "Proximal", "Distal")
FINGER_BONES = ("Proximal", "Intermediate", "Distal")
"""From the palm to the tip; rigs number them from 1."""
ENDINGS = {"left": "L", "right": "R"}
"""Ends of names as Blender's own."""


def role_label(role: str) -> str:
    """Return the name of a role in the language of the window, with the side at its end.

    A role that is unknown, such as one of another version's file, is its own name.
    """
    if role not in HUMANOID_ROLES:
        return role
    for side, ending in ENDINGS.items():
        if role.startswith(side):
            return f"{_part_label(role.removeprefix(side))} {ending}"
    return _part_label(role)


def _part_label(part: str) -> str:
    for label in FINGERS:
        finger = label.removesuffix(" Finger")
        if part.startswith(finger):
            bones = THUMB_BONES if finger == "Thumb" else FINGER_BONES
            return f"{translated(label)} {1 + bones.index(part.removeprefix(finger))}"
    return next(
        translated(label) for label in PARTS if label.replace(" ", "").lower() == part.lower()
    )
