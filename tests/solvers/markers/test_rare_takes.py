"""Takes of markers that the sweeps do not hold: each is what one constant guards."""

import marked_bodies
import numpy as np
import pytest
from marked_bodies import markers_on

from solvers.markers import find_rigid_clusters, solve_skeleton, unswap_markers
from solvers.markers.distances import learn_distances
from solvers.markers.initial_poses import _leveling_matrix
from solvers.motion import Tracks, find_humanoid_map, forward_kinematics
from solvers.samples import GaitSettings, walking_gait

SHAPE = np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.12, 0], [0, 0, 0.15], [0.08, 0.1, 0.1]])
UP = np.array([0.0, 0.0, 1.0])


def tracks_of(positions):
    return Tracks(tuple(f"m{n}" for n in range(positions.shape[1])), positions, 60.0)


def test_reflection_does_not_get_the_label_of_a_missing_marker():
    """The label of a head marker jumps to where no marker is, while another is missing."""
    take = markers_on(walking_gait(GaitSettings(duration=4.0, frame_rate=60.0)))
    missing, reflected = take.names.index("LFHD"), take.names.index("LBHD")
    positions = take.positions.copy()
    way = positions[80:140, missing] - positions[80:140, reflected]
    positions[80:140, reflected] += 0.6 * way
    positions[80:140, missing] = np.nan

    assert unswap_markers(take.with_positions(positions)).swaps == ()


@pytest.mark.parametrize(("slow", "fast"), [(0.03, 0.15), (0.00005, 0.008)])
def test_fast_pass_of_two_markers_and_back_is_no_swap(slow, fast):
    """Their relative steps, in meters; nothing else distinguishes them."""
    steps = np.full(60, slow)
    steps[48:52] = fast
    separation = np.cumsum(steps)
    separation -= separation[49] - 0.5 * fast
    positions = np.zeros((120, 2, 3))
    positions[:, 1, 0] = np.concatenate([separation, separation[::-1]])

    assert unswap_markers(tracks_of(positions)).swaps == ()


def test_skin_that_moves_by_millimeters_is_no_wrong_label(rng):
    """All distances of the take are exact, as of a rigid prop."""
    positions = SHAPE + rng.normal(size=(100, 1, 3))
    distances = learn_distances(positions)
    neighbors = distances.neighbors(0)

    misfit = distances.misfit(0, positions[:, 0] + (0.003, 0.0, 0.0), positions, neighbors)

    assert misfit.max() < 1.0


def test_marker_that_moves_freely_identifies_no_other(rng):
    positions = SHAPE + rng.normal(size=(100, 1, 3))
    positions[:, 4] += rng.normal(scale=0.05, size=(100, 3))
    distances = learn_distances(positions)

    assert 4 not in distances.rigid_neighbors(0)
    assert not len(distances.rigid_neighbors(4))


def test_marker_observed_in_two_frames_with_others_joins_no_cluster(rng):
    path = np.cumsum(rng.normal(scale=0.02, size=(100, 9, 3)), axis=0)
    path[:, :4] = path[:, :1] + SHAPE[:4]
    path[:98, 4] = np.nan
    path[98:, 4] = path[98:, 0] + SHAPE[4]

    assert [cluster.names for cluster in find_rigid_clusters(tracks_of(path))] == [
        ("m0", "m1", "m2", "m3")
    ]


def test_actor_who_sways_by_millimeters_is_no_rigid_cluster(rng):
    swaying = np.repeat(SHAPE[None], 200, axis=0)
    swaying += 0.001 * np.sin(np.arange(200)[:, None, None] / 10.0 + rng.normal(size=(5, 3)))

    assert find_rigid_clusters(tracks_of(swaying)) == ()


def test_level_of_a_foot_on_tiptoe_or_with_coinciding_markers_is_limited():
    toe = np.zeros((20, 3))
    for heel in (toe, toe + 0.2 * UP, toe + 0.02 * UP):
        leveling = _leveling_matrix(heel, toe)

        assert np.isfinite(leveling).all()
        assert abs(leveling[1, 2]) <= 0.4


PELVIS_AND_TRUNK = {"LFWT", "RFWT", "LBWT", "RBWT", "C7", "T10", "CLAV", "STRN", "RBAC"}


@pytest.mark.parametrize(("thighs", "determined"), [(set(), True), ({"LTHI", "RTHI"}, False)])
def test_legs_determine_missing_hips_and_shanks_alone_do_not(thighs, determined):
    take = markers_on(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)))
    lost = [take.names.index(name) for name in sorted(PELVIS_AND_TRUNK | thighs)]
    positions = take.positions.copy()
    positions[20:40, lost] = np.nan

    hips = solve_skeleton(take.with_positions(positions)).joint_centers.positions[20:40, 0]

    assert np.isfinite(hips).all() == determined
    assert np.isfinite(hips).any() == determined


def test_knee_markers_on_the_shanks_cost_the_hip_joints_millimeters(monkeypatch):
    """Thighs start 6 cm too long, and shanks too short by that."""
    bone, anchor, seat = marked_bodies.SIDE["KNE"]
    monkeypatch.setitem(marked_bodies.SIDE, "KNE", (bone, anchor, seat - 0.06 * UP))
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    joints = find_humanoid_map(walk.skeleton).indices(walk.skeleton)
    true = forward_kinematics(walk).positions[:, joints["leftUpperLeg"]]

    solved = solve_skeleton(markers_on(walk)).joint_centers

    found = solved.positions[:, solved.names.index("leftUpperLeg")]
    assert np.linalg.norm(found - true, axis=-1).mean() < 0.0085
