"""Folders of depth pictures that are damaged, or hold something else."""

import json

import numpy as np
import pytest
from depth_files import pictures
from depth_folders import colors_of, open3d, save_png
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, read_depth, read_recording

LENS = DepthSettings(fx=9.0, fy=8.0)
MILLIMETERS = DepthSettings(fx=9.0, fy=8.0, scale=0.001)


@pytest.fixture
def depth() -> np.ndarray:
    return pictures(9)


def heard():
    text = []
    return text, lambda fraction, message="": text.append(message)


@pytest.mark.parametrize(
    "damage", [lambda complete: complete[:-20], lambda complete: b"", lambda _: b"?"]
)
def test_a_picture_that_is_cut_short_is_an_empty_frame(tmp_path, depth, damage):
    folder = open3d(tmp_path, depth)
    path = folder / "depth" / "00005.png"
    path.write_bytes(damage(path.read_bytes()))
    text, progress = heard()

    recording = read_depth(folder, progress=progress)

    assert recording.frame(5).max() == 0.0
    assert_allclose(recording.frame(6), depth[6] * 0.001, rtol=1e-6)
    assert any("1 of 9 images are missing or damaged, depth/00005.png" in one for one in text)


def test_a_picture_that_is_damaged_inside_is_named_when_it_is_read(tmp_path, depth):
    folder = open3d(tmp_path, depth)
    path = folder / "depth" / "00005.png"
    complete = bytearray(path.read_bytes())
    middle = len(complete) // 2
    complete[middle : middle + 9] = b"\xff" * 9
    path.write_bytes(complete)

    recording = read_depth(folder)

    with pytest.raises(InvalidFileError, match=r"00005\.png is missing or damaged"):
        recording.frame(5)


def test_one_of_another_size_in_the_middle_is_named(tmp_path, depth):
    folder = open3d(tmp_path, depth)
    save_png(folder / "depth" / "00005.png", pictures(1, 4, 5)[0])

    with pytest.raises(
        InvalidFileError, match=r"00005\.png has 5 x 4 pixels, the others 8 x 6"
    ):
        read_depth(folder)


@pytest.mark.parametrize("kind", ["eight bits", "colored"])
def test_rendered_depth_images_are_refused(tmp_path, depth, kind):
    for number, picture in enumerate(depth):
        gray = (picture // 16).astype(np.uint8)
        pixels = gray if kind == "eight bits" else colors_of(picture)
        save_png(tmp_path / f"{number}.png", pixels)

    with pytest.raises(InvalidFileError, match=r"image of 8 bits; depth is gray and has 16"):
        read_depth(tmp_path, MILLIMETERS)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("intrinsic.json", "{}", "not an Open3D camera"),
        ("intrinsic.json", "[1, 2", "not an Open3D camera"),
        ("intrinsic.json", json.dumps({"width": 8, "height": 6, "intrinsic_matrix": [0.0] * 9}),
         "Give positive focal lengths"),
        ("camera_matrix.csv", "1,2\n3,4", "no 3 x 3 camera matrix"),
        ("camera_matrix.csv", "", "not a table of numbers"),
        ("camera_matrix.csv", "1,2,3\n1,two,3", "line 2: not a number"),
        ("depth.txt", "", "lists no images"),
        ("depth.txt", "1.0", "a time stamp and an image in each line, but has '1.0'"),
        ("depth.txt", "now depth/00001.png", "do not begin with a time stamp"),
        ("depth.txt", "1.0 nowhere.png\n1.1 nothing.png", "2 of 2 depth images"),
    ],
)  # fmt: skip
def test_invalid_metadata_of_a_folder_is_refused(tmp_path, depth, name, content, sentence):
    folder = open3d(tmp_path, depth)
    (folder / name).write_text(content)

    with pytest.raises(InvalidFileError, match=sentence):
        read_depth(folder, DepthSettings() if "json" in name else LENS)


def test_folder_of_other_files_is_not_depth(tmp_path):
    with pytest.raises(InvalidFileError, match="holds no depth of a known format"):
        read_depth(tmp_path)
    with pytest.raises(InvalidFileError, match="is a folder without depth images"):
        read_recording(tmp_path)
