"""A pinhole camera, and recordings of depth that it made."""

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import InvalidMotionError

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)


def test_a_point_half_a_metre_right_and_up_falls_where_pencil_and_paper_say():
    seen = KINECT.project(np.array([0.5, -0.25, 2.0]))
    np.testing.assert_allclose(seen, [159.5 + 285.63 / 4, 119.5 - 285.63 / 8])


def test_what_is_behind_the_camera_falls_nowhere():
    assert np.isnan(KINECT.project(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0]]))).all()


def test_back_projected_pixels_fall_on_themselves():
    depth = np.random.default_rng(0).uniform(0.5, 4.0, (240, 320))
    points = KINECT.back_project(depth)
    rows, columns = np.mgrid[:240, :320]
    np.testing.assert_allclose(KINECT.project(points), np.stack([columns, rows], -1), atol=1e-9)
    np.testing.assert_allclose(points[..., 2], depth)


def test_every_third_pixel_sees_what_it_saw():
    small = KINECT.every(3)
    assert (small.width, small.height) == (107, 80)
    np.testing.assert_allclose(small.rays(), KINECT.rays()[::3, ::3])


@pytest.mark.parametrize("wrong", [(0.0, 1.0, 0.0, 0.0, 4, 4), (1.0, 1.0, 0.0, 0.0, 0, 4)])
def test_impossible_cameras_are_refused(wrong):
    with pytest.raises(InvalidMotionError, match=r"sees nothing|holds nothing"):
        Camera(*wrong)


def test_frames_are_read_when_asked_for_and_holes_are_zero():
    asked = []

    def read(index):
        asked.append(index)
        return np.full((240, 320), [np.nan, -1.0, np.inf, float(index)][index], np.float32)

    recording = DepthRecording(KINECT, 4, 30.0, read)
    assert asked == []
    assert [float(recording.frame(index).max()) for index in range(4)] == [0.0, 0.0, 0.0, 3.0]
    assert asked == [0, 1, 2, 3]
    assert recording.color(0) is None


@pytest.mark.parametrize("index", [-1, 4])
def test_frames_that_are_not_there_are_named(index):
    recording = DepthRecording(KINECT, 4, 30.0, lambda _: np.zeros((240, 320), np.float32))
    with pytest.raises(InvalidMotionError, match=rf"no frame {index}.*0 to 3"):
        recording.frame(index)


def test_a_frame_of_another_size_is_refused():
    recording = DepthRecording(KINECT, 1, 30.0, lambda _: np.zeros((10, 10), np.float32))
    with pytest.raises(InvalidMotionError, match="as the camera"):
        recording.frame(0)
