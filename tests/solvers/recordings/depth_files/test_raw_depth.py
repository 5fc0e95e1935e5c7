"""Raw depth: 16-bit pixels without a header."""

import numpy as np
import pytest
from depth_files import pictures
from numpy.testing import assert_allclose

from solvers.depth_scene.camera import Camera
from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, is_depth_recording, read_recording
from solvers.recordings.depth_files.raw import read_depth_raw

SHAPE = (480, 640)


@pytest.fixture
def write(make_writer):
    return make_writer("take.depth")


def test_raw_frames_of_skeltrack(recordings):
    for path in sorted((recordings / "depth" / "skeltrack").iterdir()):
        expected = np.fromfile(path, "<u2").reshape(480, 640) * 0.001

        recording = read_recording(path)

        assert (recording.n_frames, recording.camera.width) == (1, 640)
        assert_allclose(recording.frame(0), expected, rtol=1e-6)


def slope() -> np.ndarray:
    """A wall that recedes from 1 m to 3 m, in millimeters."""
    return np.broadcast_to(np.linspace(1000, 3000, SHAPE[1]), SHAPE).astype("<u2")


def test_one_image_of_a_wall_is_depth(write):
    assert is_depth_recording(write(slope().tobytes()))


def random_numbers() -> np.ndarray:
    return np.random.default_rng(0).integers(1, 9000, SHAPE)


def farther_than_a_kinect_sees() -> np.ndarray:
    return slope().astype(int) + 8000


def mostly_zero() -> np.ndarray:
    return np.where(np.arange(SHAPE[0])[:, None] < 5, slope(), 0)


@pytest.mark.parametrize("numbers", [random_numbers, farther_than_a_kinect_sees, mostly_zero])
def test_other_numbers_of_16_bits_are_no_depth(write, numbers):
    assert not is_depth_recording(write(numbers().astype("<u2").tobytes()))


def test_raw_frames_of_another_camera(write):
    depth = pictures(3)

    recording = read_depth_raw(
        write(depth.tobytes()), DepthSettings(width=8, height=6, fx=9.0, fy=8.0)
    )

    assert (recording.n_frames, recording.camera) == (3, Camera(9.0, 8.0, 3.5, 2.5, 8, 6))
    assert_allclose(recording.frame(2), depth[2] * 0.001, rtol=1e-6)
    with pytest.raises(InvalidFileError, match=r"8 x 6 pixels from an unknown camera"):
        read_depth_raw(write(depth.tobytes()), DepthSettings(width=8, height=6))
    with pytest.raises(InvalidFileError, match="is not a multiple of an image of 640 x 480"):
        read_depth_raw(write(depth.tobytes()))
