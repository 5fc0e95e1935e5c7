"""A file is what it holds, whatever it is called."""

import os
import shutil
import sys
from functools import partial

import numpy as np
import pytest

from solvers.errors import InvalidFileError, InvalidSettingError, SolveCancelled
from solvers.motion import Motion, Tracks, read_humanoid_map
from solvers.recordings import (
    read_bvh,
    read_depth,
    read_motion_or_tracks,
    read_recording,
    write_bvh,
    write_c3d,
    write_trc,
)


def test_the_name_does_not_matter(swinging_leg, tmp_path):
    write_bvh(swinging_leg, tmp_path / "leg.bvh")
    shutil.copy(tmp_path / "leg.bvh", tmp_path / "leg.c3d")

    assert read_recording(tmp_path / "leg.c3d").skeleton.same_joints(swinging_leg.skeleton)


def test_scale_reaches_the_reader(swinging_leg, tmp_path):
    write_bvh(swinging_leg, tmp_path / "leg.bvh")

    twice = read_recording(tmp_path / "leg.bvh", scale=0.02)

    assert twice.skeleton.height == pytest.approx(2 * swinging_leg.skeleton.height)


@pytest.mark.parametrize("ending", ["bvh", "c3d", "trc"])
@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), float("inf")])
def test_invalid_scale_is_refused(swinging_leg, tmp_path, ending, scale):
    write_bvh(swinging_leg, tmp_path / "leg.bvh")
    tracks = Tracks(("a",), swinging_leg.root_positions[:, None], 60.0)
    write_c3d(tracks, tmp_path / "leg.c3d")
    write_trc(tracks, tmp_path / "leg.trc")

    with pytest.raises(InvalidSettingError, match="it must be above 0"):
        read_recording(tmp_path / f"leg.{ending}", scale=scale)


@pytest.mark.parametrize("format", ["bvh", "c3d", "trc"])
def test_progress_rises_to_the_end_and_can_stop_the_work(
    swinging_leg, tmp_path, format, cancel
):
    path = tmp_path / f"leg.{format}"
    tracks = Tracks(("a",), swinging_leg.root_positions[:, None], 60.0)
    calls = {
        "bvh": [partial(write_bvh, swinging_leg, path), partial(read_recording, path)],
        "c3d": [partial(write_c3d, tracks, path), partial(read_recording, path)],
        "trc": [partial(write_trc, tracks, path), partial(read_recording, path)],
    }

    for work in calls[format]:
        messages = []
        work(progress=lambda fraction, message="", messages=messages: messages.append(fraction))
        assert messages == sorted(messages)
        assert messages[-1] == pytest.approx(1.0)
        before = sorted(tmp_path.iterdir())
        with pytest.raises(SolveCancelled):
            work(progress=cancel)
        assert sorted(tmp_path.iterdir()) == before


def test_real_files_of_each_format(recordings):
    mocap = recordings / "mocap"

    assert isinstance(read_recording(mocap / "05_13.amc"), Motion)
    assert isinstance(read_recording(mocap / "05_13.c3d"), Tracks)
    assert read_recording(mocap / "cmu_walk" / "05_01.bvh").n_frames == 599
    for path in sorted((recordings / "formats" / "bvh").iterdir()):
        assert read_recording(path).n_frames == read_bvh(path).n_frames


def test_joints_of_a_camera_serve_as_points(recordings):
    path = recordings / "kinect" / "laban" / "joints.csv"

    tracks = read_motion_or_tracks(path)

    assert isinstance(tracks, Tracks)
    assert tracks.names == read_recording(path).names


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b":version 1.10\n:name VICON\n:units\n", r"skeleton without motion.* \.amc"),
        (b"a letter", "unknown format. Export it as BVH, FBX"),
        (b"Kaydara FBX Binary", "read by Blender's own importers"),
        (b"glTF\2\0\0\0", "read by Blender's own importers"),
        (b"", "is empty"),
        (b"HIERARCHY", "no MOTION"),
    ],
)
def test_an_unknown_format_is_refused_with_the_common_ones(tmp_path, content, sentence):
    path = tmp_path / "take"
    path.write_bytes(content)

    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(path)


def test_a_missing_file_or_a_folder_is_named(tmp_path):
    with pytest.raises(InvalidFileError, match=r"There is no file .*nowhere\.bvh"):
        read_recording(tmp_path / "nowhere.bvh")
    with pytest.raises(InvalidFileError, match="is a folder without depth images"):
        read_recording(tmp_path)


def test_four_numbers_in_a_line_are_not_a_body_for_that(tmp_path, rng):
    """The same data set has joints in pixels too."""
    pixels = tmp_path / "pixels.txt"
    rows = np.column_stack([rng.uniform(0, 640, (60, 3)), np.ones(60)])
    np.savetxt(pixels, rows, fmt="%.2f")

    with pytest.raises(
        InvalidFileError, match=r"pixels\.txt .* not joints of a body in meters"
    ):
        read_recording(pixels)


def test_a_pelvis_alone_does_not_make_a_table_azures(tmp_path):
    table = tmp_path / "take.csv"
    table.write_text(
        "Frame,Time,Pelvis.x,Pelvis.y,Pelvis.z,Neck.x,Neck.y,Neck.z\n1,0,0,0,1,0,0,2\n"
    )

    with pytest.raises(InvalidFileError, match=r"has too few points for a body \(2\)"):
        read_recording(table)


def test_invalid_recording_is_reported_with_its_file_name(tmp_path):
    far = tmp_path / "far.npy"
    np.save(far, np.full((4, 33, 3), 1e30))

    with pytest.raises(InvalidFileError, match=r"far\.npy"):
        read_recording(far)


@pytest.mark.skipif(sys.platform == "win32", reason="needs pipes")
@pytest.mark.parametrize("read", [read_recording, read_bvh, read_depth, read_humanoid_map])
def test_pipe_is_refused_and_not_waited_for(tmp_path, read):
    os.mkfifo(tmp_path / "pipe.bvh")
    os.mkfifo(tmp_path / "pipe.asf")

    with pytest.raises(InvalidFileError, match=r"is not a file|There is no file"):
        read(tmp_path / "pipe.bvh")
