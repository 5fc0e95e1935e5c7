"""Palms end up as the source's, for any orientation in the rest pose."""

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
def test_rotated_palms_of_the_target_rest_pose_have_no_effect(degrees):
    rig = with_all_fingers()

    default, other = retargeted(WALK, rig), retargeted(WALK, with_rotated_palms(rig, degrees))

    assert_allclose(
        forward_kinematics(other).positions, forward_kinematics(default).positions, atol=1e-6
    )


@pytest.mark.parametrize("degrees", [90.0, -90.0])
def test_rotated_palms_of_the_source_rest_pose_have_no_effect(degrees):
    """The fingers are the same in the world; the hands have another rest pose."""
    rig = with_all_fingers()
    plain = retargeted(WALK, rig)
    back = quaternion_from_rotation_vector([-np.radians(degrees), 0.0, 0.0])
    rotations = plain.rotations.copy()
    for side in ("Left", "Right"):
        hand = rig.index(f"mixamorig:{side}Hand")
        rotations[:, hand] = multiply(rotations[:, hand], back)
    rotated = Motion(
        with_rotated_palms(rig, degrees), rotations, plain.root_positions, plain.frame_rate
    )
    assert_allclose(
        forward_kinematics(rotated).positions, forward_kinematics(plain).positions, atol=1e-9
    )

    default, other = retargeted(plain, unreal()), retargeted(rotated, unreal())

    hands = [unreal().index(name) for name in ("hand_l", "hand_r")]
    result, reference = (
        forward_kinematics(one).rotations[:, hands] for one in (other, default)
    )
    assert angle_between(result, reference).max() < 1e-6


def test_slightly_oblique_knuckles_are_not_corrected():
    rig = with_all_fingers()
    other = with_rotated_palms(rig, 20.0)

    assert_allclose(
        t_pose_alignment(other, find_humanoid_map(other)),
        t_pose_alignment(rig, find_humanoid_map(rig)),
        atol=1e-12,
    )


@pytest.mark.parametrize("degrees", [30.0, 45.0, 59.0])
def test_palm_correction_is_continuous_in_the_rest_pose(degrees):
    """A threshold would leave 44 degrees and correct 46 degrees completely."""
    rigs = [with_rotated_palms(with_all_fingers(), degrees + more) for more in (0.0, 1.0)]

    one, other = (t_pose_alignment(rig, find_humanoid_map(rig)) for rig in rigs)

    assert np.degrees(angle_between(one, other)).max() < 5.0


@pytest.mark.parametrize("degrees", [40.0, 50.0])
def test_palms_are_corrected_partly(degrees):
    rig = with_rotated_palms(with_all_fingers(), degrees)
    hand = rig.index("mixamorig:LeftHand")

    rotated = t_pose_alignment(rig, find_humanoid_map(rig))[hand]

    plain = t_pose_alignment(with_all_fingers(), find_humanoid_map(with_all_fingers()))[hand]
    assert 5.0 < np.degrees(angle_between(rotated, plain)) < degrees - 5.0


def test_one_hand_is_not_corrected():
    rig = with_all_fingers()
    other = with_rotated_palms(rig, 90.0, sides=("Left",))

    assert_allclose(
        t_pose_alignment(other, find_humanoid_map(other)),
        t_pose_alignment(rig, find_humanoid_map(rig)),
        atol=1e-12,
    )


def with_rotated_palms(
    rig: Skeleton, degrees: float, sides: tuple[str, ...] = ("Left", "Right")
) -> Skeleton:
    """Rotate the level hands about the arms; at 90 degrees, palms face forward or back."""
    rotation = quaternion_from_rotation_vector([np.radians(degrees), 0.0, 0.0])
    offsets = rig.offsets.copy()
    for side in sides:
        below = rig.subtree(rig.index(f"mixamorig:{side}Hand"))[1:]
        offsets[below] = rotate(rotation, offsets[below])
    return Skeleton(rig.names, rig.parents, offsets)


def retargeted(motion: Motion, rig: Skeleton) -> Motion:
    return retarget(motion, find_humanoid_map(motion.skeleton), rig, find_humanoid_map(rig))
