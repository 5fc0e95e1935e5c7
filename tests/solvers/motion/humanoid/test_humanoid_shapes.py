"""Roles found by the shape of the rest pose equal those found by names."""

import numpy as np
import pytest
from rigs import RIGS, with_all_fingers

from solvers.motion import HUMANOID_ROLES, Skeleton, find_humanoid_map
from solvers.motion.humanoid.tables import FINGERS
from solvers.recordings import read_acclaim, read_bvh

BODY = [role for role in HUMANOID_ROLES if not any(finger in role for finger in FINGERS)]


@pytest.mark.parametrize("family", [*RIGS, "fingers"])
@pytest.mark.parametrize("size", [0.7, 1.0])
def test_clavicles_twist_bones_and_fingers_are_not_confused(family, size):
    rig = with_all_fingers() if family == "fingers" else RIGS[family](size)

    assert by_shape(rig) == by_name(rig)


@pytest.mark.parametrize(
    "name",
    ["optitrack_louise.bvh", "milad.bvh", "test_mocapbank.bvh", "xsens_walk.bvh"],
)
def test_roles_by_shape_equal_those_by_name_on_real_skeletons(recordings, name):
    skeleton = read_bvh(recordings / "formats" / "bvh" / name).skeleton

    assert by_shape(skeleton) == by_name(skeleton)


def test_poser_skeleton_gets_its_roles_except_two_nearby_joints(recordings):
    """Between buttock and thigh, lengths cannot tell where the leg begins."""
    skeleton = read_bvh(recordings / "formats" / "bvh" / "11_01.bvh").skeleton

    shape, names = by_shape(skeleton), by_name(skeleton)

    different = {role for role in names if shape.get(role) != names[role]}
    assert different <= {"leftUpperLeg", "rightUpperLeg"}
    for role in different:
        assert shape[role] == skeleton.parents[names[role]]


def test_the_last_joint_of_a_short_foot_is_the_toes():
    """Shanks to the toes and forearms of one height: the last of four joints is no ankle."""
    rows = [
        ("hips", -1, (0.0, 0.0, 0.68)), ("spine", 0, (0.0, 0.0, 0.15)),
        ("chest", 1, (0.0, 0.0, 0.25)), ("neck", 2, (0.0, 0.0, 0.06)),
        ("head", 3, (0.0, 0.0, 0.05)),
    ]  # fmt: skip
    for side, sign in (("left", 1.0), ("right", -1.0)):
        limbs = [
            [("UpperArm", (0.09, 0.0, 0.0)), ("LowerArm", (0.21, 0.0, -0.11)),
             ("Hand", (0.14, -0.08, -0.09))],
            [("UpperLeg", (0.07, 0.0, -0.06)), ("LowerLeg", (0.0, -0.04, -0.26)),
             ("Foot", (0.0, 0.07, -0.27)), ("Toes", (0.0, -0.03, -0.065))],
        ]  # fmt: skip
        for limb, top in zip(limbs, (2, 0), strict=True):
            for part, (x, y, z) in limb:
                rows.append((side + part, top, (sign * x, y, z)))
                top = len(rows) - 1
    names, parents, offsets = zip(*rows, strict=True)
    skeleton = Skeleton(names, parents, np.array(offsets))

    assert by_shape(skeleton) == {name: joint for joint, name in enumerate(names)}


def test_the_ankle_is_where_the_leg_turns_forward():
    """Long limbs: the shank to the toes would fit a taller person."""
    rows = [
        ("hips", -1, (0.0, 0.0, 0.86)), ("spine", 0, (0.001, 0.0, 0.0)),
        ("chest", 1, (0.0, 0.0, 0.142)), ("upperChest", 2, (0.0, 0.009, 0.237)),
        ("neck", 3, (0.0, 0.005, 0.189)), ("head", 4, (0.0, 0.0, 0.12)),
        ("head_end", 5, (0.0, -0.013, 0.119)),
    ]  # fmt: skip
    for side, sign in (("left", 1.0), ("right", -1.0)):
        limbs = [
            [("Shoulder", (0.001, 0.005, 0.189)), ("UpperArm", (0.151, 0.0, 0.0)),
             ("LowerArm", (0.317, -0.028, 0.0)), ("Hand", (0.349, -0.062, 0.0)),
             ("Hand_end", (0.122, -0.021, 0.003))],
            [("Hip", (0.001, 0.0, 0.0)), ("UpperLeg", (0.123, 0.0, 0.0)),
             ("LowerLeg", (0.028, 0.0, -0.53)), ("Foot", (0.024, 0.0, -0.466)),
             ("Toes", (0.003, -0.128, -0.059)), ("Toes_end", (0.0, -0.097, -0.009))],
        ]  # fmt: skip
        for limb, top in zip(limbs, (3, 0), strict=True):
            for part, (x, y, z) in limb:
                rows.append((side + part, top, (sign * x, y, z)))
                top = len(rows) - 1
    names, parents, offsets = zip(*rows, strict=True)

    found = by_shape(Skeleton(names, parents, np.array(offsets)))

    for role in ("leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes", "rightFoot"):
        assert names[found[role]] == role


@pytest.mark.parametrize("actor", ["bd", "bk", "dg"])
def test_roles_by_shape_of_acclaim_skeletons_except_fingers(recordings, actor):
    """Proportions do not distinguish joints a few centimeters apart in the hand."""
    take = min((recordings / "mocap" / "hdm05").glob(f"HDM_{actor}_*.amc"))
    skeleton = read_acclaim(take).skeleton

    shape, names = by_shape(skeleton), by_name(skeleton)

    assert {role: shape.get(role) for role in names if "Hand" not in role} == {
        role: name for role, name in names.items() if "Hand" not in role
    }


def by_name(skeleton: Skeleton) -> dict[str, int]:
    found = find_humanoid_map(skeleton).indices(skeleton)
    return {role: found[role] for role in BODY if role in found}


def by_shape(skeleton: Skeleton) -> dict[str, int]:
    """Find the roles of the same skeleton with meaningless names."""
    names = tuple(
        f"j{skeleton.parents[joint]}_end" if skeleton.is_end_site(joint) else f"j{joint}"
        for joint in range(skeleton.n_joints)
    )
    return by_name(Skeleton(names, skeleton.parents, skeleton.offsets))


@pytest.mark.parametrize(
    ("name", "hand", "role"),
    [
        ("xsens_walk.bvh", "RightWrist", "rightHand"),
        ("milad.bvh", "RightHand", "rightHand"),
        ("milad.bvh", "LeftHand", "leftHand"),
    ],
)
def test_prop_or_finger_is_no_hand_where_that_is_missing(recordings, name, hand, role):
    skeleton = read_bvh(recordings / "formats" / "bvh" / name).skeleton
    complete = find_humanoid_map(skeleton)

    lacking = find_humanoid_map(without_joint(skeleton, hand))

    assert complete.joint(role) == hand
    assert lacking.joint(role) is None
    assert lacking.score < complete.score


def without_joint(skeleton, name):
    """Return the skeleton whose children of this joint hang on its parent."""
    gone = skeleton.index(name)
    offsets, parents = skeleton.offsets.copy(), list(skeleton.parents)
    for child in skeleton.children[gone]:
        offsets[child] += offsets[gone]
        parents[child] = parents[gone]
    kept = [joint for joint in range(len(parents)) if joint != gone]
    return Skeleton(
        tuple(skeleton.names[joint] for joint in kept),
        tuple(-1 if parents[j] < 0 else kept.index(parents[j]) for j in kept),
        offsets[kept],
    )
