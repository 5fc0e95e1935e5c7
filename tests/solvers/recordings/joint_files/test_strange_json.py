"""JSON with empty frames, percentages, several clocks or data of something else is read."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe
from numpy.testing import assert_allclose

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


@pytest.mark.parametrize("scale", [1.0, 100.0])
@pytest.mark.parametrize("turn", [(1, 1, 1), (1, -1, -1)])
def test_confidence_may_be_in_percent(read_any, scale, turn):
    """A wrist is seen with 1 % in one frame, and has no stated visibility in another."""
    seen = np.full((N, 33), 0.9)
    seen[3, 15] = 0.01
    frames = [
        {"landmarks": [
            {"x": turn[0] * x, "y": turn[1] * y, "z": turn[2] * z, "visibility": scale * each}
            for (x, y, z), each in zip(POINTS[k, :, :3].tolist(), seen[k].tolist(), strict=True)
        ]}
        for k in range(N)
    ]  # fmt: skip
    del frames[5]["landmarks"][16]["visibility"]

    recording = read_any(json.dumps(frames))

    columns = [recording.names.index(f"{side}_wrist") for side in ("left", "right")]
    found = recording.tracks.confidence[:, columns]
    expected = np.full((N, 2), 0.9)
    expected[3, 0], expected[5, 1] = 0.01, 1.0
    assert_allclose(found, expected)
