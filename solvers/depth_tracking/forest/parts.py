"""The parts of a body that pixels are told apart by: one per segment, halves of the legs."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

_SIDED = (
    "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "UpperLegEnd", "LowerLeg",
    "LowerLegEnd", "Foot",
)  # fmt: skip

PARTS = (
    "hips",
    "spine",
    "chest",
    "neck",
    "head",
    *(f"left{part}" for part in _SIDED),
    *(f"right{part}" for part in _SIDED),
)
"""Classes of pixels. Each segment of the body is one, as in Wei, Zhang, Chai 2012 (4), and each
upper and lower leg is two: `leftUpperLeg` is the half at the hip, `leftUpperLegEnd` that at the
knee. Hands and feet are parts too, since they tell where the limb points."""

N_PARTS = len(PARTS)

SPLIT_SEGMENTS = ("UpperLeg", "LowerLeg")
"""Segments whose outer half is a part of its own, `<role>End`."""


def part_of_role(role: str) -> str:
    """Return the part that the bone of a humanoid role belongs to (its inner half for legs)."""
    return "chest" if role == "upperChest" else role.replace("Toes", "Foot")


def parts_of_joints(roles: Mapping[int, str], parents: tuple[int, ...]) -> NDArray[np.uint8]:
    """Return the part, as its place in `PARTS`, of each joint's bone.

    Parameters
    ----------
    roles : mapping of joint to humanoid role
    parents : tuple of int
        As in a `Skeleton`. A joint without a role, such as a finger, belongs to the part of the
        nearest joint above that has one; the root's is the hips.
    """
    parts = np.zeros(len(parents), dtype=np.uint8)
    for joint, parent in enumerate(parents):
        part = part_of_role(roles.get(joint, ""))
        if part in PARTS:
            parts[joint] = PARTS.index(part)
        elif parent >= 0:
            parts[joint] = parts[parent]
    return parts


def mirrored_part(part: str) -> str:
    """Return the part on the other side of the body; itself for those in the middle."""
    if part.startswith("left"):
        return "right" + part.removeprefix("left")
    if part.startswith("right"):
        return "left" + part.removeprefix("right")
    return part


MIRRORED_PARTS = np.array([PARTS.index(mirrored_part(part)) for part in PARTS])
"""Place of each part's counterpart on the other side."""
