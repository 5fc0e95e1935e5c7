"""Laws for any two rigs: rest poses have no effect, hands meet, knees flex forward."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from retargeted_motions import flexion_axis, given_to, role_positions
from rigs import RIGS, mixamo, unreal

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.progress import Remark, collect_remarks, unwatched
from solvers.retargeting import RetargetSettings, RootMotion, ground_path, retarget
from solvers.rotations.representations import (
    angle_between,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
STEPS = WALK.slice(0, 30)
"""A part with a step of each foot, for laws that hold in every frame."""
LIMBS = ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")
DEFAULTS = RetargetSettings()


@cache
def positions_on_mixamo():
    return forward_kinematics(given_to(STEPS, mixamo())).positions


@cache
def positions_by_way_of_mixamo():
    return forward_kinematics(given_to(given_to(STEPS, mixamo()), unreal())).positions


@settings(max_examples=25)
@given(
    st.lists(st.floats(-0.7, 0.7), min_size=len(LIMBS), max_size=len(LIMBS)),
    st.sampled_from([0.0, np.pi / 2, np.pi, -np.pi / 2, 0.15, 0.5, -0.8, 2.5]),
)
def test_rest_pose_of_the_target_has_no_effect(angles, facing):
    """Rotate limbs about the axis from front to back, the body about the vertical."""
    posed = with_rest_pose(mixamo(), dict(zip(LIMBS, angles, strict=True)), facing)

    other = given_to(STEPS, posed)

    assert_allclose(forward_kinematics(other).positions, positions_on_mixamo(), atol=1e-6)


@settings(max_examples=25)
@given(st.lists(st.floats(-0.7, 0.7), min_size=len(LIMBS), max_size=len(LIMBS)))
def test_rest_pose_of_the_source_has_no_effect(angles):
    angle_of = dict(zip(LIMBS, angles, strict=True))
    posed = given_to(STEPS, with_rest_pose(mixamo(), angle_of, 0.0))

    other = given_to(posed, unreal())

    assert_allclose(
        forward_kinematics(other).positions, positions_by_way_of_mixamo(), atol=1e-6
    )


@pytest.mark.parametrize("family", RIGS)
def test_retargeting_back_restores_feet_and_hands(family):
    """Feet and hands are exact; joints between them depend on what the rig represents."""
    retargeted_walk = given_to(WALK, RIGS[family](1.3))

    back = given_to(retargeted_walk, WALK.skeleton)

    before, again = (forward_kinematics(motion).positions for motion in (WALK, back))
    joints = find_humanoid_map(WALK.skeleton).indices(WALK.skeleton)
    for role in ("leftFoot", "rightFoot", "leftLowerLeg", "rightLowerLeg"):
        shift = again[:, joints[role]] - before[:, joints[role]]
        assert np.ptp(shift, axis=0).max() < 0.01, role


@pytest.mark.parametrize("family", RIGS)
def test_knees_and_elbows_flex_in_the_source_directions(family):
    result = given_to(WALK, RIGS[family](0.8))

    for side in ("left", "right"):
        for roles in (("UpperLeg", "LowerLeg", "Foot"), ("UpperArm", "LowerArm", "Hand")):
            reference, actual = (flexion_axis(motion, side, roles) for motion in (WALK, result))
            lengths = [np.linalg.norm(axis, axis=1) for axis in (reference, actual)]
            clear = np.minimum(*lengths) > 0.1
            cosine = np.einsum("fi,fi->f", reference, actual) / (lengths[0] * lengths[1])
            assert cosine[clear].min() > 0.8


@pytest.mark.parametrize("family", RIGS)
def test_joints_rotate_hardly_more_than_the_source(family):
    result = given_to(WALK, RIGS[family](1.2))

    reference, actual = (roles_in_world(motion) for motion in (WALK, result))
    for role in set(reference) & set(actual):
        more = rotation_angles(actual[role]) - rotation_angles(reference[role])
        assert np.degrees(more.max()) < 5.0, role


@pytest.mark.parametrize("family", RIGS)
def test_motion_on_its_own_rig_is_unchanged_and_without_remark(family):
    rig = RIGS[family](1.0)
    own = given_to(WALK, rig)
    remarks: list[Remark] = []

    again = retarget(
        own, find_humanoid_map(rig), rig, find_humanoid_map(rig),
        progress=collect_remarks(unwatched, remarks),
    )  # fmt: skip

    assert not remarks
    before, after = (role_positions(motion) for motion in (own, again))
    for role in before:
        assert_allclose(after[role], before[role], atol=1e-3)


def test_travel_scale_is_a_setting():
    marks = given_to(WALK, mixamo(1.5), RetargetSettings(travel_scale=1.0))
    result = marks.root_positions[-1, :2] - marks.root_positions[0, :2]

    assert_allclose(result, (WALK.root_positions[-1] - WALK.root_positions[0])[:2], atol=0.03)


def test_hips_are_lowered_smoothly_for_steps_beyond_reach():
    """Steps of 1.4 times the length do not fit under hips at their height."""
    default, far = (
        given_to(WALK, mixamo(1.0), RetargetSettings(travel_scale=scale))
        for scale in (1.0, 1.4)
    )

    drop = (default.root_positions - far.root_positions)[:, 2]
    assert drop.max() > 0.01
    height = far.root_positions[:, 2]
    assert np.abs(np.diff(height, 2)).max() * far.frame_rate**2 < 20.0


def test_feet_out_of_reach_do_not_pull_the_hips_to_the_ground():
    default, torn = (
        given_to(WALK, mixamo(1.0), RetargetSettings(travel_scale=scale))
        for scale in (1.0, 20.0)
    )

    assert torn.root_positions[:, 2].min() > 0.75 * default.root_positions[:, 2].min()


def test_ground_path_rotates_with_the_body():
    circle = np.linspace(0, 2 * np.pi, 240)
    positions = np.stack([2 * np.cos(circle), 2 * np.sin(circle), np.full(240, 0.9)], axis=1)
    yaw = quaternion_from_rotation_vector(np.stack([0 * circle, 0 * circle, circle], axis=1))
    rotations = np.tile([1.0, 0, 0, 0], (240, WALK.n_joints, 1))
    rotations[:, 0] = yaw
    walk = Motion(WALK.skeleton, rotations, positions, 60.0)

    path = ground_path(walk, find_humanoid_map(walk.skeleton), smoothing=0.1)

    assert_allclose(path.positions[30:-30, :2], positions[30:-30, :2], atol=0.03)
    assert np.abs(path.positions[:, 2]).max() == 0.0
    assert angle_between(path.rotations[30:-30], yaw[30:-30]).max() < 0.05


def test_root_bone_rotation_is_optional():
    unrotated_root = RetargetSettings(root_motion=RootMotion.ROOT_BONE, turn_root=False)

    assert_allclose(given_to(WALK, unreal(), unrotated_root).rotations[:, 0, 0], 1.0)


def with_rest_pose(rig: Skeleton, angles: dict[str, float], facing: float) -> Skeleton:
    """Rotate bones of limbs in the rest pose, and the complete body about the vertical."""
    joints = find_humanoid_map(rig).indices(rig)
    offsets = rig.offsets.copy()
    for part, angle in angles.items():
        for side, sign in (("left", 1.0), ("right", -1.0)):
            rotation = quaternion_from_rotation_vector([0.0, sign * angle, 0.0])
            below = rig.subtree(joints[side + part])[1:]
            if part.endswith("Leg"):
                feet = set(rig.subtree(joints[f"{side}Foot"])[1:])
                below = [joint for joint in below if joint not in feet]
            offsets[below] = rotate(rotation, offsets[below])
    offsets = rotate(quaternion_from_rotation_vector([0.0, 0.0, facing]), offsets)
    posed = Skeleton(rig.names, rig.parents, offsets)
    ankle = joints["leftFoot"]
    offsets[0, 2] += rig.rest_positions[ankle, 2] - posed.rest_positions[ankle, 2]
    return Skeleton(rig.names, rig.parents, offsets)


def roles_in_world(motion: Motion) -> dict[str, np.ndarray]:
    rotations = forward_kinematics(motion).rotations
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return {role: rotations[:, joint] for role, joint in joints.items()}


def rotation_angles(rotations: np.ndarray) -> np.ndarray:
    return angle_between(rotations[1:], rotations[:-1])


@pytest.mark.parametrize("scale", [0.5, 0.8])
def test_straight_legs_of_shorter_steps_do_not_bend_sideways(scale):
    """Legs spread by 20 degrees, without any bend that would show a knee's axis."""
    rotations = np.zeros_like(WALK.rotations)
    rotations[..., 0] = 1.0
    roles, rig = find_humanoid_map(WALK.skeleton).indices(WALK.skeleton), mixamo(1.0)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        spread = quaternion_from_rotation_vector([0.0, sign * np.radians(20.0), 0.0])
        rotations[:, roles[f"{side}UpperLeg"]] = spread
    marks = np.tile(WALK.root_positions[0], (WALK.n_frames, 1))

    result = retarget(
        WALK.with_poses(rotations, marks), find_humanoid_map(WALK.skeleton),
        rig, find_humanoid_map(rig), settings=RetargetSettings(travel_scale=scale),
    )  # fmt: skip

    knees = find_humanoid_map(rig).indices(rig)
    for side in ("left", "right"):
        rotated = rotation_vector_from_quaternion(result.rotations[:, knees[f"{side}LowerLeg"]])
        assert np.degrees(np.abs(rotated[:, 1:]).max()) < 1.0
