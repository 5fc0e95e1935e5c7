"""The bones of Unity's humanoid: their order, parents and default lengths."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from ....arrays import Array
from ....motion import Skeleton
from ....motion.humanoid import ARM_ROLES, CENTRAL_ROLES, LEG_ROLES, SIDES

FINGERS = {
    "Thumb": ("Metacarpal", "Proximal", "Distal"),
    **dict.fromkeys(
        ("Index", "Middle", "Ring", "Little"), ("Proximal", "Intermediate", "Distal")
    ),
}


def _parents() -> dict[str, str]:
    """Return the parent of each role, parents first."""
    parents = dict(zip(CENTRAL_ROLES, ("", *CENTRAL_ROLES), strict=False))
    for side in SIDES:
        for above, chain in (("upperChest", ARM_ROLES), ("hips", LEG_ROLES)):
            for part in chain:
                parents[side + part] = above
                above = side + part
        for finger, parts in FINGERS.items():
            above = f"{side}Hand"
            for part in parts:
                parents[f"{side}{finger}{part}"] = above
                above = f"{side}{finger}{part}"
    return parents


PARENTS = _parents()
"""The humanoid roles with their parents; roles between may be missing."""
LEFT_OFFSETS_M = {
    "hips": (0.0, 0.0, 0.95), "spine": (0.0, 0.0, 0.10), "chest": (0.0, 0.0, 0.13),
    "upperChest": (0.0, 0.0, 0.13), "neck": (0.0, 0.0, 0.14), "head": (0.0, 0.0, 0.10),
    "Shoulder": (0.04, 0.0, 0.10), "UpperArm": (0.13, 0.0, 0.0), "LowerArm": (0.27, 0.0, 0.0),
    "Hand": (0.25, 0.0, 0.0), "UpperLeg": (0.09, 0.0, -0.05), "LowerLeg": (0.0, 0.0, -0.42),
    "Foot": (0.0, 0.0, -0.40), "Toes": (0.0, -0.13, -0.08),
}  # fmt: skip
"""Offsets of an adult of 1.7 m in the T-pose, meters, of the left side. Chosen by hand: they
stand in for those of senders that leave them out, and only where feet reach depends on them."""
FINGER_OFFSET_M = (0.03, 0.0, 0.0)
"""The same for each bone of a finger, meters. Chosen by hand: 3 cm."""
MIN_BONE_M = 1e-3
"""Meters: a shorter bone was left out by the sender. By definition of `Skeleton`, it has no
direction."""


def parent_indices(roles: Sequence[str]) -> list[int]:
    """Return for each role the index of its nearest ancestor among them, -1 for the first."""
    indices = []
    for role in roles:
        above = PARENTS[role]
        while above and above not in roles:
            above = PARENTS[above]
        indices.append(roles.index(above) if above else -1)
    return indices


def sorted_roles(roles: Iterable[str]) -> tuple[str, ...]:
    """Return roles with parents first."""
    present = set(roles)
    return tuple(role for role in PARENTS if role in present)


def skeleton_from_offsets(offsets: Mapping[str, Array]) -> Skeleton:
    """Return the skeleton in the T-pose, standing on the floor.

    Parameters
    ----------
    offsets : mapping of roles, parents first, to shape (3,), meters
        Zero where the sender left it out. That of the hips is replaced.
    """
    roles = tuple(offsets)
    lengths = np.stack([
        offset if np.linalg.norm(offset) >= MIN_BONE_M else default_offset(role)
        for role, offset in offsets.items()
    ])  # fmt: skip
    return standing(roles, parent_indices(roles), lengths)


def standing(names: Sequence[str], parents: Sequence[int], offsets: Array) -> Skeleton:
    """Return a skeleton of offsets, (n, 3), above the origin, whose lowest joint is at 0."""
    offsets = np.array(offsets, dtype=np.float64)
    offsets[0] = 0.0
    skeleton = Skeleton(tuple(names), tuple(parents), offsets)
    offsets[0, 2] = -skeleton.rest_positions[:, 2].min()
    return Skeleton(tuple(names), tuple(parents), offsets)


def default_offset(role: str) -> Array:
    """Return the offset, (3,) meters, of a bone of an adult."""
    side = next((side for side in SIDES if role.startswith(side)), "")
    offset = LEFT_OFFSETS_M.get(role.removeprefix(side), FINGER_OFFSET_M)
    return np.array(offset) * ((-1.0 if side == "right" else 1.0), 1.0, 1.0)
