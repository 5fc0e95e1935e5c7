"""Queries with missing joints, compared with simpler methods and complete queries."""

from dataclasses import replace

import numpy as np
import pytest
from acted_clips import ACTS, act
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion.humanoid.posture_joints import PARENTS, POSTURE_JOINTS
from solvers.retrieval.postures.body_parts import JOINTS, ROOTS, BodyPart
from solvers.retrieval.postures.clip_postures import clip_postures
from solvers.retrieval.postures.mean_postures import (
    POSITION_NOISE_M,
    learn_posture_distribution,
)
from solvers.retrieval.postures.part_reliability import part_reliability

DISTRIBUTION = learn_posture_distribution([
    clip_postures(act(name, 2.5), 20.0) for name in ACTS
])
RIGHT_ARM = list(BodyPart).index(BodyPart.RIGHT_ARM)


def joint_indices(*names):
    return [POSTURE_JOINTS.index(name) for name in names]


def with_missing_joints(tracks, *names):
    positions = tracks.positions.copy()
    positions[:, joint_indices(*names)] = np.nan
    return tracks.with_positions(positions)


def with_longer_bone(tracks, joint, times):
    """Return an actor with a longer bone above this joint; its descendants move along."""
    positions, moved = tracks.positions.copy(), {joint}
    for below, above in enumerate(PARENTS):
        if above in moved:
            moved.add(below)
    direction = tracks.positions[:, joint] - tracks.positions[:, PARENTS[joint]]
    positions[:, sorted(moved)] += (times - 1.0) * direction[:, None]
    return tracks.with_positions(positions)


@pytest.mark.parametrize("name", ACTS)
@pytest.mark.parametrize("times", [0.7, 1.5])
def test_filled_joints_follow_the_actors_proportions(name, times):
    spine, chest, head = joint_indices("spine", "chest", "head")
    actor = with_longer_bone(act(name), chest, times)
    complete = clip_postures(actor, 20.0)
    observed = clip_postures(with_missing_joints(actor, "spine"), 20.0)

    found = DISTRIBUTION.fill_gaps(observed).positions

    above = [spine, chest, head]
    assert np.abs(found - complete.positions)[:, above].max() < 0.05
    assert np.abs(observed.positions - complete.positions)[:, chest].max() > 0.03
    assert not np.isfinite(observed.positions[:, spine]).any()


@pytest.mark.parametrize("heading", [0.0, 2.0, -2.8])
def test_body_without_hips_and_shoulders_gets_a_heading(heading):
    names = ("chest", "head", "leftUpperArm", "leftUpperLeg", "rightUpperLeg")
    query = with_missing_joints(act("kick", heading=heading), *names)
    found = DISTRIBUTION.fill_gaps(clip_postures(query, 20.0)).positions
    assert_allclose(found, clip_postures(act("kick"), 20.0).positions, atol=0.15)


def test_many_short_gaps_cost_little():
    complete = act("kick", frame_rate=120.0)
    gone = np.random.default_rng(0).uniform(size=complete.positions.shape[:2]) < 0.3
    gaps = complete.with_positions(np.where(gone[..., None], np.nan, complete.positions))
    # At the ends nothing bridges.
    found, true = (clip_postures(one, 20.0).positions[2:-2] for one in (gaps, complete))
    assert_allclose(found, true, atol=0.01)


def test_long_gaps_remain():
    gap = act("kick", 3.0, 120.0)
    gap.positions[100:140, joint_indices("leftFoot")] = np.nan
    found = clip_postures(gap, 20.0).positions[:, joint_indices("leftFoot")[0], 0]
    assert_array_equal(np.flatnonzero(np.isnan(found)), np.arange(17, 24))


@pytest.mark.parametrize(
    "names", [["rightLowerArm"], ["rightHand", "rightHandEnd", "head"], ["leftFoot", "spine"]]
)
def test_reliability_equals_the_explained_variance(names):
    rng = np.random.default_rng(1)
    spread = DISTRIBUTION.covariance + 1e-9 * np.eye(60)
    drawn = rng.multivariate_normal(np.zeros(60), spread, size=40_000).reshape(-1, 20, 3)
    observed = np.ones((8, 20), bool)
    observed[:, joint_indices(*names)] = False
    result = drawn[:, observed[0]].reshape(len(drawn), -1)
    result += POSITION_NOISE_M * rng.normal(size=result.shape)
    hidden = drawn[:, ~observed[0]].reshape(len(drawn), -1)
    guessed = np.zeros_like(drawn)
    guessed[:, ~observed[0]] = (
        hidden - result @ np.linalg.lstsq(result, hidden, rcond=None)[0]
    ).reshape(len(drawn), -1, 3)
    expected = [
        1.0 - _spread(guessed[:, joints] - guessed[:, [root]]) / _spread(true)
        for joints, root in zip(JOINTS, ROOTS, strict=True)
        if (true := drawn[:, joints] - drawn[:, [root]]) is not None
    ]
    assert_allclose(part_reliability(observed, DISTRIBUTION), expected, atol=0.03)


def _spread(values):
    return (values**2).sum(axis=(1, 2)).mean()


def test_reliability_falls_with_missing_joints_of_an_arm():
    reliabilities = []
    for names in ([], ["rightLowerArm"], ["rightLowerArm", "rightHand", "rightHandEnd"]):
        observed = np.ones((10, 20), bool)
        observed[1:, joint_indices(*names)] = False
        reliabilities.append(part_reliability(observed, DISTRIBUTION))
    assert_array_equal(reliabilities[0], 1.0)
    assert (
        reliabilities[0][RIGHT_ARM]
        > reliabilities[1][RIGHT_ARM]
        > reliabilities[2][RIGHT_ARM] + 0.2
    )
    assert_allclose(np.delete(reliabilities[2], RIGHT_ARM), 1.0)


def test_parts_never_observed_have_a_low_reliability_above_zero():
    reliability = part_reliability(np.zeros((3, 20), bool), DISTRIBUTION)

    assert ((reliability > 0.0) & (reliability <= 0.02)).all()


def test_joints_missing_one_after_the_other_are_filled():
    """No frame shows all joints that most frames show."""
    postures = clip_postures(act(next(iter(ACTS))), 20.0)
    positions = postures.positions.copy()
    parts = np.array_split(np.arange(len(positions)), 3)
    for frames, joint in zip(
        parts, ("leftLowerArm", "rightLowerArm", "leftLowerLeg"), strict=True
    ):
        positions[np.ix_(frames, joint_indices(joint))] = np.nan
    positions[:, joint_indices("rightToes")] = np.nan

    filled = DISTRIBUTION.fill_gaps(replace(postures, positions=positions))

    assert np.isfinite(filled.positions).all()


def test_heading_follows_the_other_joints_while_joints_are_missing_in_turn():
    """Hips and shoulders are missing; each arm and leg is lost for a third of the clip."""
    missing = ("chest", "head", "leftUpperArm", "leftUpperLeg", "rightUpperLeg")
    query = clip_postures(with_missing_joints(act("kick", heading=2.0), *missing), 20.0)
    positions = query.positions.copy()
    thirds = np.array_split(np.arange(len(positions)), 3)
    for frames, joint in zip(thirds, ("leftHand", "rightHand", "leftFoot"), strict=True):
        positions[np.ix_(frames, joint_indices(joint))] = np.nan

    found = DISTRIBUTION.fill_gaps(replace(query, positions=positions)).positions

    assert_allclose(found, clip_postures(act("kick"), 20.0).positions, atol=0.15)


def test_joints_that_all_miss_a_few_frames_are_filled():
    """Each joint is observed in most frames, and no frame shows all of them."""
    postures = clip_postures(act(next(iter(ACTS))), 20.0)
    positions = postures.positions.copy()
    for joint, frames in enumerate(np.array_split(np.arange(len(positions)), 16)):
        positions[frames, joint] = np.nan
    positions[:, joint_indices("rightToes")] = np.nan

    filled = DISTRIBUTION.fill_gaps(replace(postures, positions=positions))

    assert np.isfinite(filled.positions).all()


def test_trunk_that_leans_aside_keeps_its_heading_while_limbs_are_missing():
    """Trunks of the library lean forward; limbs, which show the heading, lack 8 frames."""
    query = clip_postures(act("kick"), 20.0)
    trunk = joint_indices("hips", "spine", "chest", "head")
    positions = query.positions.copy()
    rise = positions[:, trunk, 2] - positions[:, :1, 2]
    positions[:, trunk, 0] += np.sin(np.radians(5.0)) * rise
    complete = positions.copy()
    positions[:8, np.delete(np.arange(len(POSTURE_JOINTS)), trunk)] = np.nan

    found = DISTRIBUTION.fill_gaps(replace(query, positions=positions)).positions

    assert_allclose(found, complete, atol=0.2)
