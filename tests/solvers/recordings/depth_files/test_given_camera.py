"""What an animator gives of a camera counts more than the file, number by number."""

import numpy as np
import pytest
from depth_files import depth_npz

from solvers.depth_scene.camera import Camera
from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, read_depth

STORED = Camera(90.0, 91.0, 38.0, 28.0, 80, 60)
MIDDLE = (39.5, 29.5)


@pytest.mark.parametrize(
    ("given", "stored", "expected"),
    [
        ({}, None, None),
        ({"cx": 30.0}, None, None),
        ({"fx": 80.0}, None, (80.0, 80.0, *MIDDLE)),
        ({"fx": 80.0, "fy": 70.0, "cx": 30.0}, None, (80.0, 70.0, 30.0, MIDDLE[1])),
        ({}, STORED, (90.0, 91.0, 38.0, 28.0)),
        ({"cx": 30.0}, STORED, (90.0, 91.0, 30.0, 28.0)),
        ({"fy": 70.0}, STORED, (90.0, 70.0, 38.0, 28.0)),
        ({"fx": 80.0}, STORED, (80.0, 80.0, 38.0, 28.0)),
    ],
)
def test_each_camera_parameter_is_set_stored_or_default(given, stored, expected):
    camera = DepthSettings(**given).camera(80, 60, stored)
    assert (camera and (camera.fx, camera.fy, camera.cx, camera.cy)) == expected


def test_center_alone_may_be_set_for_an_archive(tmp_path):
    path = tmp_path / "wall.npz"
    depth = np.full((2, 60, 80), 2000, np.uint16)
    path.write_bytes(depth_npz(depth, fx=90.0, fy=91.0, cx=38.0, cy=28.0, frame_rate=30.0))

    assert read_depth(path).camera == STORED
    given = read_depth(path, DepthSettings(cx=30.0, cy=20.0)).camera
    assert given == Camera(90.0, 91.0, 30.0, 20.0, 80, 60)


def test_archive_without_its_center_is_refused_until_a_camera_is_given(tmp_path):
    path = tmp_path / "wall.npz"
    np.savez(path, depth=np.full((2, 60, 80), 2000, np.uint16), fx=90.0, fy=91.0)

    with pytest.raises(InvalidFileError, match="cx and cy must be in it"):
        read_depth(path)
    given = read_depth(path, DepthSettings(fx=90.0, fy=91.0)).camera
    assert given == Camera(90.0, 91.0, *MIDDLE, 80, 60)
