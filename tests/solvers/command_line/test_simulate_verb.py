"""`simulate`: from a file of a motion to one with weight."""

import json

import numpy as np
import pytest

from solvers.motion import Tracks, forward_kinematics
from solvers.physics import simulate
from solvers.recordings import read_bvh, write_bvh, write_trc
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture
def sunk(tmp_path):
    """A walk 10 cm under the ground."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    low = walk.with_poses(root_positions=walk.root_positions - np.array([0, 0, 0.1]))
    write_bvh(low, tmp_path / "sunk.bvh")
    return tmp_path / "sunk.bvh"


def test_simulate_writes_a_motion_on_the_ground_and_reports_figures(call, sunk, tmp_path):
    status, out, err = call("simulate", sunk, tmp_path / "stands.bvh", "--json")

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["penetration_before_m"] > 0.09 and figures["penetration_after_m"] < 0.005
    assert figures["frames_not_followed"] == 0 and figures["n_frames"] == 30
    assert figures["message"] == "The simulated body followed the complete take."
    before, after = (
        forward_kinematics(read_bvh(tmp_path / name)).positions[..., 2].min()
        for name in ("sunk.bvh", "stands.bvh")
    )
    assert after > before + 0.05


def test_simulate_uses_settings_and_reports_the_result(call, sunk, tmp_path):
    status, out, _ = call(
        "simulate", sunk, tmp_path / "stands.bvh", "--ground", "auto", "--strength", "0.5"
    )

    assert status == 0
    assert "The simulated body followed the complete take." in out
    assert "Joints moved by" in out


def test_simulate_counts_frames_from_one(call, tmp_path):
    """A walker is lifted by more than 1 m for half a second."""
    walk = walking_gait(GaitSettings(duration=4.0, frame_rate=30.0))
    lift = np.interp(np.arange(120), [50, 58, 75, 83], [0.0, 1.2, 1.2, 0.0])
    lifted = walk.with_poses(root_positions=walk.root_positions + np.outer(lift, [0, 0, 1]))
    write_bvh(lifted, tmp_path / "lifted.bvh")

    status, out, _ = call("simulate", tmp_path / "lifted.bvh", tmp_path / "follows.bvh")

    assert status == 0
    failed = np.flatnonzero(~simulate(read_bvh(tmp_path / "lifted.bvh")).followed)
    assert len(failed)
    assert f"The first frame that the body could not follow is {failed[0] + 1}." in out


def test_simulate_refuses_points(call, tmp_path):
    points = Tracks(("a", "b"), np.arange(18.0).reshape(3, 2, 3), 30.0)
    write_trc(points, tmp_path / "points.trc")

    status, _, err = call("simulate", tmp_path / "points.trc", tmp_path / "out.bvh")

    assert status == 2
    assert "points without a skeleton. Solve a skeleton" in err
