"""Parents of body segments, for files that name segments without a hierarchy."""

from collections.abc import Sequence

MIN_KNOWN_FRACTION = 0.5
"""Fraction of the segments that a program's tree must know, to be used. Measured: of the names
of Theia3D its own tree knows 0.95, others at most 0.10."""

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Pinky")


def _both_sides(
    rows: dict[str, str], center: Sequence[str], left: str, right: str
) -> dict[str, str]:
    """Return the rows with the prefix of each side; parents in `center` have none."""
    return {
        f"{side}{name}": parent if parent in center else f"{side}{parent}"
        for side in (left, right)
        for name, parent in rows.items()
    }


def _chains(count: int) -> dict[str, str]:
    """Return the joints of five fingers, numbered from 1, on the hand."""
    chains = {}
    for finger in FINGERS:
        above = "Hand"
        for number in range(1, count + 1):
            chains[f"{finger}{number}"] = above
            above = f"{finger}{number}"
    return chains


MOTIVE_TRUNK = {
    "Hip": "", "Ab": "Hip", "Spine2": "Ab", "Spine3": "Spine2", "Spine4": "Spine3",
    "Chest": "Spine4", "Neck": "Chest", "Neck2": "Neck", "Head": "Neck2",
}  # fmt: skip
MOTIVE = MOTIVE_TRUNK | _both_sides(
    {
        "Shoulder": "Chest", "UArm": "Shoulder", "FArm": "UArm", "Hand": "FArm",
        "Thigh": "Hip", "Shin": "Thigh", "Foot": "Shin", "Toe": "Foot", **_chains(3),
    },
    tuple(MOTIVE_TRUNK), "L", "R",
)  # fmt: skip
"""OptiTrack Motive, with its own names."""

HUMAN_IK_TRUNK = {
    "Hips": "", "Spine": "Hips", "Spine1": "Spine", "Spine2": "Spine1", "Spine3": "Spine2",
    "Neck": "Spine3", "Neck1": "Neck", "Head": "Neck1",
}  # fmt: skip
HUMAN_IK = HUMAN_IK_TRUNK | _both_sides(
    {
        "Shoulder": "Spine3", "Arm": "Shoulder", "ArmRoll": "Arm", "ForeArm": "ArmRoll",
        "ForeArmRoll": "ForeArm", "Hand": "ForeArmRoll", "UpLeg": "Hips", "UpLegRoll": "UpLeg",
        "Leg": "UpLegRoll", "LegRoll": "Leg", "Foot": "LegRoll", "ToeBase": "Foot",
        **{f"Hand{name}": parent if parent == "Hand" else f"Hand{parent}"
           for name, parent in _chains(4).items()},
    },
    tuple(HUMAN_IK_TRUNK), "Left", "Right",
)  # fmt: skip
"""Qualisys, and Motive with the names of MotionBuilder."""

THEIA_TRUNK = {
    "pelvis": "", "abdomen": "pelvis", "thorax": "abdomen", "torso": "thorax", "neck": "torso",
    "head": "neck",
}  # fmt: skip
THEIA = THEIA_TRUNK | _both_sides(
    {
        "clavicle": "torso", "uarm": "clavicle", "larm": "uarm", "hand": "larm",
        "fingers": "hand", "thigh": "pelvis", "shank": "thigh", "foot": "shank",
        "toes": "foot",
    },
    tuple(THEIA_TRUNK), "l_", "r_",
)  # fmt: skip
"""Theia3D."""

VISUAL3D = {"RPV": "", "RTA": "RPV", "RHE": "RTA"} | _both_sides(
    {"AR": "RTA", "FA": "AR", "HA": "FA", "TH": "RPV", "SK": "TH", "FT": "SK"},
    ("RTA", "RPV"), "L", "R",
)  # fmt: skip
"""Visual3D's short names."""

TREES = (MOTIVE, HUMAN_IK, THEIA, VISUAL3D)


def tree_of_segments(names: Sequence[str]) -> dict[str, str]:
    """Return the parent of each known segment, "" for the root, parents first.

    The tree is that of the program that knows most of the names; where it leaves a segment
    out, its children hang on the next one above. Empty if no program knows half of the names,
    or the root is missing.
    """
    given = {name.lower(): name for name in reversed(names)}
    trees = ({child.lower(): above.lower() for child, above in tree.items()} for tree in TREES)
    tree = max(trees, key=lambda known: len(known.keys() & given.keys()))
    parents = {}
    for name in (name for name in tree if name in given):
        parent = tree[name]
        while parent and parent not in given:
            parent = tree[parent]
        parents[given[name]] = given.get(parent, "")
    is_known = len(parents) >= MIN_KNOWN_FRACTION * len(given)
    return parents if is_known and list(parents.values()).count("") == 1 else {}
