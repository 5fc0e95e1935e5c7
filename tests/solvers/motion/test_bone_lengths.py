"""Bone lengths change; directions and style of the motion do not."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Skeleton, fit_bone_lengths, forward_kinematics, transfer_motion


@pytest.fixture
def resized(body, rng) -> Skeleton:
    """Legs are longer by a fifth, other bones have random lengths."""
    scale = rng.uniform(0.7, 1.4, size=(body.n_joints, 1))
    for joint, name in enumerate(body.names):
        if name.endswith(("Leg", "Foot")):
            scale[joint] = 1.2
    return Skeleton(body.names, body.parents, scale * body.offsets)


def test_equals_the_same_rotations_on_the_other_skeleton(lively, resized):
    """Both change lengths along the same directions, by different methods."""
    positions = forward_kinematics(lively).positions

    fitted = fit_bone_lengths(positions, resized)

    moved = forward_kinematics(transfer_motion(lively, resized)).positions
    assert_allclose(fitted - fitted[:, :1], moved - moved[:, :1], atol=1e-12)


def test_changing_lengths_back_restores_the_motion(lively, resized):
    positions = forward_kinematics(lively).positions

    back = fit_bone_lengths(fit_bone_lengths(positions, resized), lively.skeleton)

    assert_allclose(back, positions, atol=1e-12)


def test_missing_joints_make_their_descendants_missing(lively, resized):
    positions = forward_kinematics(lively).positions
    arm = lively.skeleton.index("LeftArm")
    positions[5, arm] = np.nan

    fitted = fit_bone_lengths(positions, resized)

    hidden = np.isnan(fitted[5]).all(axis=-1)
    assert set(np.flatnonzero(hidden)) == set(lively.skeleton.subtree(arm))
    assert np.isfinite(fitted[6:]).all()


def test_bone_of_length_zero_has_the_rest_direction(leg):
    positions = np.zeros((1, 4, 3))

    assert_allclose(
        fit_bone_lengths(positions, leg)[0, 1:], leg.rest_positions[1:] - leg.offsets[0]
    )


def test_longer_legs_make_longer_steps(lively, resized):
    moved = transfer_motion(lively, resized)

    travel, old_travel = (np.ptp(one.root_positions, axis=0) for one in (moved, lively))
    assert_allclose(travel, 1.2 * old_travel)
    assert_allclose(moved.root_positions[:, 2], 1.2 * lively.root_positions[:, 2])
    assert_allclose(moved.root_positions[0, :2], lively.root_positions[0, :2])
    assert_allclose(moved.rotations, lively.rotations)


def test_scaled_body_performs_the_scaled_motion(lively):
    skeleton = lively.skeleton
    doubled = Skeleton(skeleton.names, skeleton.parents, 2.0 * skeleton.offsets)
    start = lively.root_positions[0] * (1, 1, 0)

    moved = forward_kinematics(transfer_motion(lively, doubled)).positions

    expected = start + 2.0 * (forward_kinematics(lively).positions - start)
    assert_allclose(moved, expected, atol=1e-12)


def test_root_scales_with_the_height_without_legs(swinging_leg, leg):
    longer = Skeleton(leg.names, leg.parents, 1.5 * leg.offsets)

    moved = transfer_motion(swinging_leg, longer)

    assert_allclose(moved.root_positions[:, 2], 1.5 * swinging_leg.root_positions[:, 2])


def test_resizing_raises_for_other_joints(lively, leg):
    with pytest.raises(InvalidMotionError, match="retarget the motion instead"):
        transfer_motion(lively, leg)
    with pytest.raises(InvalidMotionError, match=r"need shape \(n_frames, 4, 3\)"):
        fit_bone_lengths(np.zeros((2, 3, 3)), leg)
