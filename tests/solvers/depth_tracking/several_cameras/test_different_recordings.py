"""Recordings with the same images are no two cameras."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import recorded, waving

from solvers.depth_tracking.several_cameras import check_different
from solvers.errors import InvalidMotionError
from solvers.workflows import capture_from_cameras


def test_same_images_are_refused_before_anything_is_tracked():
    poses = waving(6)
    first, other, copy = (recorded(each) for each in (poses, poses + 0.01, poses))

    with pytest.raises(InvalidMotionError, match="Cameras 1 and 3 have the same images"):
        capture_from_cameras([first, other, copy])


def test_recordings_that_differ_in_one_pixel_or_in_length_are_different():
    first = recorded(waving(6))

    def noisy(frame):
        image = first.frame(frame).copy()
        image[60, 80] += np.float32(0.001)
        return image

    check_different([first, replace(first, read_depth=noisy), replace(first, n_frames=5)])
