"""A benchmark is only as good as its peers: they must do what their names say."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import make_smoothing_spline

from solvers.motion import Motion
from solvers.rotations.representations import quaternion_from_rotation_vector
from tests.benchmarks.peers import gap_fillers, kalman, marker_fillers, smoothers
from tests.benchmarks.peers.model_averaging import model_averaging
from tests.benchmarks.shared.noise import corrupt, learn_channels
from tests.benchmarks.shared.tables import Scores


def test_gcv_spline_equals_scipys(rng):
    noisy = np.cumsum(rng.normal(size=(50, 2)), axis=0)
    frames = np.arange(50.0)

    ours = smoothers.gcv_spline(noisy, 30.0)

    theirs = [make_smoothing_spline(frames, channel)(frames) for channel in noisy.T]
    assert_allclose(ours, np.transpose(theirs), atol=1e-6)


def test_gcv_spline_over_gaps_equals_scipys(rng):
    gapped = np.cumsum(rng.normal(size=(50, 1)), axis=0)
    gapped[20:27] = np.nan
    observed = np.flatnonzero(np.isfinite(gapped[:, 0]))

    ours = smoothers.gcv_spline_over_gaps(gapped, 30.0)

    # SciPy bounds the search by the number of samples, as we do.
    theirs = make_smoothing_spline(observed.astype(float), gapped[observed, 0])(np.arange(50.0))
    assert_allclose(ours[:, 0], theirs, atol=1e-5)


def test_butterworth_halves_the_power_at_its_cutoff():
    time = np.arange(600) / 120.0
    wave = np.sin(2 * np.pi * 6.0 * time)[:, None]

    filtered = smoothers.butterworth(wave, 120.0)

    middle = slice(200, 400)
    assert_allclose(filtered[middle].std() / wave[middle].std(), np.sqrt(0.5), atol=0.01)
    assert np.abs(np.correlate(filtered[:, 0], wave[:, 0], "full")).argmax() == len(time) - 1


def test_kalman_smoother_is_the_posterior_mean(rng):
    """On a short take the posterior of a chain is one dense linear system."""
    training = [np.cumsum(rng.normal(size=(80, 3)), axis=0) for _ in range(3)]
    dynamics = kalman.learn_dynamics(training, sigma=0.5)
    measured = training[0][:40].copy()
    measured[5:9, 1] = np.nan

    smooth = kalman.smooth(dynamics, measured)

    assert_allclose(smooth, dense_posterior_mean(dynamics, measured), atol=1e-6)


def test_single_channel_kalman_equals_the_general_one(rng):
    measured = np.cumsum(rng.normal(size=(40, 1)), axis=0)
    measured[10:14] = np.nan
    F = np.array([[1.0, 1.0], [0.0, 1.0]])
    Q = 0.3**2 * np.array([[1 / 3, 1 / 2], [1 / 2, 1.0]])
    start = np.array([measured[0, 0], 0.0])
    one = np.eye(1)
    dynamics = kalman.Dynamics(F, Q, np.eye(1, 2), one, np.zeros(2), start, 1e4 * np.eye(2))

    ours = kalman.constant_velocity(measured, 30.0, 0.3)

    assert_allclose(ours[:, 0], dense_posterior_mean(dynamics, measured)[:, 0], atol=1e-5)


@pytest.mark.parametrize(
    "fill",
    [
        marker_fillers.subspace_kalman,
        marker_fillers.principal_markers,
        model_averaging,
        marker_fillers.each_coordinate(gap_fillers.linear),
    ],
)
def test_marker_fillers_rebuild_a_swinging_box(fill, rng):
    """Twelve points of one rigid body: all but interpolation must see that it is one."""
    corners = rng.uniform(-0.2, 0.2, size=(12, 3))
    angle = 0.6 * np.sin(np.arange(300) / 11.0)
    rotations = quaternion_from_rotation_vector(angle[:, None] * (0.3, 1.0, 0.2))
    truth = np.array([corners @ matrix.T for matrix in matrices(rotations)])
    gapped = truth.copy()
    gapped[100:160, 4] = np.nan

    filled = fill(gapped, 120.0)

    error = np.linalg.norm(filled - truth, axis=2)[100:160, 4].mean()
    nothing = np.linalg.norm(truth[99, 4] - truth[100:160, 4], axis=1).mean()
    assert np.isfinite(filled).all()
    assert_allclose(filled[:100], truth[:100])
    assert error < (1.5 if "each" in fill.__qualname__ else 0.2) * nothing


def test_soft_impute_completes_a_matrix_of_rank_two(rng):
    truth = rng.normal(size=(60, 2)) @ rng.normal(size=(2, 8))
    gapped = np.where(rng.random(truth.shape) < 0.1, np.nan, truth)

    filled = gap_fillers.soft_impute(gapped, 30.0, 0.003)

    missing = np.isnan(gapped)
    assert np.abs(filled - truth)[missing].mean() < 0.2 * np.abs(truth)[missing].mean()


def test_channels_restore_the_motion(swinging_leg):
    channels = learn_channels([swinging_leg])
    values = channels.values(swinging_leg)

    back = channels.motion(values, swinging_leg)

    assert_allclose(channels.values(back), values, atol=1e-9)
    assert channels.joints.tolist() == [True, True, True, False]


def test_noise_has_the_stated_deviation(rng):
    clean = np.zeros((500, 40))

    noisy = corrupt(clean, 3.0, 0.25, rng)

    # Three quarters of mean |N(0, 3)| and a quarter of the mean of 20 to 60.
    expected = 0.75 * 3.0 * np.sqrt(2 / np.pi) + 0.25 * 40.0
    assert np.abs(noisy).mean() == pytest.approx(expected, rel=0.02)


def test_paired_difference_is_computed_per_clip():
    scores = Scores("title", "unit")
    for clip, ours, other in (("a", 1.0, 3.0), ("b", 5.0, 7.0)):
        scores.add("ours", "x", clip, ours)
        scores.add("other", "x", clip, other)

    assert scores.paired("other", "x") == (2.0, 0.0)
    assert "+2.00 ± 0.00" in scores.markdown()


def matrices(rotations):
    w, x, y, z = rotations.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def dense_posterior_mean(dynamics, measured):
    """Minimise all squared misfits at once."""
    n_frames, n = len(measured), len(dynamics.F)
    A, b = [], []
    first = np.linalg.cholesky(np.linalg.inv(dynamics.spread)).T
    step = np.linalg.cholesky(np.linalg.inv(dynamics.Q)).T
    for frame in range(n_frames):
        row = np.zeros((n, n_frames * n))
        row[:, frame * n : frame * n + n] = first if frame == 0 else step
        if frame:
            row[:, (frame - 1) * n : frame * n] = -step @ dynamics.F
        A.append(row)
        b.append(first @ dynamics.start if frame == 0 else step @ dynamics.offset)
        for channel in np.flatnonzero(np.isfinite(measured[frame])):
            one = np.zeros((1, n_frames * n))
            deviation = np.sqrt(dynamics.R[channel, channel])
            one[0, frame * n : frame * n + n] = dynamics.H[channel] / deviation
            A.append(one)
            b.append([measured[frame, channel] / deviation])
    solution = np.linalg.lstsq(np.vstack(A), np.concatenate(b), rcond=None)[0]
    return solution.reshape(n_frames, n)


def test_corrupted_case_keeps_joints_without_motion(swinging_leg, rng):
    channels = learn_channels([swinging_leg])
    noisy = corrupt(channels.values(swinging_leg), 2.0, 0.0, rng)

    corrupted = channels.motion(noisy, swinging_leg)

    assert isinstance(corrupted, Motion)
    assert_allclose(corrupted.rotations[:, 3], swinging_leg.rotations[:, 3], atol=1e-12)
