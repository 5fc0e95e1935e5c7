"""A pinhole camera, and recordings of depth that it made."""

import numpy as np
import pytest

from solvers.errors import InvalidMotionError
from solvers.motion.camera import Camera
from solvers.motion.camera_check import field_of_view, odd_camera
from solvers.motion.depth_recording import DepthRecording

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


def test_a_picture_as_wide_as_it_is_far_shows_a_right_angle():
    square = Camera(50.0, 50.0, 49.5, 49.5, 100, 100)
    assert field_of_view(square) == pytest.approx(90.0)
    assert field_of_view(Camera(50.0, 50.0, -0.5, 49.5, 100, 100)) == pytest.approx(63.4349488)
    assert field_of_view(KINECT) == pytest.approx(58.5, abs=0.1)


@pytest.mark.parametrize(
    "camera",
    [
        KINECT, Camera(571.26, 571.26, 319.5, 239.5, 640, 480),
        Camera(365.5, 365.5, 254.9, 205.4, 512, 424),  # Kinect v2
        Camera(251.9, 252.0, 255.5, 255.5, 512, 512),  # Azure Kinect, wide, binned
        Camera(525.0, 525.0, 319.5, 239.5, 640, 480),  # TUM RGB-D
        Camera(213.0, 213.0, 96.0, 128.0, 192, 256),  # iPhone, held upright
        Camera(2666.7, 2666.7, 959.5, 539.5, 1920, 1080),  # Blender, 50 mm on 36 mm
    ],
)  # fmt: skip
def test_cameras_that_there_are_are_not_odd(camera):
    assert odd_camera(camera) == []


@pytest.mark.parametrize(
    ("camera", "words"),
    [
        (Camera(571.26, 571.26, 159.5, 119.5, 320, 240), "show 31 degrees"),
        (Camera(70.0, 70.0, 159.5, 119.5, 320, 240), "show 133 degrees"),
        (Camera(285.63, 365.0, 159.5, 119.5, 320, 240), "285.63 and 365 differ"),
        (Camera(285.63, 285.63, 319.5, 239.5, 320, 240), "far from the middle"),
    ],
)
def test_numbers_of_another_picture_are_told_in_a_sentence(camera, words):
    said = odd_camera(camera)

    assert any(words in sentence for sentence in said)
    assert all("check" in sentence and sentence.endswith(".") for sentence in said)
