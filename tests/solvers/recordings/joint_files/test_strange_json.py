"""JSON with empty frames, percentages, several clocks and data that are no positions is read."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe

from solvers.recordings.joint_files import is_frames_json

N = 40
POINTS = mediapipe(N)


def landmarks(k, **others):
    return [dict(zip("xyz", row, strict=True)) | others for row in POINTS[k, :, :3].tolist()]


@pytest.mark.parametrize("empty", ["[[]]", "[]", "null", "[[], []]"])
def test_many_empty_frames_come_before_the_first_person(read_any, empty):
    """The time of a search that tries all splits of the brackets doubles with each frame."""
    n_empty = 2000
    people = [json.dumps([{"id": 1, "keypoints3D": landmarks(k)}]) for k in range(N)]
    text = f"[{', '.join([empty] * n_empty + people)}]"

    assert is_frames_json(text.encode())
    assert np.isfinite(read_any(text).tracks.positions).all(axis=(1, 2))[-N:].all()
