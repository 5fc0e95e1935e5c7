"""Prior of an adult body: joints, their rotations, and the placement of markers.

The rest pose is the T-pose, facing -Y: arms along +-X with the palms down, legs along -Z. The
right side mirrors the entries of the left one.
"""

from typing import NamedTuple

from .marker_sets import HEAD, PELVIS, TRUNK

LOOSE_STD_M, FIRM_STD_M, TIGHT_STD_M = 0.03, 0.012, 0.006
"""Standard deviations, in meters, of a joint's or marker's offset from its mean. Chosen by
hand; `make sensitivity` varies them."""
FREE_STD_M = 1.0
"""Standard deviation of an offset that only the markers determine. By definition wider than any
error. It guards leg lengths that start wrong, as of a knee marker placed too low."""
Triple = tuple[float, float, float]
NO_PRIOR: Triple = (0.0, 0.0, 0.0)


class JointPrior(NamedTuple):
    """A joint of the mean body."""

    name: str
    parent: str
    play: Triple = NO_PRIOR
    """Standard deviation of each coordinate of the offset from the parent, meters; 0: fixed."""
    ease: Triple = NO_PRIOR
    """Standard deviation of the rotation vector, radians; 0: no prior."""
    hinge: Triple = NO_PRIOR
    """Standard deviation of its X axis from that of its parent, radians; 0: no prior."""
    rotates: bool = True


class MarkerPrior(NamedTuple):
    """A marker of the mean body. It moves with a bone and has an offset from an anchor."""

    landmark: str
    bone: str
    anchor: str
    play: float
    """Standard deviation of each coordinate of its offset from the anchor, meters."""
    offset: Triple | None = None
    """Mean offset in bone axes; None: from the initial poses."""
    noise: float = 0.010
    """Standard deviation of its soft-tissue motion on the bone, meters."""


TRUNK_FLEXION_RAD: Triple = (0.4, 0.4, 0.4)
"""Standard deviation of the rotation of a trunk joint, radians. Half and twice are no better
(`make sensitivity`)."""
CENTRAL_JOINTS = (
    JointPrior("hips", ""),
    JointPrior("spine", "hips", (0.0, TIGHT_STD_M, TIGHT_STD_M), TRUNK_FLEXION_RAD),
    JointPrior("chest", "spine", (0.0, TIGHT_STD_M, TIGHT_STD_M), TRUNK_FLEXION_RAD),
    JointPrior("neck", "chest", (0.0, TIGHT_STD_M, TIGHT_STD_M), TRUNK_FLEXION_RAD),
    JointPrior("head", "neck", (0.0, TIGHT_STD_M, FIRM_STD_M), TRUNK_FLEXION_RAD),
    JointPrior("head_end", "head", rotates=False),
)
SIDE = (
    JointPrior("Shoulder", "chest", (TIGHT_STD_M, TIGHT_STD_M, TIGHT_STD_M), (0.05, 0.5, 0.5)),
    JointPrior("UpperArm", "Shoulder", (FIRM_STD_M, FIRM_STD_M, FIRM_STD_M)),
    JointPrior("LowerArm", "UpperArm", (FIRM_STD_M, 0.0, 0.0), hinge=(0.0, 0.0, 0.5)),
    JointPrior("Hand", "LowerArm", (FIRM_STD_M, 0.0, 0.0), (0.15, 1.0, 1.0)),
    JointPrior("Hand_end", "Hand", rotates=False),
    JointPrior("UpperLeg", "hips", (LOOSE_STD_M, LOOSE_STD_M, LOOSE_STD_M)),
    JointPrior("LowerLeg", "UpperLeg", (0.0, 0.0, FREE_STD_M), hinge=(0.0, 0.1, 0.1)),
    JointPrior("Foot", "LowerLeg", (0.0, 0.0, FREE_STD_M), (1.0, 1.0, 1.0)),
    JointPrior("Toes", "Foot", rotates=False),
    JointPrior("Toes_end", "Toes", rotates=False),
)
CENTRAL_MARKERS = (
    *(MarkerPrior(landmark, "hips", "hips", TIGHT_STD_M) for landmark in PELVIS),
    *(MarkerPrior(landmark, "chest", "neck", TIGHT_STD_M) for landmark in TRUNK),
    *(MarkerPrior(landmark, "head", "head", TIGHT_STD_M) for landmark in HEAD),
)  # fmt: skip
SIDE_MARKERS = (
    MarkerPrior("SHO", "Shoulder", "UpperArm", FIRM_STD_M, (0.0, 0.0, 0.05)),
    MarkerPrior("UPA", "UpperArm", "UpperArm", LOOSE_STD_M, noise=0.015),
    MarkerPrior("ELB", "UpperArm", "LowerArm", FIRM_STD_M, (0.0, 0.0, 0.045)),
    MarkerPrior("FRM", "LowerArm", "LowerArm", LOOSE_STD_M, noise=0.015),
    MarkerPrior("WRA", "LowerArm", "Hand", TIGHT_STD_M),
    MarkerPrior("WRB", "LowerArm", "Hand", TIGHT_STD_M),
    MarkerPrior("FIN", "Hand", "Hand", TIGHT_STD_M),
    MarkerPrior("THI", "UpperLeg", "UpperLeg", LOOSE_STD_M, noise=0.015),
    MarkerPrior("KNE", "UpperLeg", "LowerLeg", FIRM_STD_M, (0.06, 0.0, 0.0)),
    MarkerPrior("TIB", "LowerLeg", "LowerLeg", LOOSE_STD_M, noise=0.015),
    MarkerPrior("ANK", "LowerLeg", "Foot", FIRM_STD_M, (0.045, 0.0, 0.0)),
    MarkerPrior("HEE", "Foot", "Foot", TIGHT_STD_M),
    MarkerPrior("TOE", "Foot", "Foot", TIGHT_STD_M),
    MarkerPrior("MT5", "Foot", "Foot", TIGHT_STD_M),
)
MARKER_SIDES = {"left": ("L", 1.0), "right": ("R", -1.0)}
"""First letter of a side's markers, and the sign of its X coordinate."""
REQUIRED_MARKERS = (
    ("chest", ("C7", "CLAV", "T10", "STRN")),
    ("head", ("LFHD", "RFHD", "LBHD", "RBHD")),
    ("Shoulder", ("SHO", "ELB")),
    ("LowerArm", ("WRA", "WRB")),
    ("Hand", ("FIN",)),
    ("Foot", ("HEE", "TOE")),
)
"""Markers without which a body part and its descendants are left out."""
