"""Numbers of a camera that cannot be right are told."""

import pytest

from solvers.motion.camera import Camera
from solvers.motion.camera_doubts import camera_doubts

USUAL = (
    Camera(285.63, 285.63, 159.0, 120.0, 320, 240),  # Kinect v1
    Camera(504.0, 504.1, 325.0, 331.0, 640, 576),  # Azure Kinect, narrow
    Camera(251.0, 251.0, 255.0, 257.0, 512, 512),  # Azure Kinect, wide
    Camera(365.0, 365.0, 256.0, 212.0, 512, 424),  # Kinect v2
    Camera(212.0, 212.0, 127.0, 95.0, 256, 192),  # iPhone LiDAR
    Camera(915.0, 913.0, 640.0, 360.0, 1280, 720),  # RealSense
    Camera(30.0, 30.0, 3.5, 3.0, 8, 7),
)


@pytest.mark.parametrize("camera", USUAL)
def test_usual_cameras_are_not_doubted(camera):
    assert camera_doubts(camera) == ()
    assert camera_doubts(camera.every(2)) == ()


@pytest.mark.parametrize(
    ("camera", "said"),
    [
        (Camera(571.0, 571.0, 319.5, 239.5, 320, 240), "pixel 320, 240 of 320 x 240"),
        (Camera(285.0, 285.0, 159.5, 119.5, 640, 480), "for pictures of another size"),
        (Camera(2.0, 2.0, 159.5, 119.5, 320, 240), "an angle of 179 degrees"),
        (Camera(9000.0, 9000.0, 159.5, 119.5, 320, 240), "an angle of 2 degrees"),
        (Camera(285.0, 480.0, 159.5, 119.5, 320, 240), "285 across and 480 up"),
    ],
)
def test_wrong_numbers_are_told_in_one_sentence(camera, said):
    (sentence,) = camera_doubts(camera)
    assert said in sentence
