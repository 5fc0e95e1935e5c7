"""Implausible camera intrinsics give warnings."""

import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.camera_checks import check_intrinsics, field_of_view

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
REAL_CAMERAS = (
    KINECT,
    Camera(285.63, 285.63, 159.0, 120.0, 320, 240),
    Camera(571.26, 571.26, 319.5, 239.5, 640, 480),
    Camera(365.5, 365.5, 254.9, 205.4, 512, 424),  # Kinect v2
    Camera(504.0, 504.1, 325.0, 331.0, 640, 576),  # Azure Kinect, narrow
    Camera(251.9, 252.0, 255.5, 255.5, 512, 512),  # Azure Kinect, wide, binned
    Camera(525.0, 525.0, 319.5, 239.5, 640, 480),  # TUM RGB-D
    Camera(213.0, 213.0, 96.0, 128.0, 192, 256),  # iPhone, held upright
    Camera(915.0, 913.0, 640.0, 360.0, 1280, 720),  # RealSense
    Camera(2666.7, 2666.7, 959.5, 539.5, 1920, 1080),  # Blender, 50 mm on 36 mm
)


def test_field_of_view_is_a_right_angle_when_width_is_twice_the_distance():
    square = Camera(50.0, 50.0, 49.5, 49.5, 100, 100)
    assert field_of_view(square) == pytest.approx(90.0)
    assert field_of_view(Camera(50.0, 50.0, -0.5, 49.5, 100, 100)) == pytest.approx(63.4349488)
    assert field_of_view(KINECT) == pytest.approx(58.5, abs=0.1)


@pytest.mark.parametrize("camera", REAL_CAMERAS)
def test_check_intrinsics_accepts_real_cameras(camera):
    assert check_intrinsics(camera) == ()
    assert check_intrinsics(camera.every(2)) == ()


@pytest.mark.parametrize(
    ("camera", "words"),
    [
        (Camera(571.26, 571.26, 159.5, 119.5, 320, 240), "be 31 degrees"),
        (Camera(70.0, 70.0, 159.5, 119.5, 320, 240), "be 133 degrees"),
        (Camera(2.0, 2.0, 159.5, 119.5, 320, 240), "be 179 degrees"),
        (Camera(285.63, 365.0, 159.5, 119.5, 320, 240), "285.63 and 365 differ"),
        (Camera(285.63, 285.63, 319.5, 239.5, 320, 240), "far from the center"),
        (Camera(285.0, 285.0, 159.5, 119.5, 640, 480), "of 640 x 480 pixels: check cx and cy"),
    ],
)
def test_check_intrinsics_warns_about_another_image_size(camera, words):
    warnings = check_intrinsics(camera)

    assert any(words in sentence for sentence in warnings)
    assert all("check" in sentence and sentence.endswith(".") for sentence in warnings)
    assert len(warnings) == len(set(warnings))
