"""`reconstruct`: from files of joints to motions or joints."""

import json
import re

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions

from solvers import motion as vocabulary
from solvers import samples
from solvers.motion import SENSOR_JOINTS, Sensor, Tracks
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction import load_posture_library
from solvers.recordings import read_bvh, read_recording, write_bvh, write_joint_csv, write_trc
from solvers.recordings.conventions import floor_level


@pytest.fixture(scope="module")
def walk():
    return tracked_walk(vocabulary, true_positions(samples, posture_joints))


@pytest.fixture
def walk_file(walk, tmp_path):
    write_joint_csv(walk, tmp_path / "walk.csv")
    return tmp_path / "walk.csv"


def test_reconstruct_writes_a_motion_and_reports_missing_joints(call, walk_file, tmp_path):
    status, out, err = call("reconstruct", walk_file, tmp_path / "walk.bvh", "--json")

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert 0.03 < figures["rebuilt_share"] < 0.2
    assert figures["slide_after_m"] < figures["slide_before_m"]
    assert figures["after"]["missing_share"] == 0
    motion = read_bvh(tmp_path / "walk.bvh")
    assert motion.n_frames == 90 and "WristLeft" in motion.skeleton.names


def test_writes_joints_with_their_confidence(call, walk_file, walk, tmp_path):
    status, out, err = call("reconstruct", walk_file, tmp_path / "clean.csv", "--no-feet")

    assert (status, err) == (0, "")
    assert "were rebuilt" in out and "Feet" not in out
    joints = read_recording(tmp_path / "clean.csv")
    assert joints.names == walk.names
    assert joints.tracks.visible.all()
    assert joints.tracks.confidence.shape == (90, 20)


@pytest.mark.parametrize(("options", "ending"), [((), ".bvh"), (("--joints",), ".csv")])
def test_reconstruct_writes_many_files_once(call, walk_file, walk, tmp_path, options, ending):
    write_joint_csv(walk, tmp_path / "other.csv")
    words = ("reconstruct", walk_file, tmp_path / "other.csv", "--output-folder",
             tmp_path / "out", "--jobs", 2, *options)  # fmt: skip

    first, again = call(*words), call(*words)

    assert first[0] == again[0] == 0
    assert {path.stem for path in (tmp_path / "out").glob(f"*{ending}")} == {"walk", "other"}
    assert again[1].count("Already made.") == 2


def test_motion_of_a_skeleton_is_reconstructed_on_it(call, tmp_path):
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    write_bvh(walk, tmp_path / "walk.bvh")

    status, out, err = call("reconstruct", tmp_path / "walk.bvh", tmp_path / "clean.bvh")

    assert (status, err) == (0, "")
    assert "slide on the floor" in out
    clean = read_bvh(tmp_path / "clean.bvh")
    assert set(clean.skeleton.names) == set(read_bvh(tmp_path / "walk.bvh").skeleton.names)


def test_postures_are_learned_from_given_clips(call, walk_file, tmp_path):
    walk = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))
    (tmp_path / "clean").mkdir()
    write_bvh(walk, tmp_path / "clean" / "walk.bvh")

    status, out, err = call(
        "reconstruct", walk_file, tmp_path / "out.bvh", "--train", tmp_path / "clean"
    )

    assert (status, err) == (0, "")
    assert "1 clip of your own" in out


def test_millimeters_read_as_meters_are_refused_with_a_scale(call, walk, tmp_path):
    large = Tracks(walk.names, 1000.0 * walk.tracks.positions, 30.0)
    write_joint_csv(walk.with_tracks(large), tmp_path / "large.csv")

    status, _, err = call("reconstruct", tmp_path / "large.csv", tmp_path / "out.bvh")
    scaled, _, _ = call(
        "reconstruct", tmp_path / "large.csv", tmp_path / "out.bvh", "--scale", "0.001"
    )

    assert status == 2 and err.count("\n") == 1
    assert "large.csv" in err and "millimeters were read as meters" in err
    assert scaled == 0
    height = read_bvh(tmp_path / "out.bvh").skeleton.height
    assert 1.3 < height < 2.2


@pytest.mark.parametrize("verb", ["reconstruct", "fix"])
def test_joints_of_a_camera_come_out_on_the_floor(call, walk, tmp_path, verb):
    """In the space of the sensor the result is as much as 1.6 m below the floor."""
    lower = walk.tracks.with_positions(walk.tracks.positions - (0.0, 0.0, 1.1))
    write_joint_csv(walk.with_tracks(lower), tmp_path / "walk.csv")

    placed, kept = tmp_path / "placed.bvh", tmp_path / "kept.bvh"
    _, out, _ = call(verb, tmp_path / "walk.csv", placed)
    _, without, _ = call(verb, tmp_path / "walk.csv", kept, "--place-on-floor", "never")

    assert abs(floor_level(read_bvh(placed))) < 0.05
    assert abs(floor_level(read_bvh(kept))) > 0.1
    assert "No floor was measured" in out and "No floor was measured" not in without


def test_estimated_unit_is_reported(call, walk, tmp_path):
    write_joint_csv(walk, tmp_path / "said.csv")
    large = walk.with_tracks(walk.tracks.with_positions(1000.0 * walk.tracks.positions))
    write_joint_csv(large, tmp_path / "large.csv")
    text = (tmp_path / "large.csv").read_text()
    (tmp_path / "large.csv").write_text(text.replace("units=m,", "", 1))

    for verb, names in (
        ("reconstruct", ["out.bvh"]),
        ("convert", ["out.trc"]),
        ("quality", []),
    ):
        targets = [tmp_path / name for name in names]
        status, out, _ = call(verb, tmp_path / "large.csv", *targets)
        assert status == 0 and out.count("Lengths are interpreted as millimeters") == 1, verb
        status, out, _ = call(verb, tmp_path / "said.csv", *targets)
        assert status == 0 and "Lengths" not in out, verb


def test_markers_are_refused(call, tmp_path):
    markers = Tracks(("LFHD", "RFHD", "LASI"), np.random.default_rng(1).random((9, 3, 3)), 30.0)
    write_trc(markers, tmp_path / "markers.trc")

    status, _, err = call("reconstruct", tmp_path / "markers.trc", tmp_path / "out.bvh")

    assert status == 2 and "No body was recognized" in err
    assert not (tmp_path / "out.bvh").exists()


@pytest.mark.parametrize("target", ["out.c3d", "out.trc", "out"])
def test_other_file_types_are_refused_before_the_work(call, walk_file, tmp_path, target):
    status, _, err = call("reconstruct", walk_file, tmp_path / target)

    assert status == 2 and ".bvh" in err and ".csv" in err


def test_joints_option_is_refused_for_a_skeleton(call, tmp_path):
    walk = samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=30.0))
    write_bvh(walk, tmp_path / "walk.bvh")

    status, _, err = call("reconstruct", tmp_path / "walk.bvh", tmp_path / "out.csv")

    assert status == 2 and "out.bvh" in err


def test_recording_without_tracked_joints_is_refused(call, tmp_path):
    names = SENSOR_JOINTS[Sensor.KINECT_V1]
    path = tmp_path / "empty.csv"
    columns = ",".join(f"{name}.{axis}" for name in names for axis in "xyz")
    rows = [f"{frame / 30.0}" + "," * 60 for frame in range(5)]
    path.write_text("\n".join(["mocap-assist-joints,1,units=m", f"time,{columns}", *rows]))

    status, _, err = call("reconstruct", path, tmp_path / "out.bvh")

    assert status == 2 and err.count("\n") == 1 and "empty.csv" in err


@pytest.fixture
def clips(tmp_path):
    """A folder with two clean walks."""
    (tmp_path / "clips").mkdir()
    for name, speed in (("slow", 0.9), ("fast", 1.6)):
        gait = samples.GaitSettings(duration=2.0, frame_rate=30.0, speed=speed)
        write_bvh(samples.walking_gait(gait), tmp_path / "clips" / f"{name}.bvh")
    return tmp_path / "clips"


def test_learned_postures_are_saved_and_reused(call, walk_file, clips, tmp_path):
    own = tmp_path / "own.npz"
    status, out, err = call("learn-postures", clips, "--output", own, "--n-postures", 40)
    assert (status, err) == (0, "")
    assert re.match(r"Kept 40 of \d{3} postures of 2 clips of your own in ", out)
    assert load_posture_library(own).n_postures == 40

    words = ("reconstruct", walk_file, tmp_path / "walk.bvh", "--postures", own)
    status, out, _ = call(*words)
    twice, _, contradiction = call(*words, "--train", clips)

    assert status == 0 and "2 clips of your own" in out and "CMU" not in out
    assert twice == 2 and "not allowed with" in contradiction


def test_points_are_refused_as_posture_clips(call, walk, tmp_path):
    write_trc(walk.tracks, tmp_path / "points.trc")

    status, _, err = call(
        "learn-postures", tmp_path / "points.trc", "--output", tmp_path / "own.npz"
    )

    assert status == 2 and "motions of skeletons" in err
    assert not (tmp_path / "own.npz").exists()
