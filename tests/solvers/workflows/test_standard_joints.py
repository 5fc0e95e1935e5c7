"""Joints with other names are recognized, with their states and confidence."""

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion import JointRecording, Sensor, Tracks
from solvers.workflows.standard_joints import standardize_joint_names

NAMES = ("head", "leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg")


def test_estimated_hips_have_the_lower_confidence_of_both_legs():
    rng = np.random.default_rng(1)
    positions, messages = rng.normal(size=(4, 5, 3)), rng.random((4, 5))
    state = rng.integers(0, 3, (4, 5))
    take = JointRecording(Tracks(NAMES, positions, 30.0, messages), state, Sensor.OTHER)

    found = standardize_joint_names(take)

    hips, knee = found.names.index("HipCenter"), found.names.index("KneeLeft")
    middle = (positions[:, 1] + positions[:, 2]) / 2.0
    assert_allclose(found.tracks.positions[:, hips], middle, atol=1e-12)
    assert_array_equal(
        found.tracks.confidence[:, hips], np.minimum(messages[:, 1], messages[:, 2])
    )
    assert_array_equal(found.tracking_state[:, hips], np.minimum(state[:, 1], state[:, 2]))
    assert_array_equal(found.tracks.positions[:, knee], positions[:, 3])
    assert_array_equal(found.tracks.confidence[:, knee], messages[:, 3])
    assert_array_equal(found.tracking_state[:, knee], state[:, 3])


def test_missing_states_and_confidence_stay_missing():
    take = JointRecording(Tracks(NAMES, np.ones((4, 5, 3)), 30.0), None, Sensor.OTHER)

    found = standardize_joint_names(take)

    assert found.tracking_state is None
    assert found.tracks.confidence is None
