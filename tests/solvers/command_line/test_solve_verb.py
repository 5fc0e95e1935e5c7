"""`solve`: from a file of markers to a BVH file."""

import json

import pytest
from marked_bodies import markers_on

from solvers.motion import Tracks, find_humanoid_map
from solvers.recordings import read_bvh, write_bvh, write_c3d, write_trc
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture
def walk():
    return walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))


@pytest.fixture
def marker_file(walk, tmp_path):
    write_c3d(markers_on(walk), tmp_path / "walk.c3d")
    return tmp_path / "walk.c3d"


def test_solve_writes_a_skeleton_and_reports_the_fit(call, marker_file, tmp_path):
    status, out, err = call("solve", marker_file, tmp_path / "walk.bvh", "--json")

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["marker_set"] == "CMU 41" and len(figures["markers"]) == 41
    assert figures["error_m"] < 0.005 and figures["swaps"] == []
    motion = read_bvh(tmp_path / "walk.bvh")
    assert motion.n_frames == figures["n_frames"] == 30
    assert find_humanoid_map(motion.skeleton).score == 1.0


def test_solve_names_frames_of_swapped_labels_from_one(call, walk, tmp_path):
    markers = markers_on(walk)
    positions = markers.positions.copy()
    knees = [markers.names.index(name) for name in ("LKNE", "RKNE")]
    positions[10:20, knees] = positions[10:20, knees[::-1]]
    swapped = Tracks(markers.names, positions, markers.frame_rate)
    write_c3d(swapped, tmp_path / "swapped.c3d")

    _, out, _ = call("solve", tmp_path / "swapped.c3d", tmp_path / "walk.bvh")

    assert "Labels of LKNE and RKNE were wrong in frames 11 to 20." in out


def test_solve_writes_bvh_for_many_files(call, marker_file, walk, tmp_path):
    write_trc(markers_on(walk), tmp_path / "other.trc")

    status, out, _ = call(
        "solve", marker_file, tmp_path / "other.trc", "--output-folder", tmp_path / "out",
        "--no-unswap", "--no-fill", "--smooth",
    )  # fmt: skip

    assert status == 0 and "41 markers" in out
    written = {path.name for path in (tmp_path / "out").glob("*.bvh")}
    assert written == {"walk.bvh", "other.bvh"}


def test_solve_refuses_other_output_types_before_the_work(call, marker_file, tmp_path):
    status, _, err = call("solve", marker_file, tmp_path / "again.c3d")

    assert status == 2 and ".bvh" in err


def test_solve_refuses_a_recording_with_a_skeleton(call, walk, tmp_path):
    write_bvh(walk, tmp_path / "walk.bvh")

    status, _, err = call("solve", tmp_path / "walk.bvh", tmp_path / "again.bvh")

    assert status == 2 and "already has a skeleton" in err


def test_convert_reports_that_markers_must_be_solved(call, marker_file, tmp_path):
    status, _, err = call("convert", marker_file, tmp_path / "walk.bvh")

    assert status == 2 and "the verb solve" in err
