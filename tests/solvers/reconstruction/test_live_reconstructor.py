"""A live reconstruction gives frame by frame what the causal one gives for the take."""

from dataclasses import replace

import kinect_walks
import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers import motion, samples
from solvers.errors import InvalidMotionError
from solvers.motion import Sensor, Tracks
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction import (
    LiveReconstructor,
    ObservedFrame,
    ReconstructSettings,
    measure_actor,
    reconstruct,
)
from solvers.recordings import read_recording

CAUSAL = ReconstructSettings(causal=True)


def live_poses(recording, actor, n_frames=None):
    live, states = LiveReconstructor(actor), recording.tracking_state
    return [
        live.update(
            ObservedFrame(
                recording.tracks.positions[frame], None if states is None else states[frame]
            )
        )
        for frame in range(n_frames or recording.n_frames)
    ]


@pytest.fixture(scope="module")
def walk():
    """With a forearm that the tracker only infers, and a foot that is lost for a second."""
    walk = kinect_walks.tracked_walk(
        motion, kinect_walks.true_positions(samples, posture_joints)
    )
    positions = walk.tracks.positions.copy()
    positions[40:70, walk.names.index("FootLeft")] = np.nan
    return walk.with_tracks(walk.tracks.with_positions(positions))


@pytest.mark.parametrize("sensor", [Sensor.KINECT_V1, Sensor.KINECT_V2])
def test_live_poses_are_those_of_the_take(walk, sensor):
    take = replace(walk, sensor=sensor)
    expected = reconstruct(take, settings=CAUSAL)
    found = live_poses(take, measure_actor(take))
    positions = np.stack([each.positions for each in found])
    assert_allclose(positions, expected.tracks.positions, atol=1e-9)
    assert_allclose(
        np.stack([each.confidence for each in found]), expected.confidence, atol=1e-9
    )
    reliability = np.stack([each.reliability for each in found])
    assert_allclose(reliability, expected.reliability.combined, atol=1e-9)


def test_live_poses_of_a_real_take_are_those_of_the_take(recordings):
    path = recordings / "kinect" / "kimore" / "JointPositionExercise1.csv"
    take = read_recording(path).slice(0, 60)
    expected = reconstruct(take, settings=CAUSAL).tracks.positions
    found = live_poses(take, measure_actor(take))
    assert_allclose(np.stack([each.positions for each in found]), expected, atol=1e-9)


def test_actor_of_the_first_seconds_serves_for_the_rest(walk):
    """Errors are at most a little larger than with the actor of the complete take."""
    expected = reconstruct(walk, settings=CAUSAL).tracks.positions[60:]
    found = live_poses(walk, measure_actor(walk.slice(0, 60)))[60:]
    distance = np.linalg.norm(np.stack([each.positions for each in found]) - expected, axis=-1)
    assert np.median(distance) < 0.01
    assert distance.max() < 0.1


def test_frame_without_an_actor_keeps_a_pose(walk):
    """Within a sixth of a second no joint moves by as much as half a step."""
    live = LiveReconstructor(measure_actor(walk))
    states = walk.tracking_state
    for frame in range(20):
        last = live.update(ObservedFrame(walk.tracks.positions[frame], states[frame]))
    missing = ObservedFrame(np.full((20, 3), np.nan), np.zeros(20, np.int8))
    for _ in range(5):
        pose = live.update(missing)
        assert np.isfinite(pose.positions).all()
        assert np.linalg.norm(pose.positions - last.positions, axis=-1).max() < 0.3
    assert (pose.reliability == 0.0).all()


def test_joints_that_are_no_body_are_refused():
    names = ("a", "b", "c")
    points = motion.JointRecording(
        Tracks(names, np.zeros((30, 3, 3)), 30.0), None, Sensor.OTHER
    )
    with pytest.raises(InvalidMotionError):
        measure_actor(points)
