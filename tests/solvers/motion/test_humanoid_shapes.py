"""Roles found by the shape of the rest pose equal those found by names."""

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
