"""Where names say nothing, the rest pose must: the same roles as the names would have given."""

import pytest
from rigs import RIGS, with_all_fingers

from solvers.motion import HUMANOID_ROLES, Skeleton, find_humanoid_map
from solvers.motion.humanoid.tables import FINGERS
from solvers.recordings import read_acclaim, read_bvh

BODY = [role for role in HUMANOID_ROLES if not any(finger in role for finger in FINGERS)]


@pytest.mark.parametrize("family", [*RIGS, "fingers"])
@pytest.mark.parametrize("size", [0.7, 1.0])
def test_collar_bones_twist_bones_and_fingers_mislead_nobody(family, size):
    rig = with_all_fingers() if family == "fingers" else RIGS[family](size)

    assert by_shape(rig) == by_name(rig)


@pytest.mark.parametrize(
    "name",
    ["optitrack_louise.bvh", "milad.bvh", "test_mocapbank.bvh", "xsens_walk.bvh"],
)
def test_skeletons_of_real_suits_and_cameras(recordings, name):
    skeleton = read_bvh(recordings / "formats" / "bvh" / name).skeleton

    assert by_shape(skeleton) == by_name(skeleton)


def test_poser_skeleton_but_for_two_joints_three_centimetres_apart(recordings):
    """Between buttock and thigh, lengths cannot tell where the leg begins."""
    skeleton = read_bvh(recordings / "formats" / "bvh" / "11_01.bvh").skeleton

    shape, names = by_shape(skeleton), by_name(skeleton)

    apart = {role for role in names if shape.get(role) != names[role]}
    assert apart <= {"leftUpperLeg", "rightUpperLeg"}
    for role in apart:
        assert shape[role] == skeleton.parents[names[role]]


@pytest.mark.parametrize("actor", ["bd", "bk", "dg"])
def test_acclaim_skeletons_but_for_the_last_joints_of_the_hand(recordings, actor):
    """Between wrist and hand, a few centimetres apart, proportions cannot tell."""
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
    """Roles of the same skeleton with names that mean nothing."""
    names = tuple(
        f"j{skeleton.parents[joint]}_end" if skeleton.is_end_site(joint) else f"j{joint}"
        for joint in range(skeleton.n_joints)
    )
    return by_name(Skeleton(names, skeleton.parents, skeleton.offsets))
