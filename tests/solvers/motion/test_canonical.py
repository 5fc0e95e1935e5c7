"""Clips of rigs with different rest poses give the same canonical motion."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    canonical_rotations,
    find_humanoid_map,
    forward_kinematics,
    from_canonical,
    t_pose_alignment,
)
from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)


def test_rig_with_a_t_pose_needs_no_alignment(body):
    alignment = t_pose_alignment(body, find_humanoid_map(body))

    assert_allclose(alignment, np.tile(IDENTITY, (body.n_joints, 1)), atol=1e-12)


@pytest.mark.parametrize("lowered", [0.3, 0.8, np.pi / 2])
def test_canonical_motion_does_not_depend_on_an_a_pose(lively, lowered):
    """Lower the arms and spread the legs of the rest pose; bones move as before."""
    rotations = rest_rotations(lively.skeleton, lowered)
    humanoid = find_humanoid_map(lively.skeleton)

    a_pose = with_rest_pose(lively, rotations)

    assert_allclose(
        forward_kinematics(a_pose).positions, forward_kinematics(lively).positions, atol=1e-12
    )
    assert angle_between(a_pose.rotations, lively.rotations).max() > 0.25
    error = angle_between(canonical_rotations(a_pose, humanoid), lively.rotations)
    assert error.max() < 1e-7


def test_canonical_identity_is_the_t_pose(body):
    """On an A-pose rig, canonical identity has level arms."""
    humanoid = find_humanoid_map(body)
    still = Motion(body, np.tile(IDENTITY, (1, body.n_joints, 1)), body.offsets[:1], 30.0)
    a_pose = with_rest_pose(still, rest_rotations(body, 0.7)).skeleton

    raised = from_canonical(still.rotations, a_pose, humanoid)

    posed = forward_kinematics(Motion(a_pose, raised, body.offsets[:1], 30.0)).positions[0]
    assert_allclose(posed, body.rest_positions, atol=1e-12)


def test_from_canonical_inverts_canonical_rotations(lively):
    humanoid = find_humanoid_map(lively.skeleton)
    a_pose = with_rest_pose(lively, rest_rotations(lively.skeleton, 0.6))

    back = from_canonical(canonical_rotations(a_pose, humanoid), a_pose.skeleton, humanoid)

    assert angle_between(back, a_pose.rotations).max() < 1e-7
    assert_allclose(back, a_pose.rotations, atol=1e-14)


def test_gaps_remain_and_do_not_spread(lively):
    rotations = lively.rotations.copy()
    rotations[10:20, 5] = np.nan
    humanoid = find_humanoid_map(lively.skeleton)

    canonical = canonical_rotations(lively.with_poses(rotations), humanoid)

    assert np.isnan(canonical[10:20, 5]).all()
    assert np.isnan(canonical).sum() == 10 * 4


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_rest_pose_in_any_orientation_is_aligned_upright(lively, axis, quarters):
    rotation = quaternion_from_rotation_vector(np.eye(3)[axis] * quarters * np.pi / 2)
    rotated = with_rest_pose(lively, np.tile(rotation, (lively.n_joints, 1)))

    canonical = canonical_rotations(rotated, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_height_of_the_ankle_does_not_affect_the_alignment(body):
    """A boot with a heel stands flat in the rest pose."""
    offsets = body.offsets.copy()
    for side in ("Left", "Right"):
        offsets[body.index(f"{side}ToeBase"), 2] *= 2.0
    booted = Skeleton(body.names, body.parents, offsets)

    alignment = t_pose_alignment(booted, find_humanoid_map(booted))

    assert_allclose(alignment, np.tile(IDENTITY, (body.n_joints, 1)), atol=1e-12)


def test_spread_legs_may_have_tilted_feet(lively):
    """Acclaim skeletons have legs spread by 20 degrees in the rest pose, including feet."""
    rotations = rest_rotations(lively.skeleton, 0.0)
    for side in ("Left", "Right"):
        for name in ("Foot", "ToeBase", "ToeBase_end"):
            joints = lively.skeleton.index(side + name), lively.skeleton.index(f"{side}Leg")
            rotations[joints[0]] = rotations[joints[1]]
    tilted = with_rest_pose(lively, rotations)

    canonical = canonical_rotations(tilted, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_joints_without_a_role_rotate_with_the_role_above(body):
    humanoid = find_humanoid_map(body)
    a_pose = Skeleton(
        body.names, body.parents, rotated_offsets(body, rest_rotations(body, 0.5))
    )

    alignment = t_pose_alignment(a_pose, humanoid)

    end, hand, arm = (body.index(f"Left{name}") for name in ("Hand_end", "Hand", "ForeArm"))
    assert_allclose(alignment[end], alignment[arm])
    assert_allclose(alignment[hand], alignment[arm])


@pytest.mark.parametrize("flat", [(0, 0, 0), (1, 0, 0), (0, 0, 1)])
def test_degenerate_rest_poses_give_unit_rotations(body, flat):
    """Human names, with all joints in a point or on a line."""
    squashed = Skeleton(body.names, body.parents, body.offsets * flat)

    alignment = t_pose_alignment(squashed, find_humanoid_map(body))

    assert_allclose(np.linalg.norm(alignment, axis=-1), 1.0, atol=1e-12)


def test_skeleton_without_roles_stays_unchanged(leg, swinging_leg):
    assert_allclose(
        canonical_rotations(swinging_leg, HumanoidMap()), swinging_leg.rotations, atol=1e-15
    )


def rest_rotations(body: Skeleton, lowered: float) -> np.ndarray:
    """Rotation of each joint from the T-pose: arms lowered, legs spread, feet toed out."""
    vectors = np.zeros((body.n_joints, 3))
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for name in ("Arm", "ForeArm", "Hand", "Hand_end"):
            vectors[body.index(side + name), 1] = sign * lowered
        for name in ("UpLeg", "Leg"):
            vectors[body.index(side + name), 1] = -sign * 0.3
        for name in ("Foot", "ToeBase", "ToeBase_end"):
            vectors[body.index(side + name), 2] = sign * 0.05
    return quaternion_from_rotation_vector(vectors)


def rotated_offsets(body: Skeleton, rotations: np.ndarray) -> np.ndarray:
    """Rotate every bone of the rest pose; a bone belongs to the joint above it."""
    offsets = body.offsets.copy()
    offsets[1:] = rotate(rotations[list(body.parents[1:])], body.offsets[1:])
    return offsets


def with_rest_pose(motion: Motion, rotations: np.ndarray) -> Motion:
    """Express the same moving bones relative to another rest pose: W' = W A^-1."""
    skeleton = motion.skeleton
    rested = Skeleton(skeleton.names, skeleton.parents, rotated_offsets(skeleton, rotations))
    world = multiply(forward_kinematics(motion).rotations, inverse(rotations))
    local = world.copy()
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        local[:, joint] = multiply(inverse(world[:, parent]), world[:, joint])
    return Motion(rested, local, motion.root_positions, motion.frame_rate)


def test_hanging_hand_of_a_rest_pose_points_to_its_end_site(lively):
    """OptiTrack's rest pose has level arms and hanging hands."""
    rotations = np.tile(IDENTITY, (lively.n_joints, 1))
    for name, angle in (("LeftHand", 1.5), ("RightHand", -1.5)):
        below = lively.skeleton.subtree(lively.skeleton.index(name))
        rotations[below] = quaternion_from_rotation_vector([0.0, angle, 0.0])
    hanging = with_rest_pose(lively, rotations)

    canonical = canonical_rotations(hanging, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


@pytest.mark.parametrize("facing", [0.15, -0.6, 2.0])
def test_canonical_motion_does_not_depend_on_the_rest_heading(lively, facing):
    rotation = quaternion_from_rotation_vector([0.0, 0.0, facing])
    offset = with_rest_pose(lively, np.tile(rotation, (lively.n_joints, 1)))

    canonical = canonical_rotations(offset, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_rest_heading_of_a_few_degrees_is_not_corrected(body):
    """Five degrees may be anatomy or sensor error: the trunk remains exact."""
    rotation = quaternion_from_rotation_vector([0.0, 0.0, np.radians(5.0)])
    offset = Skeleton(body.names, body.parents, rotate(rotation, body.offsets))

    alignment = t_pose_alignment(offset, find_humanoid_map(body))

    assert_allclose(alignment[body.index("Hips")], IDENTITY, atol=0.0)
