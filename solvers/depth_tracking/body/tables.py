"""Tables of the body model: segments, joints, lengths and capsules."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion.humanoid import SIDES

Vector = tuple[float, float, float]

_LIMB_PARENTS = {
    "Shoulder": "chest", "UpperArm": "Shoulder", "LowerArm": "UpperArm",
    "UpperLeg": "hips", "LowerLeg": "UpperLeg", "Foot": "LowerLeg",
}  # fmt: skip
_LIMBS = tuple(f"{side}{limb}" for side in SIDES for limb in _LIMB_PARENTS)
SEGMENTS = ("hips", "spine", "chest", "neck", "head", *_LIMBS)
"""The rigid segments, named by the humanoid role of their joint: the 15 of [WZC12], where feet
are rigid with the shanks, and two feet."""


def _parent(segment: str) -> int:
    for side in SIDES:
        if segment.startswith(side):
            parent = _LIMB_PARENTS[segment.removeprefix(side)]
            return SEGMENTS.index(parent if parent in SEGMENTS else f"{side}{parent}")
    return SEGMENTS.index(segment) - 1


PARENTS = tuple(_parent(segment) for segment in SEGMENTS)
"""Index of each segment's parent, -1 for the hips; parents precede children."""

END_JOINTS = ("leftHand", "leftToes", "rightHand", "rightToes")
"""End joints of segments, without rotation of their own."""
JOINTS = (*SEGMENTS, *END_JOINTS)
END_SEGMENTS = tuple(
    SEGMENTS.index(f"{side}{limb}") for side in SIDES for limb in ("LowerArm", "Foot")
)
"""Index of the segment that carries each of `END_JOINTS`."""

_SIDED_LENGTHS = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
LENGTHS = (
    "hips", "hipWidth", "spine", "chest", "neck", "head",
    *(f"{side}{length}" for side in SIDES for length in _SIDED_LENGTHS),
)  # fmt: skip
"""Lengths of a body: hipWidth from hip center to hip joint, hand from wrist to finger tips,
foot from ankle to toes, the others from joint to joint."""

DEFAULT_LENGTHS_M = np.array([0.09, 0.10, 0.14, 0.325, 0.075, 0.08]
    + 2 * [0.165, 0.26, 0.255, 0.17, 0.43, 0.435, 0.17])  # fmt: skip
"""Lengths of an adult of 1.75 m, meters: thighs, shanks and forearms by Winter 2009, figure
4.1, to 5 mm, the others chosen by hand."""


class CapsuleRow(NamedTuple):
    """A capsule: its segment, end points and default radii."""

    name: str
    segment: str
    start: dict[str, Vector]
    """Point in the segment's frame as vectors times lengths; x left, y down, z back."""
    stop: dict[str, Vector]
    radii: tuple[float, float]
    """Across (along x) and from front to back, meters, of an adult of 1.75 m."""


def _trunk_capsules() -> list[CapsuleRow]:
    return [
        CapsuleRow("hips", "hips", {"hips": (0.0, -0.3, 0.0)}, {"hips": (0.0, 0.2, 0.0)},
                   (0.160, 0.115)),
        CapsuleRow("spine", "spine", {"spine": (0.0, 0.0, -0.1)}, {"spine": (0.0, -0.8, 0.0)},
                   (0.150, 0.110)),
        CapsuleRow("chest", "chest", {"chest": (0.0, -0.10, -0.05)},
                   {"chest": (0.0, -0.55, -0.05)}, (0.160, 0.115)),
        CapsuleRow("neck", "neck", {"neck": (0.0, 0.4, 0.0)}, {"neck": (0.0, -1.0, -0.2)},
                   (0.060, 0.060)),
        CapsuleRow("head", "head", {"head": (0.0, -0.1, -0.45)}, {"head": (0.0, -1.0, -0.30)},
                   (0.080, 0.098)),
    ]  # fmt: skip


def _limb_capsules(side: str) -> list[CapsuleRow]:
    out = 1.0 if side == "left" else -1.0

    def row(
        name: str, segment: str, start: dict[str, Vector], stop: dict[str, Vector], r: float
    ) -> CapsuleRow:
        return CapsuleRow(
            f"{side}{name}", f"{side}{segment}",
            {f"{side}{length}": point for length, point in start.items()},
            {f"{side}{length}": point for length, point in stop.items()}, (r, r),
        )  # fmt: skip

    along = (0.0, 1.0, 0.0)
    return [
        row("Shoulder", "Shoulder", {"Shoulder": (0.35 * out, 0.0, 0.0)},
            {"Shoulder": (0.90 * out, 0.12, 0.0)}, 0.065),
        row("UpperArm", "UpperArm", {}, {"UpperArm": along}, 0.050),
        row("LowerArm", "LowerArm", {}, {"LowerArm": along}, 0.038),
        row("Hand", "LowerArm", {"LowerArm": along, "Hand": (0.0, 0.25, 0.0)},
            {"LowerArm": along, "Hand": (0.0, 0.75, 0.0)}, 0.035),
        row("UpperLeg", "UpperLeg", {"UpperLeg": (0.0, 0.05, 0.0)}, {"UpperLeg": along},
            0.078),
        row("LowerLeg", "LowerLeg", {}, {"LowerLeg": (0.0, 0.97, 0.0)}, 0.052),
        row("Foot", "Foot", {"Foot": (0.0, 0.20, 0.10)}, {"Foot": (0.0, 0.23, -0.80)}, 0.038),
    ]  # fmt: skip


CAPSULE_ROWS = (*_trunk_capsules(), *_limb_capsules("left"), *_limb_capsules("right"))
CAPSULES = tuple(row.name for row in CAPSULE_ROWS)
CAPSULE_SEGMENTS = np.array([SEGMENTS.index(row.segment) for row in CAPSULE_ROWS])
"""Index of the segment that each capsule belongs to."""
DEFAULT_RADII_M = np.array([row.radii for row in CAPSULE_ROWS])


def _offset_rows() -> list[dict[str, Vector]]:
    """Return the offset of each of the `JOINTS` from its parent, as vectors times lengths."""
    rows: dict[str, dict[str, Vector]] = {
        "hips": {}, "spine": {"hips": (0.0, -1.0, 0.1)}, "chest": {"spine": (0.0, -1.0, 0.1)},
        "neck": {"chest": (0.0, -1.0, -0.1)}, "head": {"neck": (0.0, -1.0, -0.2)},
    }  # fmt: skip
    for side, out in zip(SIDES, (1.0, -1.0), strict=True):
        rows |= {
            f"{side}Shoulder": {"chest": (0.0, -0.77, -0.08),
                                f"{side}Shoulder": (0.12 * out, 0.0, 0.0)},
            f"{side}UpperArm": {f"{side}Shoulder": (0.98 * out, 0.2, 0.0)},
            f"{side}LowerArm": {f"{side}UpperArm": (0.0, 1.0, 0.0)},
            f"{side}Hand": {f"{side}LowerArm": (0.0, 1.0, 0.0)},
            f"{side}UpperLeg": {"hipWidth": (out, 0.0, 0.0)},
            f"{side}LowerLeg": {f"{side}UpperLeg": (0.0, 1.0, 0.0)},
            f"{side}Foot": {f"{side}LowerLeg": (0.0, 1.0, 0.0)},
            f"{side}Toes": {f"{side}Foot": (0.0, 0.25, -0.85)},
        }  # fmt: skip
    return [rows[joint] for joint in JOINTS]


def _tensor(rows: list[dict[str, Vector]]) -> Array:
    """Return the matrices (n, 3, n_lengths) that map lengths to points."""
    tensor = np.zeros((len(rows), 3, len(LENGTHS)))
    for matrix, row in zip(tensor, rows, strict=True):
        for length, point in row.items():
            matrix[:, LENGTHS.index(length)] = point
    return tensor


OFFSETS = _tensor(_offset_rows())
"""(n_joints, 3, n_lengths): joint in the frame of the parent segment = OFFSETS @ lengths."""
CAPSULE_ENDS = np.stack(
    [_tensor([row.start for row in CAPSULE_ROWS]), _tensor([row.stop for row in CAPSULE_ROWS])],
    axis=1,
)
"""(n_capsules, 2, 3, n_lengths): ends of capsules in their segment = CAPSULE_ENDS @ lengths."""
