"""Compare forward kinematics with products of matrices."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.motion import Motion, Skeleton, forward_kinematics, local_rotations, world_poses
from solvers.rotations.representations import (
    angle_between,
    matrix_from_quaternion,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)


def test_forward_kinematics_equals_a_chain_of_matrices(lively):
    world = forward_kinematics(lively)

    for frame in (0, 41, 89):
        expected = matrices(lively, frame)
        assert_allclose(world.positions[frame], expected[:, :3, 3], atol=1e-12)
        assert_allclose(
            matrix_from_quaternion(world.rotations[frame]), expected[:, :3, :3], atol=1e-12
        )


def test_identity_rotations_give_the_rest_pose(body):
    identity = np.tile([1.0, 0, 0, 0], (1, body.n_joints, 1))

    world = world_poses(body, identity, body.offsets[:1])

    assert_allclose(world.positions[0], body.rest_positions, atol=1e-15)


def test_bones_keep_their_lengths(lively):
    positions = forward_kinematics(lively).positions

    parents = list(lively.skeleton.parents[1:])
    lengths = np.linalg.norm(positions[:, 1:] - positions[:, parents], axis=-1)

    expected = np.linalg.norm(lively.skeleton.offsets[1:], axis=-1)
    assert_allclose(lengths, np.tile(expected, (lively.n_frames, 1)))


def test_local_rotations_invert_forward_kinematics(lively):
    world = forward_kinematics(lively).rotations

    assert angle_between(local_rotations(lively.skeleton, world), lively.rotations).max() < 1e-7


def test_moving_and_rotating_the_root_moves_and_rotates_all(lively):
    rotation = quaternion_from_rotation_vector([0.3, -0.2, 1.0])
    rotations = lively.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    root_positions = rotate(rotation, lively.root_positions) + 7.0

    moved = forward_kinematics(lively.with_poses(rotations, root_positions)).positions

    assert_allclose(
        moved, rotate(rotation, forward_kinematics(lively).positions) + 7.0, atol=1e-12
    )


def test_missing_joints_make_their_descendants_missing(lively):
    rotations = lively.rotations.copy()
    arm = lively.skeleton.index("LeftArm")
    rotations[4, arm] = np.nan

    world = forward_kinematics(lively.with_poses(rotations))

    hidden = np.isnan(world.positions[4]).any(axis=-1)
    assert set(np.flatnonzero(hidden)) == set(lively.skeleton.subtree(arm)) - {arm}
    assert np.isfinite(world.positions[5:]).all()


def test_forward_kinematics_accepts_leading_axes(lively):
    stacked = lively.rotations.reshape(9, 10, -1, 4)

    world = world_poses(lively.skeleton, stacked, lively.root_positions.reshape(9, 10, 3))

    flat = forward_kinematics(lively)
    assert_allclose(world.positions.reshape(90, -1, 3), flat.positions)
    one = world_poses(lively.skeleton, lively.rotations[5], lively.root_positions[5])
    assert_allclose(one.rotations, flat.rotations[5])


def test_single_joint_keeps_its_local_rotation():
    lone = Skeleton(("root",), (-1,), np.zeros((1, 3)))
    motion = Motion(lone, [[[0.6, 0.8, 0, 0]]], [[1.0, 2.0, 3.0]], 30.0)

    assert_allclose(forward_kinematics(motion).positions, [[[1.0, 2.0, 3.0]]])


def matrices(motion: Motion, frame: int) -> np.ndarray:
    """Every joint's 4 x 4 matrix in the world."""
    found = []
    for joint, parent in enumerate(motion.skeleton.parents):
        local = np.eye(4)
        local[:3, :3] = matrix_from_quaternion(motion.rotations[frame, joint])
        local[:3, 3] = motion.skeleton.offsets[joint] if joint else motion.root_positions[frame]
        found.append(found[parent] @ local if joint else local)
    return np.array(found)
