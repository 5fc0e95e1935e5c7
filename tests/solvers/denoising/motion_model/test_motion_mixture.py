"""The mixture of windows: predictive densities and smoothing are exact."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.fft import idct
from scipy.linalg import block_diag, eigh
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from scipy.special import softmax
from scipy.stats import multivariate_normal

from solvers.denoising.motion_model import (
    MixtureSmoother,
    MotionMixture,
    load_motion_mixture,
    principal_axes,
)
from solvers.denoising.motion_model.joint_groups import find_joint_groups
from solvers.denoising.outliers import PredictiveDensity
from solvers.denoising.outliers.predictive_density import NEW_MOVEMENT_RATE
from solvers.denoising.window_priors import Windows

WINDOW = 8


AXES = Rotation.from_rotvec([0.5, -0.8, 0.3]).as_matrix()
"""Principal axes of a joint, as columns."""


@pytest.fixture
def mixture(rng):
    return random_mixture(rng, 3)


def random_mixture(rng: np.random.Generator, n_axes: int) -> MotionMixture:
    """Two components, slow and fast, with correlated coefficients."""
    decay = 10.0 / (1.0 + np.arange(WINDOW)) ** 2
    mixing = rng.normal(size=(n_axes, WINDOW, WINDOW)) / 5.0 + np.eye(WINDOW)
    covariances = mixing @ np.diag(decay**2) @ mixing.transpose(0, 2, 1)
    covariances *= 4.0 ** (1.0 - np.arange(n_axes))[:, None, None]
    return MotionMixture(
        np.array([0.7, 0.3]), np.stack([0.05 * covariances, covariances]), 30.0
    )


def equal_noise(n_joints: int = 1, deviation: float = 1.0) -> np.ndarray:
    """Covariances of noise that is equal along all axes."""
    return np.tile(deviation**2 * np.eye(3), (n_joints, 1, 1))


def basis() -> np.ndarray:
    return idct(np.eye(WINDOW), axis=0, norm="ortho")


def frame_covariance(
    mixture: MotionMixture, component: int, noise: float, axes: np.ndarray
) -> np.ndarray:
    """Covariance of the samples of a window, channels outermost."""
    to_frames = np.kron(axes, basis())
    covariance = to_frames @ block_diag(*mixture.covariances[component]) @ to_frames.T
    return covariance + noise**2 * np.eye(len(covariance))


@pytest.mark.parametrize("observed_fraction", [0.8, 0.3])
def test_predictive_density_is_the_ratio_of_two_densities(mixture, observed_fraction, rng):
    samples, noise = 5.0 * rng.normal(size=(WINDOW, 3)), 0.7
    valid = rng.random((WINDOW, 3)) < observed_fraction
    run, tested = slice(3, 5), np.array([True, False, True])
    valid[run] |= tested
    predictive = PredictiveDensity(
        samples, np.full(3, noise), Windows(WINDOW, WINDOW, 1.0), mixture, AXES
    )

    density = predictive.of_run(run, tested, valid)

    inside = np.zeros((WINDOW, 3), dtype=bool)
    inside[run] = tested
    offsets = np.stack([
        np.outer(inside[:, axis], np.arange(3) == axis).T.ravel() for axis in range(3)
    ])
    variance = (120.0 / 2.0) ** 2 / 3.0
    off = variance * offsets.T @ offsets

    def densities(known: np.ndarray, extra: np.ndarray) -> np.ndarray:
        chosen = known.T.ravel()
        total = []
        for component in range(len(mixture.weights)):
            covariance = frame_covariance(mixture, component, noise, AXES) + extra
            total.append(
                multivariate_normal.pdf(
                    samples.T.ravel()[chosen], cov=covariance[np.ix_(chosen, chosen)]
                )
            )
        return np.array(total)

    weights = mixture.weights
    both, others = densities(valid, 0.0 * off), densities(valid & ~inside, 0.0 * off)
    continued = weights @ both / (weights @ others)
    begun = weights @ (both / others)
    assert_allclose(
        density.as_movement, np.log(continued + NEW_MOVEMENT_RATE * begun), rtol=1e-6
    )
    shifted = weights @ densities(valid, off) / (weights @ others)
    assert_allclose(density.with_offset, np.log(shifted), rtol=1e-6)
    assert_allclose(density.max_gain, np.log(shifted / continued), rtol=1e-6)


@pytest.mark.parametrize("n_joints", [1, 2])
@pytest.mark.parametrize("turn", [np.eye(3), AXES])
@pytest.mark.parametrize("noise", [[0.7, 0.7, 0.7], [1.5, 0.7, 0.1]])
def test_one_window_is_smoothed_to_the_posterior_mean(rng, n_joints, noise, turn):
    """Of a joint; and of a joint together with its parent, which has twice the noise."""
    n_axes = 3 * n_joints
    mixture = random_mixture(rng, n_axes)
    samples = 5.0 * rng.normal(size=(WINDOW, n_axes))
    samples -= samples.mean(axis=0)
    own = turn @ np.diag(np.square(noise)) @ turn.T
    of_joints = [own, 4.0 * own][:n_joints]
    variance = block_diag(*of_joints)
    movement, axes = eigh(samples.T @ samples, variance)
    axes = variance @ axes
    lengths = np.linalg.norm(axes, axis=0)
    axes = (axes / lengths)[:, np.argsort(-movement * lengths**2)]
    # The parent comes first in the take, and last in the group.
    parents, take = np.arange(n_joints) - 1, np.array_split(samples, n_joints, axis=1)[::-1]

    smoothed = MixtureSmoother(np.stack(of_joints[::-1]), 30.0, [mixture], parents)(
        np.hstack(take)
    )

    assert smoothed is not None
    flat, of_noise = samples.T.ravel(), np.kron(variance, np.eye(WINDOW))
    densities, means, variances = [], [], []
    for component, weight in enumerate(mixture.weights):
        covariance = frame_covariance(mixture, component, 0.0, axes) + of_noise
        densities.append(np.log(weight) + multivariate_normal.logpdf(flat, cov=covariance))
        means.append(flat - of_noise @ np.linalg.solve(covariance, flat))
        variances.append(np.diag(of_noise - of_noise @ np.linalg.solve(covariance, of_noise)))
    shares = softmax(densities)
    for found, of_components in ((smoothed.values, means), (smoothed.variance, variances)):
        expected = np.average(of_components, axis=0, weights=shares).reshape(n_axes, WINDOW).T
        found = np.hstack(np.array_split(found, n_joints, axis=1)[::-1])
        assert_allclose(found, expected, atol=1e-5)  # the tie break of equal axes


def test_variance_has_that_between_the_components(mixture, rng):
    """Where a window may be slow or fast, the posterior is wider than either of them."""
    samples, noise = rng.normal(size=(WINDOW, 3)), 0.7
    samples -= samples.mean(axis=0)
    axes = principal_axes(samples[:, None], noise**2 * np.eye(3)[None]).to_channels[0]
    covariances = [frame_covariance(mixture, index, 0.0, axes) for index in range(2)]
    of_noise = noise**2 * np.eye(3 * WINDOW)

    def log_densities(scale: float) -> np.ndarray:
        return np.log(mixture.weights) + [
            multivariate_normal.logpdf(scale * samples.T.ravel(), cov=each + of_noise)
            for each in covariances
        ]

    scale = brentq(lambda each: np.diff(log_densities(each))[0], 0.1, 100.0)
    smoothed = MixtureSmoother(equal_noise(1, noise), 30.0, [mixture])(scale * samples)

    assert smoothed is not None
    shares, flat = softmax(log_densities(scale)), scale * samples.T.ravel()
    gains = np.stack([np.linalg.solve(each + of_noise, each) for each in covariances])
    means = flat @ gains
    within = noise**2 * shares @ np.trace(gains, axis1=1, axis2=2)
    between = shares @ np.square(means - shares @ means).sum(axis=1)
    assert_allclose(shares, 0.5, atol=1e-6)
    assert between > 0.1 * within
    assert_allclose(smoothed.variance.sum(), within + between, rtol=1e-5)


def test_joint_is_the_mean_over_itself_its_parent_and_its_children(mixture, rng):
    """The weights are inverse to the variances; so a noisy child hardly counts."""
    pairs, noise = random_mixture(rng, 6), equal_noise(4, 0.7)
    noise[3] *= 100.0
    parents = np.array([-1, 0, 1, 1])
    samples = np.cumsum(rng.normal(size=(4 * WINDOW, 12)), axis=0)

    smoothed = MixtureSmoother(noise, 30.0, [mixture, pairs], parents)(samples)

    assert smoothed is not None
    estimates = [MixtureSmoother(noise, 30.0, [mixture])(samples)]
    for pair in ([0, 1], [1, 2], [1, 3]):
        columns = [3 * joint + axis for joint in pair for axis in range(3)]
        of_pair = MixtureSmoother(noise[pair], 30.0, [pairs], np.array([-1, 0]))
        estimates.append(of_pair(samples[:, columns]))
    of_joint = [slice(3, 6), slice(3, 6), slice(0, 3), slice(0, 3)]
    values, variances = (
        np.stack([
            getattr(each, name)[:, part] for each, part in zip(estimates, of_joint, strict=True)
        ])
        for name in ("values", "variance")
    )
    weights = 1.0 / variances.mean(axis=(1, 2))
    assert_allclose(
        smoothed.values[:, 3:6], np.average(values, axis=0, weights=weights), atol=1e-9
    )
    assert_allclose(
        smoothed.variance[:, 3:6], np.average(variances, axis=0, weights=weights), atol=1e-9
    )


def test_groups_skip_joints_that_stand_still():
    """A neck that is not recorded, between chest and head."""
    parents = np.array([-1, 0, 1, 0])
    moves = np.array([True, False, True, True])

    assert find_joint_groups(parents, moves, 1).tolist() == [[0], [2], [3]]
    assert find_joint_groups(parents, moves, 2).tolist() == [[2, 0], [3, 0]]
    assert find_joint_groups(parents, moves, 3).shape == (0, 3)


@pytest.mark.parametrize("axes", [AXES, np.eye(3)[[2, 0, 1]]])
def test_axes_of_a_rigs_joints_change_nothing(mixture, rng, axes):
    """Neither does it matter what the other joints do."""
    samples, other = np.cumsum(rng.normal(size=(2, 4 * WINDOW, 3)), axis=1)
    smooth = MixtureSmoother(equal_noise(1, 0.7), 30.0, [mixture])
    smooth_two = MixtureSmoother(equal_noise(2, 0.7), 30.0, [mixture])

    smoothed, both = smooth(samples), smooth_two(np.hstack([other, samples @ axes]))

    assert smoothed is not None
    assert both is not None
    assert_allclose(both.values[:, 3:], smoothed.values @ axes, atol=1e-5)
    if (axes**2 == axes).all():
        assert_allclose(both.variance[:, 3:], smoothed.variance @ axes, atol=1e-5)


def test_rounding_does_not_choose_the_axes_of_a_circle(rng):
    """A joint that moves equally along two axes, and not along the third."""
    phases = np.arange(60) * (2.0 * np.pi / 30.0)
    circle = 20.0 * np.stack([np.cos(phases), np.sin(phases), 0.0 * phases], axis=1)
    smooth = MixtureSmoother(equal_noise(), 30.0, [load_motion_mixture()])

    smoothed, again = smooth(circle), smooth(circle + 1e-12 * rng.normal(size=circle.shape))

    assert smoothed is not None
    assert again is not None
    assert_allclose(again.values, smoothed.values, atol=1e-4)


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0])
def test_same_movement_at_any_rate(rate):
    """A slow wave comes back, and its leave-one-out error is about that of the noise."""
    rng = np.random.default_rng(0)
    time = np.arange(round(4.0 * rate)) / rate
    wave = 20.0 * np.sin(2.0 * np.pi * time[:, None] * np.array([0.5, 0.7, 0.3]))
    noisy = wave + rng.normal(size=wave.shape)

    smoothed = MixtureSmoother(equal_noise(), rate, [load_motion_mixture()])(noisy)

    assert smoothed is not None
    error = np.sqrt(((smoothed.values - wave) ** 2).mean())
    assert error < 0.7 * np.sqrt(30.0 / rate)
    assert 0.95 < smoothed.leave_one_out_error.std() < 1.35
    assert_allclose(np.sqrt(smoothed.variance.mean()), error, rtol=0.5)


def test_takes_shorter_than_a_window_are_left_to_others(mixture):
    assert MixtureSmoother(equal_noise(), 30.0, [mixture])(np.zeros((WINDOW - 1, 3))) is None
