"""Helpers, props and odd proportions do not give a role to the wrong joint."""

import pytest
from rigs import RIGS, Row, built

from solvers.motion import Skeleton, find_humanoid_map
from solvers.motion.humanoid import explain_roles
from solvers.motion.humanoid.name_conflicts import MIN_HUMANNESS
from solvers.motion.humanoid.structure import roles_by_structure

TRUNK: tuple[Row, ...] = (
    ("Hips", "", (0.0, 0.0, 0.95)),
    ("Spine", "Hips", (0.0, 0.0, 0.1)),
    ("Chest", "Spine", (0.0, 0.0, 0.2)),
    ("Neck", "Chest", (0.0, 0.0, 0.2)),
    ("Head", "Neck", (0.0, 0.0, 0.1)),
)
WITH_HELPERS: tuple[Row, ...] = (
    *TRUNK,
    ("__UpLeg_{}", "Hips", (0.0, 0.0, 0.0)),
    ("UpLeg_{}", "__UpLeg_{}", (0.1, 0.0, -0.05)),
    ("LoLeg_{}", "UpLeg_{}", (0.0, 0.0, -0.42)),
    ("Foot_{}", "LoLeg_{}", (0.0, 0.02, -0.41)),
    ("Toe_{}", "Foot_{}", (0.0, -0.14, -0.06)),
    ("__Clavicle_{}", "Chest", (0.0, 0.0, 0.0)),
    ("Clavicle_{}", "__Clavicle_{}", (0.03, 0.0, 0.15)),
    ("UpArm_{}", "Clavicle_{}", (0.14, 0.0, 0.0)),
    ("LoArm_{}", "UpArm_{}", (0.28, 0.0, 0.0)),
    ("Hand_{}", "LoArm_{}", (0.25, 0.0, 0.0)),
)
"""Each limb begins with a helper of its name, at the joint above."""
WITH_WRISTS: tuple[Row, ...] = (
    *TRUNK,
    ("upperleg.{}", "Hips", (0.1, 0.0, -0.05)),
    ("lowerleg.{}", "upperleg.{}", (0.0, 0.0, -0.42)),
    ("foot.{}", "lowerleg.{}", (0.0, 0.02, -0.41)),
    ("toes.{}", "foot.{}", (0.0, -0.14, -0.06)),
    ("upperarm.{}", "Chest", (0.17, 0.0, 0.15)),
    ("lowerarm.{}", "upperarm.{}", (0.28, 0.0, 0.0)),
    ("wrist.{}", "lowerarm.{}", (0.25, 0.0, 0.0)),
    ("hand.{}", "wrist.{}", (0.08, 0.0, 0.0)),
)
LIKE_MIKU = {
    "Chest": ("上半身2", "上半身"),
    "Neck": ("首", "上半身2"),
    "Head": ("頭", "首"),
    "UpLeg_{}": ("{}足", "下半身"),
    "LoLeg_{}": ("{}ひざ", "{}足"),
    "Foot_{}": ("{}足首", "{}ひざ"),
    "Toe_{}": ("{}つま先", "{}足首"),
    "Clavicle_{}": ("{}肩", "上半身2"),
    "UpArm_{}": ("{}腕", "{}肩"),
    "LoArm_{}": ("{}ひじ", "{}腕"),
    "Hand_{}": ("{}手首", "{}ひじ"),
}
"""Name and parent in MikuMikuDance."""
CARTOON: tuple[Row, ...] = (
    *TRUNK,
    ("UpLeg_{}", "Hips", (0.1, 0.0, -0.05)),
    ("LoLeg_{}", "UpLeg_{}", (0.0, -0.06, -0.42)),
    ("Foot_{}", "LoLeg_{}", (0.03, 0.15, -0.21)),
    ("Toe_{}", "Foot_{}", (0.0, -0.04, -0.2)),
    ("Clavicle_{}", "Chest", (0.03, 0.0, 0.15)),
    ("UpArm_{}", "Clavicle_{}", (0.14, 0.0, 0.0)),
    ("LoArm_{}", "UpArm_{}", (0.28, 0.0, 0.0)),
    ("Hand_{}", "LoArm_{}", (0.25, 0.0, 0.0)),
)
SHORT_LEGS: tuple[Row, ...] = (
    ("pelvis_ctrl", "", (0.0, 0.0, 0.72)),
    ("back_01", "pelvis_ctrl", (0.0, 0.0, 0.12)),
    ("back_02", "back_01", (0.0, 0.03, 0.12)),
    ("top_01", "back_02", (0.0, 0.04, 0.22)),
    ("top_02", "top_01", (0.0, -0.01, 0.07)),
    ("clavicle_{}", "back_02", (0.08, 0.04, 0.15)),
    ("shoulder_{}", "clavicle_{}", (0.02, 0.0, 0.0)),
    ("bicep_{}", "shoulder_{}", (0.14, 0.0, 0.0)),
    ("elbow_{}", "bicep_{}", (0.13, 0.0, 0.0)),
    ("forearm_{}", "elbow_{}", (0.12, 0.0, 0.0)),
    ("wrist_{}", "forearm_{}", (0.11, 0.0, 0.0)),
    ("middle_01_{}", "wrist_{}", (0.16, 0.0, 0.0)),
    ("middle_02_{}", "middle_01_{}", (0.06, 0.0, 0.0)),
    ("middle_end_{}", "middle_02_{}", (0.08, 0.0, 0.0)),
    ("pivot", "pelvis_ctrl", (0.0, 0.02, -0.03)),
    ("thigh_{}", "pivot", (0.09, -0.03, -0.02)),
    ("knee_01_{}", "thigh_{}", (0.0, -0.01, -0.25)),
    ("knee_02_{}", "knee_01_{}", (0.0, 0.01, -0.05)),
    ("ankle_{}", "knee_02_{}", (0.0, 0.05, -0.29)),
    ("toe_{}", "ankle_{}", (0.0, -0.14, -0.08)),
    ("toe_end_{}", "toe_{}", (0.0, -0.16, 0.0)),
)
"""An astronaut of a game: by lengths alone, arms and legs may be either."""


@pytest.mark.parametrize(
    ("role", "joint"), [("leftUpperLeg", "UpLeg_L"), ("rightShoulder", "Clavicle_R")]
)
def test_a_helper_of_the_same_name_leaves_the_role_to_the_joint_below(role, joint):
    skeleton = built(WITH_HELPERS, ("L", "R"), 1.0)

    humanoid = find_humanoid_map(skeleton)

    assert humanoid.joint(role) == joint
    assert not explain_roles(skeleton, humanoid)[role].has_low_confidence


def test_hips_carry_arms_and_legs():
    """In MikuMikuDance the lower body is next to the upper one, below the center."""
    skeleton = built(
        (
            ("全ての親", "", (0.0, 0.0, 0.0)),
            ("センター", "全ての親", (0.0, 0.0, 0.95)),
            ("下半身", "センター", (0.0, 0.0, 0.0)),
            ("上半身", "センター", (0.0, 0.0, 0.1)),
            *(
                (*LIKE_MIKU[name], offset)
                for name, _, offset in WITH_HELPERS
                if name in LIKE_MIKU
            ),
        ),
        ("左", "右"),
        1.0,
    )

    humanoid = find_humanoid_map(skeleton)

    assert humanoid.joint("hips") == "センター"
    assert humanoid.joint("spine") == "上半身"
    assert humanoid.score == 1.0


def test_a_hand_begins_at_the_wrist():
    skeleton = built(WITH_WRISTS, ("l", "r"), 1.0)

    humanoid = find_humanoid_map(skeleton)

    assert (humanoid.joint("leftHand"), humanoid.joint("rightHand")) == ("wrist.l", "wrist.r")
    assert humanoid.score == 1.0


def test_short_shanks_do_not_make_toes_feet():
    """As of a Bitmoji that dances: only the lengths contradict its names."""
    skeleton = built(CARTOON, ("L", "R"), 1.0)
    structure = roles_by_structure(skeleton)

    humanoid = find_humanoid_map(skeleton)

    assert structure.joints["leftFoot"] == "Toe_L" and structure.humanness > MIN_HUMANNESS
    assert humanoid.joint("leftFoot") == "Foot_L"
    assert humanoid.score == 1.0


def test_names_of_arms_are_not_those_of_legs_whatever_the_lengths():
    structure = roles_by_structure(built(SHORT_LEGS, ("L", "R"), 1.0))

    assert structure.joints["leftFoot"] == "ankle_L"
    assert structure.joints["rightUpperLeg"] == "thigh_R"


@pytest.mark.parametrize("turned", [False, True])
def test_knees_show_the_sides_where_toes_point_down(turned):
    """Neither names nor feet show them, but bent knees do."""
    names = {name: f"Node_{n}" for n, name in enumerate(RIGS["Mixamo"]().names)}
    skeleton = _crouched(RIGS["Mixamo"]())
    sign = -1.0 if turned else 1.0
    unnamed = Skeleton(
        tuple(names.values()), skeleton.parents, skeleton.offsets * (sign, sign, 1.0)
    )

    structure = roles_by_structure(unnamed)

    assert structure.joints["leftUpperLeg"] == names["mixamorig:LeftUpLeg"]
    assert structure.joints["rightLowerArm"] == names["mixamorig:RightForeArm"]
    assert not structure.guesses_sides


def _crouched(skeleton: Skeleton) -> Skeleton:
    """Return a rig with bent knees, and feet that end below the ankle."""
    offsets = skeleton.offsets.copy()
    for side in ("mixamorig:Left", "mixamorig:Right"):
        offsets[skeleton.index(f"{side}Leg")] = 0.0, -0.1, -0.43
        offsets[skeleton.index(f"{side}Foot")] = 0.0, 0.1, -0.43
        offsets[skeleton.index(f"{side}ToeBase")] = 0.0, 0.0, -0.08
        offsets[skeleton.index(f"{side}Toe_end")] = 0.0, 0.0, -0.02
    return Skeleton(skeleton.names, skeleton.parents, offsets)
