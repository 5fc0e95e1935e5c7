"""The simulated actor keeps bone lengths and performs gestures at the stated times."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidSettingError
from solvers.motion import SENSOR_JOINTS, Sensor
from solvers.samples import PerformanceSettings, perform_gestures

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]


def joint(performance, name):
    return performance.positions[:, NAMES.index(name)]


def test_arms_keep_their_lengths():
    performance = perform_gestures(["hand up", "wave left", "clap", "zoom in", "turn"])

    for side in ("Left", "Right"):
        chain = [joint(performance, part + side) for part in ("Shoulder", "Elbow", "Wrist")]
        upper, fore = (
            np.linalg.norm(far - near, axis=-1) for near, far in itertools.pairwise(chain)
        )
        assert_allclose(upper, 0.28, atol=1e-9)
        assert_allclose(fore, 0.25, atol=1e-9)


def test_gestures_end_at_the_stated_times():
    performance = perform_gestures(["hand up", "clap"])
    (_, up), (_, clapped) = performance.made
    frames = [int(np.argmin(np.abs(performance.times - time))) for time in (up, clapped - 0.35)]

    height = joint(performance, "WristRight")[frames[0], 2]
    assert height == pytest.approx(joint(performance, "ShoulderRight")[0, 2] + 0.45, abs=0.01)
    hands = joint(performance, "WristRight") - joint(performance, "WristLeft")
    assert np.linalg.norm(hands[frames[1]]) < 0.08


def test_actor_faces_the_camera():
    performance = perform_gestures(["zoom in"])

    assert (joint(performance, "ShoulderRight")[:, 0] < 0).all()
    assert joint(performance, "WristRight")[:, 1].min() < -0.25
    assert joint(performance, "FootLeft")[0, 2] == pytest.approx(0.03)


def test_noise_is_reproducible():
    settings = PerformanceSettings(noise=0.01, hidden=1.0, dropped=0.2, lateness=0.01, seed=3)

    one, two = perform_gestures(["clap"], settings), perform_gestures(["clap"], settings)

    for name in ("times", "positions", "confidence"):
        assert_allclose(getattr(one, name), getattr(two, name))
    plain = perform_gestures(["clap"])
    assert 0.6 < len(one.times) / len(plain.times) < 1.0 and (one.confidence < 0.5).any()
    assert (np.diff(one.times) >= 0).all()


def test_unknown_gesture_raises():
    with pytest.raises(InvalidSettingError, match="shrug: not a gesture of rest, hand up"):
        perform_gestures(["shrug"])
