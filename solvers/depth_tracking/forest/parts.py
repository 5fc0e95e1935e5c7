"""The body parts that pixels are classified as: one per segment, two per leg segment."""

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
knee. Hands and feet are parts too, because they show the direction of the limb."""

N_PARTS = len(PARTS)

SPLIT_SEGMENTS = ("UpperLeg", "LowerLeg")
"""Segments whose outer half is a part of its own, `<role>End`."""


def part_of_role(role: str) -> str:
    """Return the part that the bone of a humanoid role belongs to (its inner half for legs)."""
    return "chest" if role == "upperChest" else role.replace("Toes", "Foot")


def parts_of_joints(roles: Mapping[int, str], parents: tuple[int, ...]) -> NDArray[np.uint8]:
    """Return the part of each joint's bone, as index in `PARTS`.

    Parameters
    ----------
    roles : mapping of joint to humanoid role
    parents : tuple of int
        As in a `Skeleton`. A joint without a role, such as a finger, belongs to the part of the
        nearest ancestor that has one; the root's is the hips.
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
    """Return the part on the other side of the body; central parts are unchanged."""
    if part.startswith("left"):
        return "right" + part.removeprefix("left")
    if part.startswith("right"):
        return "left" + part.removeprefix("right")
    return part


MIRRORED_PARTS = np.array([PARTS.index(mirrored_part(part)) for part in PARTS])
"""Index of each part's counterpart on the other side."""
