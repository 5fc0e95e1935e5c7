"""A usual body: its joints, how they turn, and where markers sit on it.

Rest pose is the T-pose, facing -Y: arms along +-X with the palms down, legs along -Z. What is
written for the left side holds for the right one, mirrored.
"""

from typing import NamedTuple

from .marker_sets import HEAD, PELVIS, TRUNK

LOOSE, FIRM, TIGHT = 0.03, 0.012, 0.006
"""Metres by which a joint or a marker may lie elsewhere than where it usually is."""
ANY = 1.0
"""Metres: wherever the markers say."""
Triple = tuple[float, float, float]
NOTHING: Triple = (0.0, 0.0, 0.0)


class JointOf(NamedTuple):
    """A joint of the usual body."""

    name: str
    parent: str
    play: Triple = NOTHING
    """Standard deviation of each coordinate of the offset from the parent, metres; 0: fixed."""
    ease: Triple = NOTHING
    """How far it usually turns about each axis (rotation vector), radians; 0 is any turn."""
    hinge: Triple = NOTHING
    """How far its own X axis usually leaves that of its parent, radians; 0 is any turn."""
    turns: bool = True


class MarkerOf(NamedTuple):
    """A marker of the usual body. It turns with a bone and is placed from an anchor."""

    spot: str
    bone: str
    anchor: str
    play: float
    """Standard deviation of each coordinate of its offset from the anchor, metres."""
    offset: Triple | None = None
    """Usual offset in the axes of the bone; None: as the first guess of the poses has it."""
    noise: float = 0.010
    """By how much it moves on the bone with the skin, metres."""


BENDS: Triple = (0.4, 0.4, 0.4)
CENTRE = (
    JointOf("hips", ""),
    JointOf("spine", "hips", (0.0, TIGHT, TIGHT), BENDS),
    JointOf("chest", "spine", (0.0, TIGHT, TIGHT), BENDS),
    JointOf("neck", "chest", (0.0, TIGHT, TIGHT), BENDS),
    JointOf("head", "neck", (0.0, TIGHT, FIRM), BENDS),
    JointOf("head_end", "head", turns=False),
)
SIDE = (
    JointOf("Shoulder", "chest", (TIGHT, TIGHT, TIGHT), (0.05, 0.5, 0.5)),
    JointOf("UpperArm", "Shoulder", (FIRM, FIRM, FIRM)),
    JointOf("LowerArm", "UpperArm", (FIRM, 0.0, 0.0), hinge=(0.0, 0.0, 0.5)),
    JointOf("Hand", "LowerArm", (FIRM, 0.0, 0.0), (0.15, 1.0, 1.0)),
    JointOf("Hand_end", "Hand", turns=False),
    JointOf("UpperLeg", "hips", (LOOSE, LOOSE, LOOSE)),
    JointOf("LowerLeg", "UpperLeg", (0.0, 0.0, ANY), hinge=(0.0, 0.1, 0.1)),
    JointOf("Foot", "LowerLeg", (0.0, 0.0, ANY), (1.0, 1.0, 1.0)),
    JointOf("Toes", "Foot", turns=False),
    JointOf("Toes_end", "Toes", turns=False),
)
CENTRE_MARKERS = (
    *(MarkerOf(spot, "hips", "hips", TIGHT) for spot in PELVIS),
    *(MarkerOf(spot, "chest", "neck", TIGHT) for spot in TRUNK),
    *(MarkerOf(spot, "head", "head", TIGHT) for spot in HEAD),
)  # fmt: skip
SIDE_MARKERS = (
    MarkerOf("SHO", "Shoulder", "UpperArm", FIRM, (0.0, 0.0, 0.05)),
    MarkerOf("UPA", "UpperArm", "UpperArm", LOOSE, noise=0.015),
    MarkerOf("ELB", "UpperArm", "LowerArm", FIRM, (0.0, 0.0, 0.045)),
    MarkerOf("FRM", "LowerArm", "LowerArm", LOOSE, noise=0.015),
    MarkerOf("WRA", "LowerArm", "Hand", TIGHT),
    MarkerOf("WRB", "LowerArm", "Hand", TIGHT),
    MarkerOf("FIN", "Hand", "Hand", TIGHT),
    MarkerOf("THI", "UpperLeg", "UpperLeg", LOOSE, noise=0.015),
    MarkerOf("KNE", "UpperLeg", "LowerLeg", FIRM, (0.06, 0.0, 0.0)),
    MarkerOf("TIB", "LowerLeg", "LowerLeg", LOOSE, noise=0.015),
    MarkerOf("ANK", "LowerLeg", "Foot", FIRM, (0.045, 0.0, 0.0)),
    MarkerOf("HEE", "Foot", "Foot", TIGHT),
    MarkerOf("TOE", "Foot", "Foot", TIGHT),
    MarkerOf("MT5", "Foot", "Foot", TIGHT),
)
SIDES = {"left": ("L", 1.0), "right": ("R", -1.0)}
"""First letter of a side's markers, and where it lies along X."""
NEEDED = (
    ("chest", ("C7", "CLAV", "T10", "STRN")),
    ("head", ("LFHD", "RFHD", "LBHD", "RBHD")),
    ("Shoulder", ("SHO", "ELB")),
    ("LowerArm", ("WRA", "WRB")),
    ("Hand", ("FIN",)),
    ("Foot", ("HEE", "TOE")),
)
"""Markers without which a part of the body, and what hangs on it, is left out."""
