"""Learn residual priors from simulated sensors with constructed errors, and apply them."""

from dataclasses import replace

import numpy as np
import pytest
from bad_sensor import (
    HAND,
    KNEE,
    NAMES,
    SMALL_PRIOR,
    pair,
    recording,
    simulate_bad_sensor,
    truth,
)
from scipy.optimize import minimize

from solvers.errors import InvalidMotionError
from solvers.motion import Tracks
from solvers.motion.humanoid.posture_heading import mirror_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import MIRROR_JOINTS
from solvers.reconstruction import (
    CorrectionMethod,
    CorrectionSettings,
    ResidualMethod,
    correct_postures,
    learn_residual_prior,
)
from solvers.reconstruction.published.residual_reconstruction import (
    ThreeTermSettings,
    minimize_terms,
    reconstruct_published_residuals,
)
from solvers.reconstruction.residual_correction.confidence import probability_within
from solvers.reconstruction.residual_correction.smooth_trajectories import (
    TrajectoryFilter,
    smooth_trajectories,
)


@pytest.fixture(scope="module")
def prior():
    return learn_residual_prior(
        [pair(truth(speed)) for speed in (0.9, 1.1, 1.45, 1.6)], settings=SMALL_PRIOR
    )


def error(positions: np.ndarray, true: np.ndarray, joint: int = KNEE) -> float:
    return float(np.linalg.norm((positions - true)[:, joint], axis=-1).mean())


def test_sensor_error_is_subtracted_from_a_new_walk(prior):
    true = truth(1.3)
    given_ = recording(simulate_bad_sensor(true))
    before = error(given_.tracks.positions, true)
    after = error(correct_postures(given_, prior).tracks.positions, true)
    assert before > 0.06
    assert after < 0.25 * before


def test_without_shift_joints_keep_their_mean_position(prior):
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    moved = correct_postures(given_, prior, settings=CorrectionSettings(shift=False))
    mean = (moved.tracks.positions - given_.tracks.positions)[:, KNEE].mean(axis=0)
    assert np.abs(mean).max() < 0.01
    shifted = correct_postures(given_, prior).tracks.positions - given_.tracks.positions
    assert np.abs(shifted[:, KNEE].mean(axis=0)).max() > 0.03


def test_prior_ignores_heading_and_position(prior):
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    angles = np.full(given_.n_frames, 2.0)
    rotated = recording(
        rotate_about_vertical(given_.tracks.positions, angles) + np.array([4.0, 1.0, 0.0])
    )
    here = correct_postures(given_, prior).tracks.positions
    moved = correct_postures(rotated, prior).tracks.positions
    np.testing.assert_allclose(
        rotate_about_vertical(here, angles) + np.array([4.0, 1.0, 0.0]), moved, atol=1e-4
    )


def test_prior_predicts_nothing_far_from_its_training_data(prior):
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    upside_down = given_.tracks.positions.copy()
    upside_down[:, 1:] = upside_down[:, :1] + (upside_down[:, 1:] - upside_down[:, :1]) * (
        1.0,
        1.0,
        -1.0,
    )
    settings = CorrectionSettings(shift=False, smoothing=0.0)
    without = replace(settings, change=0.0)
    moved = []
    for take in (recording(upside_down), given_):
        taken, left = (
            correct_postures(take, prior, settings=one).tracks.positions
            for one in (settings, without)
        )
        moved.append(np.linalg.norm(taken - left, axis=-1)[:, KNEE].max())
    assert moved[0] < 0.05 * moved[1]
    strange = correct_postures(recording(upside_down), prior, settings=settings)
    default = correct_postures(given_, prior, settings=settings)
    np.testing.assert_allclose(
        strange.confidence[:, KNEE], strange.reliability.combined[:, KNEE], atol=1e-3
    )
    assert default.confidence[:, KNEE].mean() > 0.9


def test_joint_never_observed_does_not_affect_others(prior):
    positions = simulate_bad_sensor(truth(1.3))
    positions[:, HAND] = np.nan
    result = correct_postures(recording(positions), prior)
    assert np.isnan(result.tracks.positions[:, HAND]).all()
    assert error(result.tracks.positions, truth(1.3)) < 0.02
    assert np.isfinite(np.delete(result.tracks.positions, HAND, axis=1)).all()


def test_joint_without_training_data_changes_nothing():
    """The sensor reports fingertips; the prior is of a sensor without them."""
    ends = [NAMES.index("HandRight"), NAMES.index("HandLeft")]

    def blind(positions):
        return np.where(np.isin(np.arange(20), ends)[:, None], np.nan, positions)

    takes = []
    for speed in (0.9, 1.1, 1.45, 1.6):
        observed, true = pair(truth(speed))
        takes.append((recording(blind(observed.tracks.positions)), true))
    handless = learn_residual_prior(takes, settings=SMALL_PRIOR)
    observed = simulate_bad_sensor(truth(1.3))

    with_ends, without = (
        correct_postures(recording(one), handless) for one in (observed, blind(observed))
    )

    common = [joint for joint in range(20) if joint not in ends]
    np.testing.assert_allclose(
        with_ends.confidence[:, common], without.confidence[:, common], atol=0.02
    )


def test_gaps_are_bridged(prior):
    positions = simulate_bad_sensor(truth(1.3))
    positions[40:46, KNEE] = np.nan
    result = correct_postures(recording(positions), prior)
    assert error(result.tracks.positions[40:46], truth(1.3)[40:46]) < 0.05


@pytest.mark.parametrize("n_frames", [1, 2, 3, 5, 6])
def test_correct_postures_accepts_short_takes(prior, n_frames):
    given_ = recording(simulate_bad_sensor(truth(1.3))[:n_frames])
    for method in CorrectionMethod:
        result = correct_postures(given_, prior, settings=CorrectionSettings(method=method))
        assert np.isfinite(result.tracks.positions).all()
    assert np.isfinite(reconstruct_published_residuals(given_, prior).tracks.positions).all()


def test_smoothing_solves_the_least_squares_problem(rng):
    positions, weights = rng.normal(size=(12, 2, 3)), rng.uniform(0.1, 1.0, size=(12, 2))
    second = np.diff(np.eye(12), 2, axis=0)
    found = smooth_trajectories(positions, weights, 1.7)
    for joint in range(2):
        matrix = np.diag(weights[:, joint]) + 1.7**4 * second.T @ second
        expected = np.linalg.solve(matrix, weights[:, [joint]] * positions[:, joint])
        np.testing.assert_allclose(found[:, joint], expected, atol=1e-10)


def test_smoothing_halves_sines_of_its_wavelength():
    frames = 20.0
    wave = np.sin(np.arange(2000) / frames)[:, None, None] * np.ones(3)
    found = smooth_trajectories(wave, np.ones((2000, 1)), frames)
    assert np.ptp(found[800:1200]) / np.ptp(wave) == pytest.approx(0.5, abs=0.01)


def test_filter_ends_where_the_smoother_of_past_frames_ends(rng):
    """Filter and smoother agree in the last frame if the first frame is long ago."""
    positions = np.cumsum(rng.normal(size=(60, 2, 3)), axis=0)
    weights = rng.uniform(0.2, 1.0, size=(60, 2))
    found = TrajectoryFilter(2.0).update(positions, weights)
    for last in (40, 59):
        expected = smooth_trajectories(positions[: last + 1], weights[: last + 1], 2.0)[last]
        np.testing.assert_allclose(found[last], expected, atol=1e-3)


def test_published_method_minimizes_the_published_energy(rng):
    """Minimize eq. 5.6 of [ZH14] numerically in the third frame."""
    positions = truth(1.3)[:3] + rng.normal(scale=0.02, size=(3, 20, 3))
    predicted = positions + rng.normal(scale=0.03, size=positions.shape)
    variances = rng.uniform(1e-4, 1e-3, size=(3, 20))
    reliability = rng.uniform(size=(3, 20))
    found = minimize_terms(
        recording(positions), predicted, variances, reliability, ThreeTermSettings()
    )

    def energy(offset: np.ndarray) -> float:
        y = offset * 100.0
        spatial = ((y - 100.0 * (predicted - positions)[2, KNEE]) ** 2).sum()
        smooth = 100.0 * (2.0 * found[1, KNEE] - found[0, KNEE] - positions[2, KNEE])
        return float(
            0.6 * spatial / (2.0 * 1e4 * variances[2, KNEE])
            + 0.2 * ((y - smooth) ** 2).sum()
            + 0.2 * (reliability[2, KNEE] ** 2) * (y**2).sum()
        )

    best = minimize(
        energy, np.zeros(3), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-9}
    )
    np.testing.assert_allclose(found[2, KNEE] - positions[2, KNEE], best.x, atol=1e-5)


def test_probability_within_equals_a_monte_carlo_estimate(rng):
    drawn = np.linalg.norm(rng.normal(scale=0.03, size=(200_000, 3)), axis=-1)
    assert probability_within(np.array(0.03**2), 0.05) == pytest.approx(
        (drawn < 0.05).mean(), abs=0.005
    )
    assert probability_within(np.array(np.inf), 0.05) == 0.0


def test_actor_labels_separate_actor_specific_errors():
    """One actor performs four of five takes; the sensor offsets his knee by 10 cm."""
    takes = [pair(truth(speed), 0.10) for speed in (1.0, 1.2, 1.4, 1.6)] + [
        pair(truth(1.3), 0.0)
    ]
    labeled = learn_residual_prior(takes, actors=[*"aaaa", "b"], settings=SMALL_PRIOR)
    unlabeled = learn_residual_prior(takes, settings=SMALL_PRIOR)
    given_ = recording(simulate_bad_sensor(truth(1.5), 0.05))
    sideways = [
        (correct_postures(given_, one).tracks.positions - given_.tracks.positions)[:, KNEE, 0]
        for one in (labeled, unlabeled)
    ]
    assert abs(sideways[0].mean() + 0.05) < abs(sideways[1].mean() + 0.05)


def test_learn_residual_prior_repeats_for_the_same_pairs(prior):
    again = learn_residual_prior(
        [pair(truth(speed)) for speed in (0.9, 1.1, 1.45, 1.6)], settings=SMALL_PRIOR
    )
    np.testing.assert_array_equal(prior.means, again.means)


def test_published_prior_uses_neighbors_only():
    published = learn_residual_prior(
        [pair(truth(speed)) for speed in (0.9, 1.6)],
        settings=replace(SMALL_PRIOR, method=ResidualMethod.PUBLISHED, smoothing=0.0),
    )
    kernel = published.kernel(KNEE)
    assert kernel.shared[1] < 1e-3 * kernel.shared[0]
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    result = reconstruct_published_residuals(given_, published)
    assert error(result.tracks.positions, truth(1.3)) < 0.6 * error(
        given_.tracks.positions, truth(1.3)
    )


def test_mirror_setting_pools_errors_of_left_and_right_limbs():
    """Learn from a left knee only; the right knee was never tracked."""
    takes = []
    for speed in (0.9, 1.1, 1.45, 1.6):
        observed, true = pair(truth(speed))
        unobserved = true.positions.copy()
        unobserved[:, [MIRROR_JOINTS[joint] for joint in (KNEE, KNEE + 1, KNEE + 2)]] = np.nan
        takes.append((observed, true.with_positions(unobserved)))
    both_sides = learn_residual_prior(takes, settings=replace(SMALL_PRIOR, mirror=True))
    assert "rightLowerLeg" not in both_sides.joints
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    image = recording(mirror_postures(given_.tracks.positions))
    here = correct_postures(given_, both_sides).tracks.positions
    mirrored = correct_postures(image, both_sides).tracks.positions
    np.testing.assert_allclose(mirror_postures(here), mirrored, atol=1e-6)
    moved = (mirrored - image.tracks.positions)[:, MIRROR_JOINTS[KNEE]]
    assert np.linalg.norm(moved, axis=-1).mean() > 0.03


def test_learn_residual_prior_raises_for_mismatched_pairs():
    observed, true = pair(truth(1.3))
    with pytest.raises(InvalidMotionError, match="no pair"):
        learn_residual_prior([])
    with pytest.raises(InvalidMotionError, match="90 frames at 30 Hz do not fit 80"):
        learn_residual_prior([(observed, true.slice(0, 80))])
    with pytest.raises(InvalidMotionError, match="1 pairs but 2 actors"):
        learn_residual_prior([(observed, true)], actors=["a", "b"])
    unobserved = Tracks(NAMES, np.full((90, 20, 3), np.nan), 30.0)
    with pytest.raises(InvalidMotionError, match="No joint is observed in both"):
        learn_residual_prior([(observed, unobserved)], settings=SMALL_PRIOR)
