"""Marker sets that are known well enough to draw a body, but not to solve a skeleton from.

A set is a tuple of chains of labels. "{}" stands for L and R; capitals, dots, underscores and
blanks in a label do not count, since systems write "R.Knee", "R_Knee" and "r knee".
"""

import re

MIN_LABELS = 6
"""Labels of a set that a subject must have, so that a few common words are no set. Chosen by
hand: a leg with its side of the pelvis has seven. It decides what is drawn only."""

MOTIVE_AND_QTM = (
    "HeadTop HeadFront HeadSide HeadTop",
    "HeadFront {}Head HeadTop", "HeadFront Head{} HeadTop",
    "BackTop BackLeft BackRight BackTop", "SpineTop BackL BackR SpineTop",
    "{}ShoulderTop BackTop Chest {}ShoulderTop", "{}ShoulderTop SpineTop Chest {}ShoulderTop",
    "SpineTop SpineThoracic2 SpineThoracic12 WaistBack", "BackTop HeadTop", "SpineTop HeadTop",
    "{}ShoulderTop {}ShoulderBack {}UArmHigh {}Arm {}ElbowOut {}WristOut {}HandOut",
    "{}ShoulderTop {}UArmHigh", "{}ShoulderTop {}Arm", "{}ElbowOut {}ElbowIn",
    "{}ElbowOut {}WristIn {}HandIn {}HandOut", "{}WristIn {}WristOut", "{}WristIn {}HandOut",
    "WaistLFront WaistRFront WaistRBack WaistLBack WaistLFront",
    "WaistLFront WaistL WaistBack WaistR WaistRFront", "BackLeft WaistLBack",
    "BackRight WaistRBack", "BackL WaistLBack", "BackR WaistRBack",
    "Waist{}Front {}ThighFront {}ThighSide {}Thigh {}KneeOut {}Shin {}AnkleOut",
    "{}KneeOut {}KneeIn", "{}AnkleOut {}AnkleIn",
    "{}AnkleOut {}Heel {}ToeIn {}ToeTip {}ToeOut {}AnkleOut",
    "{}AnkleOut {}HeelBack {}ForefootIn {}ToeTip {}ForefootOut {}AnkleOut",
)  # fmt: skip
HELEN_HAYES = (
    "TopHead FrontHead RearHead TopHead", "L.Temple TopHead R.Temple L.Temple",
    "L.Shoulder Sternum R.Shoulder L.Shoulder", "L.Acromium Sternum R.Acromium L.Acromium",
    "{}.Shoulder TopHead {}.Acromium", "{}.Shoulder Offset",
    "{}.Shoulder {}.Biceps {}.Bicep {}.Elbow {}.Forearm {}.Wrist",
    "{}.Acromium {}.Bicep", "{}.Elbow {}.WristLat {}.WristMed {}.Elbow",
    "V.Sacral L.ASIS R.ASIS V.Sacral", "L.ASIS R.ASIS R.PSIS L.PSIS L.ASIS",
    "V.Sacral Sternum", "V.Sacral {}.Shoulder", "L.PSIS S2 R.PSIS",
    "{}.PSIS {}.Shoulder",
    "{}.ASIS {}.GTR {}.ThighUpper {}.ThighFront {}.ThighRear {}.Thigh {}.Knee {}.HF {}.TT"
    " {}.ShankUpper {}.ShankFront {}.ShankRear {}.Shank {}.Ankle {}.Heel {}.MidfootLat {}.MT5"
    " {}.Toe",
    "{}.Knee {}.KneeMedial", "{}.Ankle {}.AnkleMedial", "{}.Ankle {}.Toe",
    "{}.ThighUpper {}.ThighRear", "{}.ShankUpper {}.ShankRear", "{}.MidfootSup {}.Heel",
    "{}.Heel {}.MT1 {}.MT2 {}.MT5", "{}.MidfootSup {}.ToeTip {}.ToeLat {}.MidfootLat",
    "{}.ToeTip {}.ToeMed {}.MidfootSup",
)  # fmt: skip
DAVIS = (
    "L.Should C7 R.Should L.Should", "C7 Sacrum", "L.ASIS R.ASIS Sacrum L.ASIS",
    "{}.ASIS {}.Thigh {}.Bar1 {}.Knee1 {}.Knee2 {}.Bar2 {}.Mall {}.Heel {}.Met {}.Mall",
)  # fmt: skip
STICK_SETS = {
    "OptiTrack Motive and Qualisys Animation": MOTIVE_AND_QTM,
    "Helen Hayes": HELEN_HAYES,
    "Davis": DAVIS,
}
"""Chains of each set. Sources: labels of OptiTrack's Baseline 41 and Core 50 sets
and of Qualisys' Animation set as exports name them, of the Helen Hayes set of Motion Analysis
and OpenSim's examples, and of the Davis protocol as BTS writes it."""


def chains_of(title: str) -> tuple[tuple[str, ...], ...]:
    """Return the chains of a set for both sides, as `plain` writes labels."""
    sided = [chain.replace("{}", side) for chain in STICK_SETS[title] for side in "LR"]
    return tuple(dict.fromkeys(tuple(map(plain, chain.split())) for chain in sided))


def plain(label: str) -> str:
    """Return a label in capitals, without separators."""
    return re.sub(r"[._ ]", "", label).upper()
