"""Find rigid clusters of markers, and constrain them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidMotionError
from solvers.markers import Cluster, ClusterSettings, constrain_clusters, find_rigid_clusters
from solvers.markers.rigid_transform import fit_rigid_transform
from solvers.motion import Tracks
from solvers.recordings import read_c3d

HEAD = np.array([
    [0.07, -0.09, 0.0],
    [-0.07, -0.08, 0.01],
    [0.06, 0.08, 0.02],
    [-0.07, 0.08, 0.0],
])
NAMES = ("head1", "head2", "head3", "head4", "loose", "stick1", "stick2")


@pytest.fixture
def take(rng) -> Tracks:
    """Four markers on a head, two on a stick and a single one, for 5 s at 60 Hz."""
    time = np.arange(300) / 60.0
    rotation = Rotation.from_rotvec(
        np.stack([np.sin(time), np.cos(2 * time), 0.5 * time], axis=1)
    )
    path = np.stack([np.sin(time), 0.3 * time, 1.6 + 0.1 * np.cos(3 * time)], axis=1)
    head = np.einsum("fij,pj->fpi", rotation.as_matrix(), HEAD) + path[:, None]
    loose = path + np.stack(
        [0.2 + 0.2 * np.sin(5 * time), 0 * time, 0.3 * np.cos(time)], axis=1
    )
    along = np.stack([np.cos(time), np.sin(time), 0 * time], axis=1)
    stick = loose - [0.0, 0.4, 0.3] + np.sin(2 * time)[:, None] * 0.2
    positions = [*head.swapaxes(0, 1), loose, stick, stick + 0.15 * along]
    return Tracks(NAMES, np.stack(positions, axis=1), 60.0)


def lengths(positions: np.ndarray, members: list[int]) -> np.ndarray:
    some = positions[:, members]
    return np.linalg.norm(some[:, :, None] - some[:, None], axis=-1)


def test_find_clusters_returns_head_and_stick_only(take):
    found = find_rigid_clusters(take)

    assert [cluster.names for cluster in found] == [NAMES[:4], NAMES[5:]]
    assert found[0].slack < 1e-6
    shape = found[0].template
    assert_allclose(
        np.linalg.norm(shape[:, None] - shape, axis=-1),
        np.linalg.norm(HEAD[:, None] - HEAD, axis=-1),
        atol=1e-6,
    )


def test_find_clusters_tolerates_noise(take, rng):
    noisy = take.with_positions(take.positions + 0.003 * rng.normal(size=take.positions.shape))

    assert [cluster.names for cluster in find_rigid_clusters(noisy)] == [NAMES[:4], NAMES[5:]]


@pytest.mark.parametrize("noise", [0.001, 0.003])
def test_constrained_distances_are_constant_and_noise_is_lower(take, rng, noise):
    noisy = take.with_positions(take.positions + noise * rng.normal(size=take.positions.shape))

    constrained = constrain_clusters(noisy, find_rigid_clusters(noisy)).tracks.positions

    for members in ([0, 1, 2, 3], [5, 6]):
        assert np.ptp(lengths(constrained, members), axis=0).max() < 1e-9
    before, after = (
        np.sqrt(((each - take.positions)[:, :4] ** 2).mean())
        for each in (noisy.positions, constrained)
    )
    # Twelve coordinates with six degrees of freedom keep half of the noise variance.
    assert after == pytest.approx(np.sqrt(0.5) * before, rel=0.05)
    assert np.array_equal(constrained[:, 4], noisy.positions[:, 4])


def test_missing_marker_needs_three_reference_markers(take):
    positions = take.positions.copy()
    positions[50:100, 0] = np.nan
    positions[200:250, :2] = np.nan

    constrained = constrain_clusters(take.with_positions(positions), find_rigid_clusters(take))

    assert_allclose(
        constrained.tracks.positions[50:100, 0], take.positions[50:100, 0], atol=1e-6
    )
    assert np.isnan(constrained.tracks.positions[200:250, :2]).all()
    assert constrained.filled[50:100, 0].all() and constrained.filled.sum() == 50
    assert constrained.moved.max() < 1e-6


def test_three_collinear_markers_do_not_determine_a_fourth():
    rod = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.25, 0, 0], [0.1, 0.1, 0.0]])
    positions = np.tile(rod, (10, 1, 1))
    positions[5:, 3] = np.nan
    take = Tracks(tuple("abcd"), positions, 60.0)

    constrained = constrain_clusters(
        take, [Cluster(tuple("abcd"), rod - rod.mean(axis=0), 0.0)]
    ).tracks

    assert np.isnan(constrained.positions[5:, 3]).all()
    assert_allclose(constrained.positions[:5], rod + np.zeros((5, 1, 1)), atol=1e-9)


def test_outlier_marker_is_corrected_and_hardly_moves_others(take):
    positions = take.positions.copy()
    positions[100:110, 2] += [0.0, 0.0, 0.08]

    constrained = constrain_clusters(
        take.with_positions(positions), find_rigid_clusters(take)
    ).tracks.positions

    errors = np.linalg.norm(constrained - take.positions, axis=-1)[:, :4]
    assert errors.max() < 0.004


def test_kabsch_recovers_the_rotation(rng):
    rotations = Rotation.random(10, random_state=1).as_matrix()
    shifts = rng.normal(size=(10, 3))
    positions = np.einsum("fij,pj->fpi", rotations, HEAD) + shifts[:, None]

    found, where = fit_rigid_transform(HEAD, positions)

    assert_allclose(found, rotations, atol=1e-9)
    assert_allclose(where, shifts, atol=1e-9)


def test_take_without_motion_has_no_clusters(rng):
    still = np.tile(rng.normal(size=(1, 8, 3)), (100, 1, 1))

    assert find_rigid_clusters(Tracks(tuple("abcdefgh"), still, 60.0)) == ()


@pytest.mark.parametrize("n_points", [1, 2])
def test_few_points_and_frames_are_accepted(n_points):
    names = tuple("ab"[:n_points])
    tracks = Tracks(names, np.full((1, n_points, 3), np.nan), 60.0)

    assert find_rigid_clusters(tracks) == ()
    assert constrain_clusters(tracks, ()).tracks.n_points == n_points


def test_constrain_clusters_names_markers_missing_from_the_take(take):
    with pytest.raises(InvalidMotionError, match="hat"):
        constrain_clusters(take, [Cluster(("hat", "head1"), np.zeros((2, 3)), 0.0)])


def test_head_of_a_real_take_is_a_cluster_and_moves_by_millimeters(recordings):
    take = read_c3d(recordings / "markers" / "85_02.c3d")

    clusters = find_rigid_clusters(take)
    constrained = constrain_clusters(take, clusters)

    assert ("LFHD", "RFHD", "LBHD", "RBHD") in [cluster.names for cluster in clusters]
    assert constrained.moved.mean() < 0.002
    assert len(find_rigid_clusters(take, settings=ClusterSettings(slack=0.001))) < len(clusters)
