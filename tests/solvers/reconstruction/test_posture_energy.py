"""Neighbors, spaces and energies of postures, compared with brute force."""

import numpy as np
import pytest

from solvers.motion.humanoid.body_size import (
    ADULT_BONE_LENGTHS_M,
    resize_postures,
    segment_lengths,
)
from solvers.motion.humanoid.posture_joints import PARENTS
from solvers.reconstruction.joint_rotations.library_body import BodyPostures
from solvers.reconstruction.pose_completion.constrain_lengths import constrain_lengths
from solvers.reconstruction.pose_completion.probable_posture import (
    MODEL_ERROR_M,
    probable_postures,
)
from solvers.reconstruction.pose_completion.residual_smoother import (
    ResidualFilter,
    measurement_deviation,
    smooth_residuals,
)
from solvers.reconstruction.pose_library.neighbors import (
    PostureQuery,
    index_postures,
    nearest_postures,
)
from solvers.reconstruction.pose_library.posture_groups import group_postures
from solvers.reconstruction.pose_space.posture_energy import (
    EnergyTargets,
    EnergyWeights,
    posture_energy,
)
from solvers.reconstruction.pose_space.posture_space import local_pca
from solvers.reconstruction.published.posture_search import search_postures, search_sequentially
from tests.benchmarks.reconstruction.posture_synthesis import solve_postures, solve_sequentially

N_FRAMES = 6
UP = np.array([0.0, 0.0, 2.0])


@pytest.fixture
def random():
    return np.random.default_rng(3)


@pytest.fixture
def bodies(random):
    """Postures on a few smooth paths, of an adult of default size."""
    directions = random.normal(size=(4, 20, 3))
    mixed = np.tensordot(random.normal(size=(900, 4)), directions, axes=1) + UP
    return resize_postures(mixed.cumsum(axis=1) - mixed[:, :1], ADULT_BONE_LENGTHS_M)


@pytest.fixture
def problem(bodies, random):
    observed = bodies[:N_FRAMES] + random.normal(scale=0.02, size=(N_FRAMES, 20, 3))
    observed[:, 7] = np.nan
    reliability = random.uniform(size=(N_FRAMES, 20))
    reliability[:, 4:8] = 0.0
    index = index_postures(_body(bodies[N_FRAMES:]), np.zeros(894, np.int32))
    indices, _ = nearest_postures(
        index, PostureQuery(observed, 0 * observed, reliability, 0.0), 30
    )
    spaces = local_pca(bodies[N_FRAMES:][indices])
    return spaces, EnergyTargets(observed, reliability, spaces.neighbors, ADULT_BONE_LENGTHS_M)


def _body(positions):
    single = positions.astype(np.float32)
    return BodyPostures(single, 0 * single, ADULT_BONE_LENGTHS_M)


def test_neighbors_minimize_equation_9(bodies, random):
    reliability = random.uniform(size=(5, 20))
    observed = bodies[:5] + 0.01
    observed[1, 3] = np.nan
    index = index_postures(_body(bodies), np.zeros(900, np.int32))
    indices, distances = nearest_postures(
        index, PostureQuery(observed, 0 * observed, reliability, 0.0), 12
    )
    for frame in range(5):
        errors = [
            sum(
                reliability[frame, joint] * np.sum((one[joint] - observed[frame, joint]) ** 2)
                for joint in range(20)
                if np.isfinite(observed[frame, joint]).all()
            )
            for one in bodies
        ]
        np.testing.assert_allclose(distances[frame], np.sort(errors)[:12], rtol=1e-3, atol=1e-6)
        assert set(indices[frame]) == set(np.argsort(errors)[:12])


@pytest.mark.parametrize("n_looked_at", [100, 8000], ids=["groups", "all"])
def test_frames_without_joints_get_poses_of_all_groups(bodies, n_looked_at):
    """All are equally near; which ones it gets depends on neither rounding nor numpy."""
    groups = np.repeat(np.arange(9, dtype=np.int32), 100)
    query = PostureQuery(
        np.full((2, 20, 3), np.nan), np.zeros((2, 20, 3)), np.zeros((2, 20)), 0.0
    )

    found, distances = nearest_postures(
        index_postures(_body(bodies), groups), query, 18, n_looked_at=n_looked_at
    )

    assert not distances.any()
    assert (np.bincount(groups[found[0]]) == 2).all()
    np.testing.assert_array_equal(*found)


def test_grouped_search_finds_nearly_all_true_neighbors(random):
    displacements = random.normal(size=(6, 20, 3))
    latent = random.normal(size=(12000, 6))
    shapes = (np.sin(latent) @ displacements.reshape(6, -1)).reshape(-1, 20, 3) + UP
    directions = shapes / np.linalg.norm(shapes, axis=-1, keepdims=True)
    directions[:, 0] = 0.0
    positions = resize_postures(np.cumsum(directions, axis=1), ADULT_BONE_LENGTHS_M)
    groups = group_postures(directions.astype(np.float32))
    assert len(np.unique(groups)) > 20
    reliability = random.uniform(size=(40, 20))
    reliability[:, 12:16] = 0.0
    observed = positions[:40] + random.normal(scale=0.01, size=(40, 20, 3))
    query = PostureQuery(observed, 0 * observed, reliability, 0.0)
    body = _body(positions)
    all_of_them, _ = nearest_postures(index_postures(body, 0 * groups), query, 30)
    found, _ = nearest_postures(index_postures(body, groups), query, 30, n_looked_at=3000)
    overlaps = [len(set(a) & set(b)) / 30 for a, b in zip(all_of_them, found, strict=True)]
    assert np.mean(overlaps) >= 0.95


def test_spaces_are_principal_components(problem):
    spaces, _ = problem
    for frame in range(N_FRAMES):
        deviations = spaces.neighbors[frame] - spaces.neighbors[frame].mean(axis=0)
        values = np.linalg.svd(deviations, compute_uv=False)[:20] ** 2 / 30
        real = values > 1e-8
        np.testing.assert_allclose(spaces.spreads[frame][real], values[real], rtol=1e-6)
    z = np.random.default_rng(0).normal(size=spaces.spreads.shape) * (spaces.spreads > 0)
    np.testing.assert_allclose(spaces.coordinates(spaces.postures(z)), z, atol=1e-9)


def test_energy_is_that_of_equations_10_to_15(problem):
    spaces, targets = problem
    expected = targets.neighbors[:, 0].reshape(-1, 20, 3) + 0.01
    targets = EnergyTargets(
        targets.observed, targets.reliability, targets.neighbors, targets.lengths, expected,
        EnergyWeights(1.0, 0.5, 1.5, 0.25),
    )  # fmt: skip
    x = spaces.postures(np.zeros_like(spaces.spreads))
    for frame, posture in enumerate(x):
        control = kinematics = continuity = 0.0
        for joint in range(20):
            difference = posture[joint] - targets.observed[frame, joint]
            if np.isfinite(difference).all():
                control += targets.reliability[frame, joint] * difference @ difference
            difference = posture[joint] - expected[frame, joint]
            continuity += difference @ difference / 20
            if joint:
                length = np.linalg.norm(posture[joint] - posture[PARENTS[joint]])
                kinematics += (length - ADULT_BONE_LENGTHS_M[joint]) ** 2 / 19
        others = targets.neighbors[frame].reshape(-1, 20, 3)
        style = min(np.sum((posture - one) ** 2) / 20 for one in others)
        total = control + 0.5 * style + 1.5 * kinematics + 0.25 * continuity
        assert posture_energy(x, targets)[frame] == pytest.approx(total, rel=1e-9)


def test_gauss_newton_finds_a_minimum_and_less_than_the_search(problem):
    spaces, targets = problem
    z = solve_postures(spaces, targets)
    energy = posture_energy(spaces.postures(z), targets)
    searched = search_postures(spaces, targets, np.zeros_like(z), seed=1)
    assert (energy <= posture_energy(spaces.postures(searched), targets) + 1e-9).all()
    for axis in range(20):
        for step in (-2e-3, 2e-3):
            moved = z.copy()
            moved[:, axis] += step
            assert (posture_energy(spaces.postures(moved), targets) >= energy - 2e-6).all()


def test_sequential_solvers_return_energies_and_search_repeats(problem):
    spaces, targets = problem
    one, energies = search_sequentially(spaces, targets, seed=4)
    again, _ = search_sequentially(spaces, targets, seed=4)
    np.testing.assert_array_equal(one, again)
    _, less = solve_sequentially(spaces, targets)
    assert less[0] <= energies[0]
    assert less.mean() < energies.mean()


def test_the_probable_posture_is_the_conditional_mean(problem):
    """Covariance form: mean + C A' (A C A' + noise)^-1 (observed - A mean)."""
    spaces, targets = problem
    found, spread = probable_postures(spaces, targets)
    for frame in range(N_FRAMES):
        axes, real = spaces.axes[frame], spaces.spreads[frame] > 1e-8
        C = (axes[:, real] * spaces.spreads[frame][real]) @ axes[:, real].T
        reliability = np.where(
            np.isfinite(targets.observed[frame]).all(-1), targets.reliability[frame], 0.0
        )
        rows = np.flatnonzero(np.repeat(reliability > 0.0, 3))
        noise = np.diag(MODEL_ERROR_M**2 / np.repeat(reliability, 3)[rows])
        gain = C[:, rows] @ np.linalg.inv(C[np.ix_(rows, rows)] + noise)
        deviation = targets.observed[frame].reshape(-1)[rows] - spaces.means[frame][rows]
        np.testing.assert_allclose(
            found[frame].reshape(-1), spaces.means[frame] + gain @ deviation, atol=1e-6
        )
        after = np.diag(C - gain @ C[rows]).reshape(20, 3).mean(axis=-1)
        np.testing.assert_allclose(spread[frame], np.sqrt(np.maximum(after, 0)), atol=1e-4)


def test_smoothed_residuals_equal_the_gaussian_process_posterior(random):
    n, dt, size, memory = 40, 1 / 30, 0.1, 0.4
    observed = random.normal(scale=0.1, size=(n, 1, 3))
    reliability = np.ones((n, 1))
    reliability[12:30] = 0.0
    deviation = measurement_deviation(reliability, 0.02)
    trajectory = smooth_residuals(observed, deviation, dt, np.array([size]), memory)
    lags = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) * dt * np.sqrt(3) / memory
    K = size**2 * (1 + lags) * np.exp(-lags)
    is_observed = reliability[:, 0] > 0
    gain = K[:, is_observed] @ np.linalg.inv(
        K[np.ix_(is_observed, is_observed)] + 0.02**2 * np.eye(is_observed.sum())
    )
    np.testing.assert_allclose(
        trajectory.values[:, 0], gain @ observed[is_observed, 0], atol=1e-8
    )
    spread = np.sqrt(np.diag(K - gain @ K[is_observed]))
    np.testing.assert_allclose(trajectory.spread[:, 0], spread, atol=1e-8)


def test_causal_filter_ignores_the_future_and_does_not_jump(random):
    result = random.normal(scale=0.01, size=(30, 2, 3)).cumsum(axis=0)
    observed = result + 0.05
    deviation = measurement_deviation(np.ones((30, 2)), 1e-4)
    deviation[12:20] = np.inf
    size = np.full(2, 0.1)
    trajectory = ResidualFilter(1 / 30, size, 0.5).update(result, observed, deviation)
    cut = ResidualFilter(1 / 30, size, 0.5).update(result[:15], observed[:15], deviation[:15])
    np.testing.assert_array_equal(trajectory.values[:15], cut.values)
    out = result + trajectory.values
    np.testing.assert_allclose(out[12], out[11], atol=1e-5)
    np.testing.assert_allclose(out[20:], observed[20:], atol=1e-3)
    assert (np.diff(trajectory.spread[12:20], axis=0) > 0.0).all()


def test_lengths_are_constrained_and_reliable_joints_hardly_move(bodies, random):
    corrupted = bodies[:20].copy()
    corrupted[:, 13] += random.normal(scale=0.1, size=(20, 3))
    certain = np.ones((20, 20))
    certain[:, 13] = 0.0
    confidence = np.maximum(certain, 0.1)
    constrained = constrain_lengths(corrupted, ADULT_BONE_LENGTHS_M, certain, confidence)
    np.testing.assert_allclose(
        segment_lengths(constrained), np.tile(ADULT_BONE_LENGTHS_M, (20, 1)), atol=0.01
    )
    others = np.arange(20) != 13
    assert np.linalg.norm(constrained - corrupted, axis=-1)[:, others].mean() < 2e-3


def test_observed_bones_stay_unchanged(bodies):
    longer = resize_postures(bodies[:20], 1.1 * ADULT_BONE_LENGTHS_M)
    constrained = constrain_lengths(
        longer, ADULT_BONE_LENGTHS_M, np.ones((20, 20)), np.ones((20, 20))
    )
    np.testing.assert_allclose(constrained, longer)
