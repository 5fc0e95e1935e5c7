"""What carries an actor does not slide: that shows which axis is up, in any posture."""

import numpy as np
import pytest

from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import read_recording
from solvers.recordings.conventions import (
    estimate_axes_of_points,
    estimate_up_of_joints,
    points_z_up,
    y_up_from_z_up,
    z_up_from_y_up,
)
from solvers.recordings.conventions.contact import measure_contact, sampled_steps
from solvers.samples import walking_gait

UP = {"Y": 0.2, "Z": 0.2, "-Y": 0.2}
EVERY = 4
"""Frames that are left out: 120 Hz to 30 Hz."""


def joints_of(motion):
    """Return positions, shape (n_frames, n_joints, 3), Z up, and their roles."""
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions[:, [*roles.values()]]
    return positions, [*roles]


def in_file(points, up):
    return {"Z": points, "Y": y_up_from_z_up(points)}[up]


def lying(recordings, take):
    """Return an actor from standing to lying on the floor, and only the frames of lying."""
    motion = read_recording(recordings / f"mocap/hdm05/HDM_{take}_120.amc")
    positions, roles = joints_of(motion)
    trunk = positions[:, roles.index("head")] - positions[:, roles.index("hips")]
    is_lying = np.abs(trunk[:, 2]) < 0.4 * np.linalg.norm(trunk, axis=1)
    return positions[::EVERY], positions[is_lying][::EVERY], roles


def contact(points):
    steps = sampled_steps(np.ones(len(points), dtype=bool))
    return measure_contact(points[steps], points[steps + 1], np.vstack([np.eye(3), -np.eye(3)]))


def test_the_planted_foot_of_a_walker_shows_what_is_up_wherever_the_origin_is():
    walk, _ = joints_of(walking_gait())

    assert np.argmax(contact(walk - (0.0, 3.0, 1.3))) == 2
    assert contact(walk[[0] * 20]) == pytest.approx(0.0)


def test_missing_points_are_no_evidence():
    walk, _ = joints_of(walking_gait())
    walk[::3] = np.nan
    walk[:, 2] = np.nan

    assert np.argmax(contact(walk)) == 2
    assert contact(np.full((5, 9, 3), np.nan)) == pytest.approx(0.0)


@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("take", ["bd_lieDownFloor_001", "bk_lieDownFloor_008"])
def test_markers_of_who_lies_down_come_in_as_recorded(recordings, take, up):
    complete, still, _ = lying(recordings, take)

    for points in (complete, still):
        axes = estimate_axes_of_points(in_file(points, up), "", 1.0)
        assert points_z_up(in_file(points, up), axes.up) == pytest.approx(points)
    assert axes.confidence > 0.5


@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("take", ["bd_lieDownFloor_001", "bk_lieDownFloor_008"])
def test_joints_of_who_lies_down_come_in_as_recorded(recordings, take, up):
    complete, _, roles = lying(recordings, take)

    read = z_up_from_y_up(in_file(complete, up))
    estimated = estimate_up_of_joints(read, {r: at for at, r in enumerate(roles)}, UP)

    assert estimated.axis == up
    assert estimated.is_clear


@pytest.mark.parametrize("take", ["bd_lieDownFloor_001", "bk_lieDownFloor_008"])
def test_joints_that_only_lie_are_a_question(recordings, take):
    _, still, roles = lying(recordings, take)

    estimated = estimate_up_of_joints(
        z_up_from_y_up(still), {r: at for at, r in enumerate(roles)}, UP
    )

    assert estimated.axis == "Z" or not estimated.is_clear


@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("take", ["bd_kickLFront1Reps_001", "bd_depositFloorR_001"])
def test_markers_around_hips_at_the_origin_are_a_question(recordings, take, up):
    """Feet slide then, and markers near the hips rest along any axis."""
    motion = read_recording(recordings / f"mocap/hdm05/HDM_{take}_120.amc")
    positions, roles = joints_of(motion)
    centered = positions[::EVERY] - positions[::EVERY, [roles.index("hips")]]

    axes = estimate_axes_of_points(in_file(centered, up), "", 1.0)

    assert axes.confidence < 1.0 or axes.up == up


@pytest.mark.parametrize("up", ["Y", "Z"])
def test_markers_of_a_walker_around_a_camera_come_in_as_recorded(up):
    walk, _ = joints_of(walking_gait())

    axes = estimate_axes_of_points(in_file(walk - (0.0, 3.0, 1.3), up), "", 1.0)

    assert axes.up == up


def test_a_body_that_stays_in_place_rests_on_nothing():
    walk, _ = joints_of(walking_gait())
    centered = walk - walk.mean(axis=1, keepdims=True)

    assert contact(centered) == pytest.approx(0.0)


def test_hips_at_the_origin_rest_on_nothing():
    """Feet slide then, and hands at the side may move least."""
    walk, roles = joints_of(walking_gait())
    centered = walk - walk[:, [roles.index("hips")]]

    estimated = estimate_up_of_joints(centered, {r: at for at, r in enumerate(roles)}, UP)

    assert estimated.axis == "Y"
    assert estimated.is_clear
