"""Clean moves a limb on that a tracker held in its last pose."""

import numpy as np
import pytest

from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    denoise,
    learn_joint_limits,
    limit_excess,
)
from solvers.motion import Motion
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

LOST = slice(40, 56)


@pytest.fixture(scope="module")
def walk() -> Motion:
    """Three seconds at 30 Hz, recorded with a jitter of 0.02 degrees."""
    motion = walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))
    vectors = np.random.default_rng(3).normal(size=(*motion.rotations.shape[:2], 3))
    noise = quaternion_from_rotation_vector(np.radians(0.02) * vectors)
    return motion.with_poses(multiply(motion.rotations, noise))


@pytest.fixture(scope="module")
def arm(walk) -> list[int]:
    return list(walk.skeleton.subtree(walk.skeleton.index("RightArm")))


def hold(motion: Motion, frames: slice, joints: list[int]) -> Motion:
    """Repeat the rotations before these frames."""
    rotations = motion.rotations.copy()
    rotations[frames, joints] = rotations[frames.start - 1, joints]
    return motion.with_poses(rotations)


def test_clean_moves_a_lost_arm_on(walk, arm):
    held = hold(walk, LOST, arm)
    result = denoise(held)
    assert result.held[LOST, arm[0]].all()
    assert "In 16 frames the tracker repeated earlier ones" in result.prior_used
    before, after = (
        np.degrees(angle_between(each.rotations, walk.rotations))[LOST, arm].mean()
        for each in (held, result.recording)
    )
    assert after < 0.5 * before
    assert result.confidence[LOST, arm[0]].min() < result.confidence[:30, arm[0]].min()


def test_strength_blends_what_was_held(walk, arm):
    held = hold(walk, LOST, arm)
    full, half, none = (
        denoise(held, settings=DenoiseSettings(strength_arms=each)).recording
        for each in (1.0, 0.5, 0.0)
    )
    assert angle_between(none.rotations, held.rotations)[:, arm[0]].max() < 1e-7
    steps = np.abs(angle_between(half.rotations, held.rotations))[LOST, arm[0]]
    at_full = np.abs(angle_between(full.rotations, held.rotations))[LOST, arm[0]]
    np.testing.assert_allclose(steps, 0.5 * at_full, atol=np.radians(0.05))


def test_published_method_takes_repeats_as_they_are(walk, arm):
    settings = DenoiseSettings(method=DenoiseMethod.PUBLISHED)
    assert not denoise(hold(walk, LOST, arm), settings=settings).held.any()


def test_limits_apply_to_what_was_held_at_any_strength(walk, arm):
    limits = learn_joint_limits([walk])
    rotations = walk.rotations.copy()
    rotations[LOST, arm[:2]] = [1.0, 0.0, 0.0, 0.0]
    held = walk.with_poses(rotations)
    beyond = limit_excess(held, limits)[LOST].max()

    result = denoise(held, limits=limits, settings=DenoiseSettings(strength=0.3))

    assert result.held[LOST, arm[0]].all()
    assert beyond > np.radians(10.0)
    assert limit_excess(result.recording, limits)[LOST].max() < 0.3 * beyond
