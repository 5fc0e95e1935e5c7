"""Pinhole cameras and depth recordings."""

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import InvalidMotionError

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)


def test_project_matches_a_hand_computed_pixel():
    pixel = KINECT.project(np.array([0.5, -0.25, 2.0]))
    np.testing.assert_allclose(pixel, [159.5 + 285.63 / 4, 119.5 - 285.63 / 8])


def test_project_returns_nan_behind_the_camera():
    assert np.isnan(KINECT.project(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0]]))).all()


def test_project_inverts_back_project():
    depth = np.random.default_rng(0).uniform(0.5, 4.0, (240, 320))
    points = KINECT.back_project(depth)
    rows, columns = np.mgrid[:240, :320]
    np.testing.assert_allclose(KINECT.project(points), np.stack([columns, rows], -1), atol=1e-9)
    np.testing.assert_allclose(points[..., 2], depth)


def test_subsampled_camera_keeps_its_rays():
    small = KINECT.every(3)
    assert (small.width, small.height) == (107, 80)
    np.testing.assert_allclose(small.rays(), KINECT.rays()[::3, ::3])


@pytest.mark.parametrize("wrong", [(0.0, 1.0, 0.0, 0.0, 4, 4), (1.0, 1.0, 0.0, 0.0, 0, 4)])
def test_camera_raises_for_invalid_intrinsics(wrong):
    with pytest.raises(InvalidMotionError, match=r"are invalid|is empty"):
        Camera(*wrong)


def test_frames_are_read_on_demand_with_zeros_in_holes():
    requested = []

    def read(index):
        requested.append(index)
        return np.full((240, 320), [np.nan, -1.0, np.inf, float(index)][index], np.float32)

    recording = DepthRecording(KINECT, 4, 30.0, read)
    assert requested == []
    assert [float(recording.frame(index).max()) for index in range(4)] == [0.0, 0.0, 0.0, 3.0]
    assert requested == [0, 1, 2, 3]
    assert recording.color(0) is None


@pytest.mark.parametrize("index", [-1, 4])
def test_frame_raises_for_an_index_out_of_range(index):
    recording = DepthRecording(KINECT, 4, 30.0, lambda _: np.zeros((240, 320), np.float32))
    with pytest.raises(InvalidMotionError, match=rf"no frame {index}.*0 to 3"):
        recording.frame(index)


def test_frame_raises_for_another_image_size():
    recording = DepthRecording(KINECT, 1, 30.0, lambda _: np.zeros((10, 10), np.float32))
    with pytest.raises(InvalidMotionError, match="as the camera"):
        recording.frame(0)
