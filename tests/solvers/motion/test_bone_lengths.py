"""Bone lengths change; directions and style of the motion do not."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Skeleton, forward_kinematics, transfer_motion


@pytest.fixture
def resized(body, rng) -> Skeleton:
    """Legs are longer by a fifth, other bones have random lengths."""
    scale = rng.uniform(0.7, 1.4, size=(body.n_joints, 1))
    for joint, name in enumerate(body.names):
        if name.endswith(("Leg", "Foot")):
            scale[joint] = 1.2
    return Skeleton(body.names, body.parents, scale * body.offsets)


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
