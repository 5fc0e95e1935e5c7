"""Clips of rigs with other rest poses must read as the same humanoid motion."""

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


def test_a_rig_that_rests_in_the_t_pose_needs_no_alignment(body):
    alignment = t_pose_alignment(body, find_humanoid_map(body))

    assert_allclose(alignment, np.tile(IDENTITY, (body.n_joints, 1)), atol=1e-12)


@pytest.mark.parametrize("lowered", [0.3, 0.8, np.pi / 2])
def test_the_same_motion_reads_the_same_from_an_a_pose(lively, lowered):
    """Rest the same body with lowered arms and spread legs; let every bone move as before."""
    turns = rest_turns(lively.skeleton, lowered)
    humanoid = find_humanoid_map(lively.skeleton)

    a_pose = rested_otherwise(lively, turns)

    assert_allclose(
        forward_kinematics(a_pose).positions, forward_kinematics(lively).positions, atol=1e-12
    )
    assert angle_between(a_pose.rotations, lively.rotations).max() > 0.25
    error = angle_between(canonical_rotations(a_pose, humanoid), lively.rotations)
    assert error.max() < 1e-7


def test_identity_in_canonical_terms_is_the_t_pose(body):
    """What canonical identity looks like on an A-pose rig: level arms."""
    humanoid = find_humanoid_map(body)
    still = Motion(body, np.tile(IDENTITY, (1, body.n_joints, 1)), body.offsets[:1], 30.0)
    a_pose = rested_otherwise(still, rest_turns(body, 0.7)).skeleton

    raised = from_canonical(still.rotations, a_pose, humanoid)

    posed = forward_kinematics(Motion(a_pose, raised, body.offsets[:1], 30.0)).positions[0]
    assert_allclose(posed, body.rest_positions, atol=1e-12)


def test_returning_from_canonical_is_exact(lively):
    humanoid = find_humanoid_map(lively.skeleton)
    a_pose = rested_otherwise(lively, rest_turns(lively.skeleton, 0.6))

    back = from_canonical(canonical_rotations(a_pose, humanoid), a_pose.skeleton, humanoid)

    assert angle_between(back, a_pose.rotations).max() < 1e-7
    assert_allclose(back, a_pose.rotations, atol=1e-14)


def test_gaps_stay_gaps_and_touch_nothing_else(lively):
    rotations = lively.rotations.copy()
    rotations[10:20, 5] = np.nan
    humanoid = find_humanoid_map(lively.skeleton)

    canonical = canonical_rotations(lively.with_poses(rotations), humanoid)

    assert np.isnan(canonical[10:20, 5]).all()
    assert np.isnan(canonical).sum() == 10 * 4


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_a_rig_that_rests_lying_or_facing_elsewhere_is_set_upright(lively, axis, quarters):
    turn = quaternion_from_rotation_vector(np.eye(3)[axis] * quarters * np.pi / 2)
    turned = rested_otherwise(lively, np.tile(turn, (lively.n_joints, 1)))

    canonical = canonical_rotations(turned, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_the_height_of_the_ankle_is_no_pose(body):
    """A boot with a heel still stands flat in the rest pose."""
    offsets = body.offsets.copy()
    for side in ("Left", "Right"):
        offsets[body.index(f"{side}ToeBase"), 2] *= 2.0
    booted = Skeleton(body.names, body.parents, offsets)

    alignment = t_pose_alignment(booted, find_humanoid_map(booted))

    assert_allclose(alignment, np.tile(IDENTITY, (body.n_joints, 1)), atol=1e-12)


def test_spread_legs_may_have_tilted_feet(lively):
    """Acclaim skeletons rest with legs spread by 20 degrees, feet and all."""
    turns = rest_turns(lively.skeleton, 0.0)
    for side in ("Left", "Right"):
        for name in ("Foot", "ToeBase", "ToeBase_end"):
            joints = lively.skeleton.index(side + name), lively.skeleton.index(f"{side}Leg")
            turns[joints[0]] = turns[joints[1]]
    tilted = rested_otherwise(lively, turns)

    canonical = canonical_rotations(tilted, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_joints_without_a_role_turn_with_the_role_above(body):
    humanoid = find_humanoid_map(body)
    a_pose = Skeleton(body.names, body.parents, turned_offsets(body, rest_turns(body, 0.5)))

    alignment = t_pose_alignment(a_pose, humanoid)

    end, hand, arm = (body.index(f"Left{name}") for name in ("Hand_end", "Hand", "ForeArm"))
    assert_allclose(alignment[end], alignment[arm])
    assert_allclose(alignment[hand], alignment[arm])


@pytest.mark.parametrize("flat", [(0, 0, 0), (1, 0, 0), (0, 0, 1)])
def test_a_rest_pose_in_one_point_or_line_is_answered(body, flat):
    """Human names, but no shape to go by: what comes out are rotations all the same."""
    squashed = Skeleton(body.names, body.parents, body.offsets * flat)

    alignment = t_pose_alignment(squashed, find_humanoid_map(body))

    assert_allclose(np.linalg.norm(alignment, axis=-1), 1.0, atol=1e-12)


def test_a_skeleton_without_roles_is_left_as_it_is(leg, swinging_leg):
    assert_allclose(
        canonical_rotations(swinging_leg, HumanoidMap()), swinging_leg.rotations, atol=1e-15
    )


def rest_turns(body: Skeleton, lowered: float) -> np.ndarray:
    """Arms lowered, legs spread, feet toed out: each joint's turn from the T-pose."""
    vectors = np.zeros((body.n_joints, 3))
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for name in ("Arm", "ForeArm", "Hand", "Hand_end"):
            vectors[body.index(side + name), 1] = sign * lowered
        for name in ("UpLeg", "Leg"):
            vectors[body.index(side + name), 1] = -sign * 0.3
        for name in ("Foot", "ToeBase", "ToeBase_end"):
            vectors[body.index(side + name), 2] = sign * 0.05
    return quaternion_from_rotation_vector(vectors)


def turned_offsets(body: Skeleton, turns: np.ndarray) -> np.ndarray:
    """Every bone turned in the rest pose; a bone belongs to the joint above it."""
    offsets = body.offsets.copy()
    offsets[1:] = rotate(turns[list(body.parents[1:])], body.offsets[1:])
    return offsets


def rested_otherwise(motion: Motion, turns: np.ndarray) -> Motion:
    """The same moving bones, measured from another rest pose: W' = W A^-1."""
    skeleton = motion.skeleton
    rested = Skeleton(skeleton.names, skeleton.parents, turned_offsets(skeleton, turns))
    world = multiply(forward_kinematics(motion).rotations, inverse(turns))
    local = world.copy()
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        local[:, joint] = multiply(inverse(world[:, parent]), world[:, joint])
    return Motion(rested, local, motion.root_positions, motion.frame_rate)


def test_a_hand_that_hangs_in_the_rest_pose_points_to_its_end_site(lively):
    """OptiTrack rests with level arms and hanging hands."""
    turns = np.tile(IDENTITY, (lively.n_joints, 1))
    for name, angle in (("LeftHand", 1.5), ("RightHand", -1.5)):
        below = lively.skeleton.subtree(lively.skeleton.index(name))
        turns[below] = quaternion_from_rotation_vector([0.0, angle, 0.0])
    hanging = rested_otherwise(lively, turns)

    canonical = canonical_rotations(hanging, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


@pytest.mark.parametrize("facing", [0.15, -0.6, 2.0])
def test_the_same_motion_reads_the_same_from_a_rest_pose_that_faces_aside(lively, facing):
    turn = quaternion_from_rotation_vector([0.0, 0.0, facing])
    aside = rested_otherwise(lively, np.tile(turn, (lively.n_joints, 1)))

    canonical = canonical_rotations(aside, find_humanoid_map(lively.skeleton))

    assert angle_between(canonical, lively.rotations).max() < 1e-7


def test_a_rest_pose_slightly_aside_faces_straight_on(body):
    """Five degrees may be anatomy, or what a sensor makes of it: the trunk stays exactly."""
    turn = quaternion_from_rotation_vector([0.0, 0.0, np.radians(5.0)])
    aside = Skeleton(body.names, body.parents, rotate(turn, body.offsets))

    alignment = t_pose_alignment(aside, find_humanoid_map(body))

    assert_allclose(alignment[body.index("Hips")], IDENTITY, atol=0.0)
