"""`fix`: from a file of any origin to a BVH file, and a report."""

import json

import numpy as np
import pytest
from depth_files import depth_npz
from marked_bodies import markers_on

from solvers.motion import Tracks
from solvers.recordings import read_bvh, takes_in, write_bvh, write_c3d, write_trc
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait


@pytest.fixture
def walk():
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


@pytest.fixture
def walk_file(walk, tmp_path):
    noisy = corrupt(walk, CorruptionSettings(jitter=3.0, spikes=0.004))
    write_bvh(noisy, tmp_path / "walk.bvh")
    return tmp_path / "walk.bvh"


def test_fix_writes_a_clean_motion_and_reports_it(call, walk_file, tmp_path):
    status, out, err = call("fix", walk_file, tmp_path / "fixed.bvh", "--json")

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["n_frames"] == read_bvh(tmp_path / "fixed.bvh").n_frames == 60
    assert figures["origin"] == "suit or file of a skeleton"
    assert figures["before"]["jitter_deg"] > 10.0 * figures["after"]["jitter_deg"]
    assert figures["before"]["spikes"] > figures["after"]["spikes"] == 0


def test_fix_prints_four_figures_before_and_after(call, walk_file, tmp_path):
    status, out, _ = call("fix", walk_file, tmp_path / "fixed.bvh")

    assert status == 0
    for label in ("Jitter", "Longest Slide", "Spikes, Gaps", "Issues"):
        assert label in out


def test_fix_makes_a_skeleton_of_markers_among_other_files(call, walk_file, walk, tmp_path):
    write_c3d(markers_on(walk), tmp_path / "markers.c3d")

    status, _, err = call(
        "fix", walk_file, tmp_path / "markers.c3d", "--output-folder", tmp_path / "out",
        "--no-plant-feet",
    )  # fmt: skip

    assert (status, err) == (0, "")
    assert {path.name for path in (tmp_path / "out").glob("*.bvh")} == {
        "walk.bvh", "markers.bvh",
    }  # fmt: skip


def test_fix_refuses_points_of_no_marker_set_in_one_sentence(call, tmp_path):
    path = np.linspace(0.0, 1.0, 90).reshape(30, 1, 3)
    points = np.concatenate([path, path + 0.2], axis=1)
    write_trc(Tracks(("a", "b"), points, 30.0), tmp_path / "points.trc")

    status, _, err = call("fix", tmp_path / "points.trc", tmp_path / "points.bvh")

    assert status == 2 and "Use denoise" in err
    assert not (tmp_path / "points.bvh").exists()


def test_takes_of_a_folder_include_depth_images(walk_file, tmp_path):
    (tmp_path / "depth.npz").write_bytes(depth_npz(np.full((2, 6, 8), 4000, np.uint16)))

    assert takes_in(tmp_path) == [tmp_path / "depth.npz", walk_file]


def test_fix_names_a_marker_that_is_never_seen(call, walk, tmp_path):
    markers = markers_on(walk)
    positions = markers.positions.copy()
    positions[:, markers.names.index("LKNE")] = np.nan
    write_trc(markers.with_positions(positions), tmp_path / "markers.trc")

    status, _, err = call("fix", tmp_path / "markers.trc", tmp_path / "fixed.bvh")

    assert status == 2 and "LKNE was never observed" in err
