"""The stature of an actor is found from a few frames, whatever the first frame shows."""

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body import default_body
from solvers.depth_tracking.capturing.find_body import STATURES_M, find_body
from solvers.depth_tracking.detection import detect_pose, score_body
from solvers.depth_tracking.forest import load_pixel_forest
from solvers.errors import InvalidMotionError


@pytest.fixture(scope="module")
def forest():
    return load_pixel_forest()


def sized(factor, n_frames=3):
    """A waving adult in a room that is larger or smaller by a factor."""
    drawn = recorded(waving(n_frames))
    return DepthRecording(
        CAMERA, n_frames, 30.0, lambda frame: drawn.frame(frame) * np.float32(factor)
    )


def height(body):
    return body.lengths.sum()


@pytest.mark.parametrize("stature", STATURES_M)
def test_stature_is_found(forest, stature):
    found = find_body(sized(stature / 1.75), forest, refine=False)

    assert height(found) == pytest.approx(height(default_body(stature)))


def test_a_frame_without_a_person_is_passed_over(forest):
    """It is the largest: a wall of two columns."""
    actor = sized(1.45 / 1.75)
    wall = np.zeros((CAMERA.height, CAMERA.width), np.float32)
    wall[:, :2] = 50.0

    found = find_body(
        DepthRecording(CAMERA, 3, 30.0, lambda frame: actor.frame(frame) if frame else wall),
        forest,
        refine=False,
    )

    assert height(found) == pytest.approx(height(default_body(1.45)))


def test_only_empty_frames_are_refused(forest):
    wall = np.zeros((CAMERA.height, CAMERA.width), np.float32)
    wall[:3, :2] = 2.0
    with pytest.raises(InvalidMotionError, match="No person is detected"):
        find_body(DepthRecording(CAMERA, 2, 30.0, lambda frame: wall), forest, refine=False)


def test_score_is_highest_for_the_body_that_is_there(forest):
    image = sized(1.6 / 1.75).frame(0)
    detected = detect_pose(image, CAMERA, default_body(), forest)

    scores = {
        stature: score_body(default_body(stature), detected, image, CAMERA)
        for stature in (1.3, *STATURES_M)
    }

    assert max(scores, key=scores.get) == 1.6
