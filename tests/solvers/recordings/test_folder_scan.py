"""A folder is looked through to its end, whatever lies in it."""

import json
import os
import shutil
import sys

import pytest
from depth_files import depth_npz, pictures
from depth_folders import open3d, plain
from odd_files import OTHERS, close
from odd_files import pictures as odd_pictures

from solvers.errors import FileAccessError, InvalidFileError
from solvers.recordings import (
    depth_takes_in,
    detect_format,
    read_depth,
    read_recording,
    read_tracked,
    recordings_in,
    write_bvh,
)
from solvers.recordings.containers import frame_files


@pytest.fixture
def takes(swinging_leg, tmp_path):
    """A folder with a motion and a depth recording, each also in a folder below."""
    folder = tmp_path / "takes"
    (folder / "more").mkdir(parents=True)
    write_bvh(swinging_leg, folder / "leg.bvh")
    (folder / "room.npz").write_bytes(depth_npz(pictures()))
    shutil.copy(folder / "leg.bvh", folder / "more" / "twin.bvh")
    shutil.copy(folder / "room.npz", folder / "more" / "twin.npz")
    return folder


def names(paths, folder):
    return [path.relative_to(folder).as_posix() for path in paths]


def test_files_of_other_kinds_are_left_out_in_silence(takes):
    for name, content in {**OTHERS, **odd_pictures()}.items():
        (takes / name).write_bytes(content)
        (takes / "more" / name).write_bytes(content)

    assert names(recordings_in(takes), takes) == ["leg.bvh", "more/twin.bvh"]
    assert names(depth_takes_in(takes), takes) == ["more/twin.npz", "room.npz"]


@pytest.mark.parametrize("content", [*OTHERS.values(), *odd_pictures().values()])
def test_a_file_of_another_kind_is_no_damaged_recording_when_it_is_named(tmp_path, content):
    (tmp_path / "odd").write_bytes(content)

    with pytest.raises(
        InvalidFileError,
        match=r"has an unknown format|is (a web page|compressed|empty|a video)",
    ):
        read_recording(tmp_path / "odd")


def test_unmarked_folder_with_damaged_images_is_searched(takes):
    (takes / "thumb.png").write_bytes(odd_pictures()["thumb_1.png"][:-20])

    assert names(depth_takes_in(takes), takes) == ["more/twin.npz", "room.npz"]


@pytest.mark.parametrize("make", [open3d, plain])
def test_a_take_of_pictures_stays_one_when_its_first_picture_is_damaged(tmp_path, make):
    folder = make(tmp_path / "take", pictures(9))
    first = min(folder.rglob("*.png"))
    first.write_bytes(first.read_bytes()[:-20])

    assert depth_takes_in(tmp_path) == [folder]


@pytest.mark.parametrize("error", [IndexError, OverflowError, PermissionError])
def test_the_others_are_found_when_looking_at_one_file_fails(takes, monkeypatch, error):
    def fail(path):
        if "twin" in path.name:
            raise error
        return detect_format(path)

    for module in ("folders", "read_recording"):
        monkeypatch.setattr(sys.modules[f"solvers.recordings.{module}"], "detect_format", fail)

    assert names(recordings_in(takes), takes) == ["leg.bvh", "more/twin.bvh", "more/twin.npz"]
    assert names(depth_takes_in(takes), takes) == ["more/twin.bvh", "more/twin.npz", "room.npz"]


def test_unreadable_folder_is_named_on_reading(takes, monkeypatch):
    closed = takes / "more"
    close(closed, monkeypatch)

    assert names(recordings_in(takes), takes) == ["leg.bvh", "more"]
    assert names(depth_takes_in(takes), takes) == ["more", "room.npz"]
    assert recordings_in(closed) == depth_takes_in(closed) == [closed]
    for read in (read_recording, read_tracked, read_depth, detect_format):
        with pytest.raises(FileAccessError, match=r"folder .*more cannot be opened"):
            read(closed)


def test_links_to_files_count_and_links_to_folders_do_not(takes, tmp_path):
    (takes / "more").rename(tmp_path / "elsewhere")
    (takes / "linked").symlink_to(tmp_path / "elsewhere")
    (takes / "loop").symlink_to(takes)
    (takes / "dead").symlink_to(tmp_path / "nowhere")
    (takes / "link.bvh").symlink_to(tmp_path / "elsewhere" / "twin.bvh")
    (takes / ".hidden.bvh").write_bytes((takes / "leg.bvh").read_bytes())

    assert names(recordings_in(takes), takes) == ["leg.bvh", "link.bvh"]


def test_pipes_are_skipped_and_deep_folders_are_searched(takes):
    os.mkfifo(takes / "pipe.bvh")
    deep = takes
    for _ in range(300):
        deep /= "d"
    deep.mkdir(parents=True)
    shutil.copy(takes / "leg.bvh", deep / "leg.bvh")

    assert [path.name for path in recordings_in(takes)] == ["leg.bvh", "leg.bvh", "twin.bvh"]


@pytest.mark.parametrize("form", ["a_{}.json", "a_{:03}.json"])
def test_numbers_with_and_without_zeros_are_two_takes(tmp_path, form):
    """Frames of one of them do not replace those of the other."""
    joints = [[0.1 * k, 0.2 * k % 1.7, 0.3] for k in range(17)]
    frame = json.dumps([{"id": 1, "keypoints3d": joints}])
    for number in range(1, 9):
        (tmp_path / f"a_{number}.json").write_text(frame)
        (tmp_path / f"a_{number:03}.json").write_text(frame)

    files = frame_files(tmp_path / form.format(3)).files

    assert [file.name for file in files.values()] == [form.format(k) for k in range(1, 9)]
    assert len(recordings_in(tmp_path)) == 2
