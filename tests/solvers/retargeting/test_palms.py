"""However a rig's palms face at rest, they end up as the source's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import unreal, with_all_fingers

from solvers.motion import (
    Motion,
    Skeleton,
    find_humanoid_map,
    forward_kinematics,
    t_pose_alignment,
)
from solvers.retargeting import retarget
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))


@pytest.mark.parametrize("degrees", [60.0, 90.0, -90.0, 180.0])
def test_palms_that_rest_turned_make_no_difference(degrees):
    rig = with_all_fingers()

    usual, other = given_to(WALK, rig), given_to(WALK, with_palms_turned(rig, degrees))

    assert_allclose(
        forward_kinematics(other).positions, forward_kinematics(usual).positions, atol=1e-6
    )


@pytest.mark.parametrize("degrees", [90.0, -90.0])
def test_nor_do_those_of_the_source(degrees):
    """The same fingers in the world, whose hands rest otherwise."""
    rig = with_all_fingers()
    plain = given_to(WALK, rig)
    back = quaternion_from_rotation_vector([-np.radians(degrees), 0.0, 0.0])
    rotations = plain.rotations.copy()
    for side in ("Left", "Right"):
        hand = rig.index(f"mixamorig:{side}Hand")
        rotations[:, hand] = multiply(rotations[:, hand], back)
    turned = Motion(
        with_palms_turned(rig, degrees), rotations, plain.root_positions, plain.frame_rate
    )
    assert_allclose(
        forward_kinematics(turned).positions, forward_kinematics(plain).positions, atol=1e-9
    )

    usual, other = given_to(plain, unreal()), given_to(turned, unreal())

    hands = [unreal().index(name) for name in ("hand_l", "hand_r")]
    ours, theirs = (forward_kinematics(one).rotations[:, hands] for one in (other, usual))
    assert angle_between(ours, theirs).max() < 1e-6


def test_knuckles_a_little_aslant_are_left_alone():
    rig = with_all_fingers()
    other = with_palms_turned(rig, 20.0)

    assert_allclose(
        t_pose_alignment(other, find_humanoid_map(other)),
        t_pose_alignment(rig, find_humanoid_map(rig)),
        atol=1e-12,
    )


@pytest.mark.parametrize("degrees", [30.0, 45.0, 59.0])
def test_nearly_equal_rests_are_treated_nearly_alike(degrees):
    """Before, palms turned by 44 degrees were left, and by 46 turned back wholly."""
    rigs = [with_palms_turned(with_all_fingers(), degrees + more) for more in (0.0, 1.0)]

    one, other = (t_pose_alignment(rig, find_humanoid_map(rig)) for rig in rigs)

    assert np.degrees(angle_between(one, other)).max() < 5.0


@pytest.mark.parametrize("degrees", [40.0, 50.0])
def test_palms_are_turned_back_partly(degrees):
    rig = with_palms_turned(with_all_fingers(), degrees)
    hand = rig.index("mixamorig:LeftHand")

    turned = t_pose_alignment(rig, find_humanoid_map(rig))[hand]

    plain = t_pose_alignment(with_all_fingers(), find_humanoid_map(with_all_fingers()))[hand]
    assert 5.0 < np.degrees(angle_between(turned, plain)) < degrees - 5.0


def test_one_hand_alone_tells_nothing():
    rig = with_all_fingers()
    other = with_palms_turned(rig, 90.0, sides=("Left",))

    assert_allclose(
        t_pose_alignment(other, find_humanoid_map(other)),
        t_pose_alignment(rig, find_humanoid_map(rig)),
        atol=1e-12,
    )


def with_palms_turned(
    rig: Skeleton, degrees: float, sides: tuple[str, ...] = ("Left", "Right")
) -> Skeleton:
    """Turn the hands about the arms, which lie level: by 90, palms face forward or back."""
    turn = quaternion_from_rotation_vector([np.radians(degrees), 0.0, 0.0])
    offsets = rig.offsets.copy()
    for side in sides:
        below = rig.subtree(rig.index(f"mixamorig:{side}Hand"))[1:]
        offsets[below] = rotate(turn, offsets[below])
    return Skeleton(rig.names, rig.parents, offsets)


def given_to(motion: Motion, rig: Skeleton) -> Motion:
    return retarget(motion, find_humanoid_map(motion.skeleton), rig, find_humanoid_map(rig))
