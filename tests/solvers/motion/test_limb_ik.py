"""A limb reaches its target if it can, and does not pop at its limits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, ReachSettings, Skeleton, forward_kinematics, reach
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)

LEG = (0, 1, 2)
UP = np.array([0.0, 0.0, 0.1])


def ankle(motion: Motion, joint: int = 2) -> np.ndarray:
    return forward_kinematics(motion).positions[:, joint]


@pytest.fixture
def body_with_arm(lively) -> tuple[Motion, tuple[int, int, int]]:
    """A complete body, and the joints of its left arm."""
    joints = [lively.skeleton.index(f"Left{name}") for name in ("Arm", "ForeArm", "Hand")]
    return lively, (joints[0], joints[1], joints[2])


def test_limb_reaches_targets_in_range(swinging_leg, rng):
    targets = ankle(swinging_leg) + rng.normal(scale=0.05, size=(120, 3)) + UP

    moved = reach(swinging_leg, LEG, targets, ReachSettings(softness=0.0))

    near = np.linalg.norm(targets - swinging_leg.root_positions, axis=-1) < 0.87
    assert near.sum() > 100
    assert_allclose(ankle(moved)[near], targets[near], atol=1e-9)


def test_arm_of_a_body_reaches_its_target(body_with_arm, rng):
    body, limb = body_with_arm
    start = forward_kinematics(body).positions[:, limb[0]]
    direction = rng.normal(size=(body.n_frames, 3))
    targets = start + 0.4 * direction / np.linalg.norm(direction, axis=-1, keepdims=True)

    moved = reach(body, limb, targets)

    assert_allclose(ankle(moved, limb[2]), targets, atol=1e-9)
    changed = angle_between(moved.rotations, body.rotations).max(axis=0) > 1e-9
    assert set(np.flatnonzero(changed)) == set(limb)


def test_end_joint_keeps_its_world_orientation(body_with_arm):
    body, limb = body_with_arm
    targets = forward_kinematics(body).positions[:, limb[2]] + UP

    moved = forward_kinematics(reach(body, limb, targets)).rotations[:, limb[2]]

    assert angle_between(moved, forward_kinematics(body).rotations[:, limb[2]]).max() < 1e-7


def test_limb_at_its_target_stays_unchanged(body_with_arm, swinging_leg):
    body, limb = body_with_arm

    assert (
        angle_between(reach(body, limb, ankle(body, limb[2])).rotations, body.rotations).max()
        < 1e-6
    )
    still = reach(swinging_leg, LEG, ankle(swinging_leg))
    assert angle_between(still.rotations, swinging_leg.rotations).max() < 1e-6


def test_straight_leg_at_its_target_stays_unchanged(leg):
    straight = Motion(
        leg, np.tile([1.0, 0, 0, 0], (3, 4, 1)), np.tile([0, 0, 0.9], (3, 1)), 30.0
    )

    still = reach(straight, LEG, ankle(straight))

    assert angle_between(still.rotations, straight.rotations).max() < 1e-6


def test_straight_knee_flexes_forward_and_elbow_backward(leg):
    straight = Motion(
        leg, np.tile([1.0, 0, 0, 0], (2, 4, 1)), np.tile([0, 0, 0.9], (2, 1)), 30.0
    )
    body_with_arm = Skeleton(
        leg.names, leg.parents, np.array([[0, 0, 1.4], [0.3, 0, 0], [0.25, 0, 0], [0.1, 0, 0]])
    )
    level = Motion(body_with_arm, straight.rotations, np.tile([0, 0, 1.4], (2, 1)), 30.0)

    knee = ankle(reach(straight, LEG, ankle(straight) + UP), 1)
    elbow = ankle(reach(level, LEG, ankle(level) - (0.1, 0, 0)), 1)

    assert (knee[:, 1] < -0.1).all()
    assert (elbow[:, 1] > 0.05).all()
    assert_allclose([knee[0, 0], elbow[0, 2]], [0.0, 1.4], atol=1e-9)


def test_limb_stays_in_its_plane(swinging_leg):
    """The leg swings about X; targets in its plane keep all joints in that plane."""
    moved = reach(swinging_leg, LEG, ankle(swinging_leg) + 1.2 * UP)

    assert_allclose(forward_kinematics(moved).positions[..., 0], 0.0, atol=1e-9)


def test_limb_points_at_targets_out_of_reach(swinging_leg):
    targets = swinging_leg.root_positions + np.array([0.0, 1.0, -1.0])

    moved = ankle(reach(swinging_leg, LEG, targets)) - swinging_leg.root_positions

    length = np.linalg.norm(moved, axis=-1)
    assert (length > 0.86).all() and (length <= 0.87 + 1e-12).all()
    assert_allclose(
        moved / length[:, None], np.tile([0, 0.5**0.5, -(0.5**0.5)], (120, 1)), atol=1e-9
    )


def test_limb_folds_as_far_as_possible_for_close_targets():
    """Bones of 0.45 and 0.2 m cannot fold below 0.25 m."""
    bones = Skeleton(
        ("a", "b", "c"), (-1, 0, 1), np.array([[0, 0, 1.0], [0, 0, -0.45], [0, 0, -0.2]])
    )
    pose = quaternion_from_rotation_vector([[[0, 0, 0], [0.5, 0, 0], [0, 0, 0]]])
    still = Motion(bones, pose, np.array([[0, 0, 1.0]]), 30.0)

    moved = ankle(reach(still, LEG, np.array([[0.0, 0.05, 0.9]])))

    assert_allclose(np.linalg.norm(moved - (0, 0, 1.0)), 0.25, atol=1e-6)


def test_no_knee_pops_through_full_extension(leg):
    """A foot moves at constant speed past the leg's reach; the knee must not jump.

    Without softness, the knee angle changes infinitely fast at full extension. With it, the
    step of a frame is at most three times that of the frames before.
    """
    n = 400
    pose = np.tile(
        quaternion_from_rotation_vector([[0, 0, 0], [0.9, 0, 0], [0, 0, 0], [0, 0, 0]]),
        (n, 1, 1),
    )
    bent = Motion(leg, pose, np.tile([0, 0, 0.9], (n, 1)), 120.0)
    targets = np.stack([np.zeros(n), np.zeros(n), 0.9 - np.linspace(0.75, 0.95, n)], axis=-1)

    def largest_jerk(softness: float) -> float:
        moved = reach(bent, LEG, targets, ReachSettings(softness=softness))
        return np.abs(np.diff(angle_between(moved.rotations[:, 1], pose[:, 0]), n=2)).max()

    assert largest_jerk(0.03) < 0.1 * largest_jerk(0.0)
    assert largest_jerk(0.01) < 0.25 * largest_jerk(0.0)


def test_limb_does_not_snap_when_it_folds():
    """Bones of 0.5 and 0.3 m; the target comes nearer than their difference of 0.2 m."""
    bones = Skeleton(
        ("hip", "knee", "ankle"), (-1, 0, 1), np.array([[0, 0, 1], [0, 0, -0.5], [0, -0.3, 0]])
    )
    rest = Motion(
        bones, np.tile([1.0, 0, 0, 0], (200, 3, 1)), np.tile([0, 0, 1.0], (200, 1)), 60.0
    )
    targets = np.tile([0.0, 0.0, 1.0], (200, 1))
    targets[:, 2] -= np.linspace(0.3, 0.15, 200)

    jerks = []
    for softness in (0.0, 0.05):
        moved = reach(rest, LEG, targets, ReachSettings(softness=softness))
        distances = np.linalg.norm(ankle(moved) - [0.0, 0.0, 1.0], axis=1)
        assert distances.min() > 0.2 - 1e-9
        assert_allclose(distances[:50], np.linspace(0.3, 0.15, 200)[:50], atol=1e-9)
        knee = angle_between(moved.rotations[1:, 1], moved.rotations[:-1, 1])
        jerks.append(np.abs(np.diff(knee)).max())
    assert jerks[1] < 0.25 * jerks[0]


def test_noisy_straight_knee_does_not_flip(leg, rng):
    """One degree of jitter about straight; lifting the foot flexes the knee by 40 degrees."""
    n = 100
    vectors = np.zeros((n, 4, 3))
    vectors[:, 1] = np.radians(1.0) * rng.normal(size=(n, 3))
    vectors[-1, 1] = (0.6, 0, 0)
    motion = Motion(
        leg, quaternion_from_rotation_vector(vectors), np.tile([0, 0, 0.9], (n, 1)), 60.0
    )
    targets = np.tile([0.0, 0.0, 0.9 - 0.82], (n, 1))

    knee = ankle(reach(motion, LEG, targets), 1)

    assert (knee[:, 1] < -0.1).all()
    assert np.abs(np.diff(knee, axis=0)).max() < 0.02


def test_twist_bones_rotate_with_the_limb(leg):
    """With a twist bone in the thigh, the ankle reaches its target."""
    names = ("hip", "twist", "knee", "ankle")
    offsets = np.array([[0, 0, 0.9], [0, 0, -0.2], [0, 0, -0.25], [0, 0, -0.42]])
    vectors = np.array([[[0.1, 0, 0], [0, 0, 0.3], [0.5, 0, 0], [0, 0, 0]]])
    motion = Motion(
        Skeleton(names, (-1, 0, 1, 2), offsets),
        quaternion_from_rotation_vector(vectors),
        offsets[:1],
        30.0,
    )
    target = np.array([[0.1, -0.2, 0.25]])

    moved = reach(motion, (0, 2, 3), target)

    assert_allclose(ankle(moved, 3), target, atol=1e-9)
    assert_allclose(moved.rotations[:, 1], motion.rotations[:, 1])


def test_missing_targets_change_nothing(swinging_leg):
    targets = ankle(swinging_leg) + UP
    targets[::2] = np.nan

    moved = reach(swinging_leg, LEG, targets)

    assert_allclose(moved.rotations[::2], swinging_leg.rotations[::2], atol=0)
    assert np.isfinite(moved.rotations).all()


def test_solution_is_equivariant_to_rotation_and_translation(swinging_leg, rng):
    rotation = np.array([[np.cos(0.4), 0.0, 0.0, np.sin(0.4)]])
    targets = ankle(swinging_leg) + rng.normal(scale=0.03, size=(120, 3))
    rotations = swinging_leg.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    moved = swinging_leg.with_poses(
        rotations, rotate(rotation, swinging_leg.root_positions) + 3.0
    )

    a = reach(moved, LEG, rotate(rotation, targets) + 3.0).rotations[:, 1:]

    assert angle_between(a, reach(swinging_leg, LEG, targets).rotations[:, 1:]).max() < 1e-6


def test_solve_limb_raises_for_joints_of_no_limb(swinging_leg):
    with pytest.raises(InvalidMotionError, match="knee, hip, ankle are not"):
        reach(swinging_leg, (1, 0, 2), np.zeros((120, 3)))
    with pytest.raises(InvalidMotionError, match="Targets need shape"):
        reach(swinging_leg, LEG, np.zeros((7, 3)))
