"""Clean moves a limb on that a tracker held in its last pose."""

import numpy as np

from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    denoise,
    learn_joint_limits,
    limit_excess,
)
from solvers.rotations import angle_between

LOST = slice(40, 56)


def test_clean_moves_a_lost_arm_on(walk, arm, hold):
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


def test_strength_blends_what_was_held(walk, arm, hold):
    held = hold(walk, LOST, arm)
    full, half, none = (
        denoise(held, settings=DenoiseSettings(strength_arms=each)).recording
        for each in (1.0, 0.5, 0.0)
    )
    assert angle_between(none.rotations, held.rotations)[:, arm[0]].max() < 1e-7
    steps = np.abs(angle_between(half.rotations, held.rotations))[LOST, arm[0]]
    at_full = np.abs(angle_between(full.rotations, held.rotations))[LOST, arm[0]]
    np.testing.assert_allclose(steps, 0.5 * at_full, atol=np.radians(0.05))


def test_published_method_takes_repeats_as_they_are(walk, arm, hold):
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
