"""The figures of a recording, counted by hand."""

import json

import numpy as np
import pytest

from solvers.motion import JointRecording, Motion, Sensor, Skeleton, Tracks
from solvers.recordings import recording_figures

N_FRAMES, RATE = 10, 5.0


@pytest.fixture
def tracks(rng):
    """Marker b has two gaps, of one and of three frames, c one at the end; d has no data."""
    positions = rng.normal(size=(N_FRAMES, 4, 3))
    positions[2, 1] = positions[5:8, 1] = positions[9, 2] = positions[:, 3] = np.nan
    positions[0, 0] = 0.0  # the origin is a place, here
    return Tracks(("a", "b", "c", "d"), positions, RATE)


def test_markers_and_their_gaps_are_counted(tracks):
    figures = recording_figures(tracks)

    assert figures == {
        "markers": 4,
        "n_frames": 10,
        "frame_rate_hz": 5.0,
        "duration_s": 2.0,
        "gaps": 3,
        "missing_share": pytest.approx((1 + 3 + 1 + 10) / 40),
        "longest_gap_s": pytest.approx(3 / 5),
        "never_seen": ["d"],
    }
    json.dumps(figures, allow_nan=False)


def test_joints_of_a_camera_name_it(tracks):
    figures = recording_figures(JointRecording(tracks, None, Sensor.KINECT_V2))

    assert figures["joints"] == 4
    assert "markers" not in figures
    assert figures["sensor"] == Sensor.KINECT_V2.value


def test_the_end_sites_of_a_skeleton_do_not_count():
    skeleton = Skeleton(("hips", "leg", "leg_end"), (-1, 0, 1), np.ones((3, 3)))
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (N_FRAMES, 3, 1))
    rotations[3:5, 1] = np.nan
    indices = np.zeros((N_FRAMES, 3))
    indices[0] = np.nan

    figures = recording_figures(Motion(skeleton, rotations, indices, RATE))

    assert (figures["joints"], figures["gaps"], figures["longest_gap_s"]) == (2, 2, 2 / RATE)
    assert figures["missing_share"] == pytest.approx(3 / 20)
    assert figures["never_seen"] == []


def test_without_gaps_there_is_no_longest(rng):
    complete = Tracks(("a",), rng.normal(size=(3, 1, 3)), RATE)

    figures = recording_figures(complete)

    assert (figures["gaps"], figures["longest_gap_s"], figures["missing_share"]) == (0, 0, 0)
