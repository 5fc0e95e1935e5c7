"""A missing limb follows the body: exactly as a Gaussian says, and never at others' expense."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import denoise
from solvers.denoising.channels import BODY_POSITION, Estimate, encode
from solvers.denoising.limb_gaps import (
    BodyRelation,
    load_body_relation,
    predict_limbs,
)
from solvers.denoising.limb_gaps.adapt_relation import adapt_relation, try_gaps
from solvers.denoising.limb_gaps.body_relation import KEYS
from solvers.denoising.limb_gaps.bridges import Bridge
from solvers.errors import SolveCancelled
from solvers.motion import Motion, find_humanoid_map
from solvers.recordings import read_bvh
from solvers.rotations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import walker_skeleton
from solvers.signals import fill_channel_gaps

RATE, GAP = 30.0, slice(60, 90)
WALK = Path(__file__).parents[5] / "shared" / "data" / "mocap" / "cmu_walk" / "07_03.bvh"


def test_adapted_relation_is_the_posterior_of_a_bayesian_regression(rng):
    limb, body = rng.normal(size=(200, 3)), rng.normal(size=(200, 6))
    trials = try_gaps(limb, body, np.ones(200, dtype=bool), 20, RATE)
    general = rng.normal(size=(27, 3))

    adapted = adapt_relation(trials, general, np.zeros(3))

    for channel in range(3):
        noise = (trials.deviations[:, channel] ** 2).mean()
        x = np.concatenate([trials.features, np.sqrt(100.0 * noise) * np.eye(27)])
        y = np.concatenate([
            trials.deviations[:, channel],
            np.sqrt(100.0 * noise) * general[:, channel],
        ])
        expected = np.linalg.lstsq(x, y, rcond=None)[0]
        assert_allclose(adapted.regression[:, channel], expected, atol=1e-9)


def test_useless_relation_gets_no_weight_and_a_true_one_all(rng):
    body = np.cumsum(rng.normal(size=(600, 6)), axis=0)
    follows, alone = body[:, :3] - body[:, 3:], np.cumsum(rng.normal(size=(600, 3)), axis=0)
    known, general = np.ones(600, dtype=bool), (np.zeros((27, 3)), np.zeros(3))

    true = adapt_relation(try_gaps(follows, body, known, 30, RATE), *general)
    useless = adapt_relation(try_gaps(alone, body, known, 30, RATE), *general)

    assert true.weight > 0.95
    assert useless.weight < 0.5
    assert (true.variance < 0.2 * useless.variance).all()
    # Nothing but the line is left: the mean variance of a Brownian bridge, per frame.
    assert_allclose(useless.variance, 1.0 / 6.0, rtol=0.2)


def test_features_vanish_at_the_ends_of_a_gap(rng):
    """So a prediction joins the recording: at 3,000 Hz the first frame is near the end."""
    values = np.cumsum(rng.normal(size=(9000, 3)), axis=0) / 50.0
    bridge = Bridge(3000, 6000, 3000.0)

    features = np.concatenate(
        [bridge.missing_features(values), bridge.observed_features(values)], axis=1
    )

    size = np.abs(features).max(axis=(0, 2))
    assert (np.abs(features[[0, -1]]).max(axis=(0, 2)) < 0.05 * size).all()


def test_limb_that_mirrors_the_other_is_found_again(rng):
    """Own trials alone tell it: the general relation knows nothing."""
    truth = _swings(rng)
    recording = _without_arm(truth, GAP)
    nothing = BodyRelation(KEYS, np.zeros((360, 360)))

    channels = encode(recording)
    predicted, n_joints = predict_limbs(channels, _interpolated(channels), RATE, nothing)

    true_values = encode(truth, channels.references).flat
    missing = np.isnan(channels.flat)
    error = np.sqrt(((predicted.values - true_values)[missing] ** 2).mean())
    before = np.sqrt(((_interpolated(channels).values - true_values)[missing] ** 2).mean())
    assert n_joints == 3
    assert error < 0.45 * before  # a fifth of it stays the straight line
    assert_allclose(np.sqrt((predicted.deviation[missing] ** 2).mean()), error / 0.8, rtol=1.0)


def test_observed_samples_and_their_confidence_never_change(rng):
    recording = _without_arm(_swings(rng), GAP)
    channels = encode(recording)
    estimate = _interpolated(channels)

    predicted, _ = predict_limbs(channels, estimate, RATE, load_body_relation())

    observed = np.isfinite(channels.flat)
    assert_array_equal(predicted.values[observed], estimate.values[observed])
    assert_array_equal(predicted.deviation[observed], estimate.deviation[observed])


def test_two_limbs_missing_together_do_not_predict_each_other(rng):
    """Whatever stands in the gap of one, the other is the same."""
    recording = _without_arm(_swings(rng), GAP)
    leg = recording.skeleton.index(find_humanoid_map(recording.skeleton).joints["leftUpperLeg"])
    rotations = recording.rotations.copy()
    rotations[70:110, leg] = np.nan
    channels = encode(recording.with_poses(rotations))
    arm = np.isnan(channels.flat) & (np.arange(len(rotations)) < GAP.stop)[:, None]
    arm &= np.isnan(channels.flat[GAP.start])
    estimate = _interpolated(channels)
    part = list(channels.joints).index(leg)
    changed = estimate.values.copy()
    changed[70:110, 3 * part : 3 * part + 3] += 30.0

    results = [
        predict_limbs(channels, each, RATE, load_body_relation())[0].values[arm]
        for each in (estimate, replace(estimate, values=changed))
    ]

    assert_allclose(*results, atol=1e-9)


@pytest.mark.parametrize("gap", [slice(0, 30), slice(150, 180), slice(0, 180), slice(60, 64)])
def test_other_gaps_keep_their_estimate(rng, gap):
    """At either end of the take, throughout it, or short."""
    channels = encode(_without_arm(_swings(rng), gap))
    estimate = _interpolated(channels)

    assert predict_limbs(channels, estimate, RATE, load_body_relation()) == (estimate, 0)


def test_unknown_rig_keeps_its_estimate(swinging_leg):
    skeleton = replace(swinging_leg.skeleton, names=("base", "link", "tool", "tool_end"))
    rotations = swinging_leg.rotations.copy()
    rotations[40:80, 1] = np.nan
    channels = encode(replace(swinging_leg, skeleton=skeleton, rotations=rotations))
    estimate = _interpolated(channels)

    assert predict_limbs(channels, estimate, 60.0, load_body_relation()) == (estimate, 0)


def test_gap_without_room_for_a_trial_uses_the_general_relation(rng):
    truth = _swings(rng).slice(55, 95)
    channels = encode(_without_arm(truth, slice(5, 35)))
    estimate = _interpolated(channels)

    predicted, n_joints = predict_limbs(channels, estimate, RATE, load_body_relation())

    assert n_joints == 3
    assert np.isfinite(predicted.values).all()
    missing = np.isnan(channels.flat)
    assert predicted.deviation[missing].max() > 5.0  # as uncertain as of other people
    assert_array_equal(predicted.deviation[~missing], estimate.deviation[~missing])


def test_still_limb_is_less_certain_in_a_short_take(rng):
    """Few trials say little of how far it may move."""
    still = 0.01 * rng.normal(size=(600, 3))
    general = np.zeros((18, 3)), np.full(3, 10.0)

    short, long = (
        adapt_relation(try_gaps(still[:n], still[:n], np.ones(n, bool), 30, RATE), *general)
        for n in (60, 600)
    )

    assert_allclose(short.variance / long.variance, 20.1 / 2.1, rtol=0.05)


def test_all_joints_but_the_hips_missing(rng):
    """Only both sides of the gap and the hips are left to predict from."""
    truth = _swings(rng)
    rotations = truth.rotations.copy()
    rotations[GAP, 1:] = np.nan
    channels = encode(truth.with_poses(rotations))

    predicted, _ = predict_limbs(channels, _interpolated(channels), RATE, load_body_relation())

    assert np.isfinite(predicted.values).all()
    assert np.abs(predicted.values[:, :-3]).max() < 90.0


def test_many_gaps_need_no_more_trials(rng):
    """A gap of half a second every other second of three minutes."""
    known = np.arange(5400) % 60 < 30
    values = rng.normal(size=(5400, 3))

    trials = try_gaps(values, values, known, 15, RATE)

    assert 90 <= len(np.unique(trials.bounds, axis=0)) <= 2 * 90 + 120


def test_result_turns_with_the_axes_of_the_rig(rng):
    """A rig whose rest axes are a quarter turn about Z: X is its Y, Y its -X."""
    channels = encode(_without_arm(_swings(rng), GAP))
    rotation = quaternion_from_rotation_vector([0.0, 0.0, np.pi / 2])
    references = {key: value.copy() for key, value in channels.references.items()}
    for key in set(references) - {BODY_POSITION}:
        references[key][8:12] = multiply(rotation, references[key][8:12])
    values = channels.values.copy()
    values[:, :-1] = rotate(rotation, values[:, :-1])
    rotated = replace(channels, values=values, references=references)

    results = [
        predict_limbs(each, _interpolated(each), RATE, load_body_relation())[0]
        for each in (channels, rotated)
    ]

    predicted, also = (each.values.reshape(channels.values.shape)[GAP] for each in results)
    assert_allclose(also[:, :-1], rotate(rotation, predicted[:, :-1]), atol=1e-9)
    deviation, same = (each.deviation.reshape(channels.values.shape)[GAP] for each in results)
    assert_allclose(same[:, :-1], deviation[:, :-1, [1, 0, 2]], atol=1e-9)
    assert np.ptp(deviation[:, :-1], axis=2).max() > 0.5


def test_cancelling_ends_the_prediction(rng, cancel):
    """Many limbs that are lost one after the other may take seconds."""
    channels = encode(_without_arm(_swings(rng), GAP))

    with pytest.raises(SolveCancelled):
        predict_limbs(channels, _interpolated(channels), RATE, load_body_relation(), cancel)


def test_one_frame_has_no_gap_to_predict(rng):
    channels = encode(_swings(rng).slice(0, 1))

    assert predict_limbs(channels, _interpolated(channels), RATE, load_body_relation())[1] == 0


def test_reports_that_the_body_predicted_the_limb(rng):
    cleaned = denoise(_without_arm(_swings(rng), GAP))

    assert "Filled long gaps of 3 joints from the rest of the body." in cleaned.prior_used


@pytest.mark.skipif(not WALK.exists(), reason="recordings of ../shared/data are absent")
@pytest.mark.parametrize("limb", ["leftUpperArm", "rightUpperLeg"])
def test_limb_of_a_real_walk_is_far_nearer_than_interpolation(limb):
    take = read_bvh(WALK)
    truth = take.slice(1, take.n_frames).with_poses(
        take.rotations[1::4], take.root_positions[1::4]
    )
    truth = replace(truth, frame_rate=30.0)
    top = truth.skeleton.index(find_humanoid_map(truth.skeleton).joints[limb])
    joints, rotations = truth.skeleton.subtree(top), truth.rotations.copy()
    gap = slice(truth.n_frames // 2 - 15, truth.n_frames // 2 + 15)
    rotations[gap, joints] = np.nan

    cleaned = denoise(truth.with_poses(rotations))

    assert isinstance(cleaned.recording, Motion)
    error = angle_between(cleaned.recording.rotations, truth.rotations)[gap][:, joints[:3]]
    assert np.degrees(error).mean() < 6.0  # of interpolation: 12.8 and 18.4


def _swings(rng: np.random.Generator) -> Motion:
    """Six seconds at 30 Hz in which the left arm does as the right one, mirrored."""
    skeleton = walker_skeleton()
    roles = find_humanoid_map(skeleton).joints
    vectors = np.zeros((180, skeleton.n_joints, 3))
    time = np.arange(180.0) / RATE
    for name in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg"):
        frequencies, phases = rng.uniform(0.3, 1.2, size=3), rng.uniform(0.0, 6.0, size=3)
        wave = np.sin(2 * np.pi * frequencies * time[:, None] + phases) * np.radians(15.0)
        for side, sign in (("left", -1.0), ("right", 1.0)):
            vectors[:, skeleton.index(roles[side + name])] = wave * [1.0, sign, sign]
    roots = np.tile([0.0, 0.0, 1.0], (180, 1))
    return Motion(skeleton, quaternion_from_rotation_vector(vectors), roots, RATE)


def _without_arm(motion: Motion, gap: slice) -> Motion:
    roles = find_humanoid_map(motion.skeleton).joints
    rotations = motion.rotations.copy()
    for name in ("UpperArm", "LowerArm", "Hand"):
        rotations[gap, motion.skeleton.index(roles["left" + name])] = np.nan
    return motion.with_poses(rotations)


def _interpolated(channels) -> Estimate:
    """Return straight lines, of deviation 1."""
    values = np.nan_to_num(fill_channel_gaps(channels.flat))
    ones = np.ones_like(values)
    return Estimate(values, ones, ones, 0.0 * ones, 1, True)
