"""Joint recordings are valid, and the joint tables are trees."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks, joint_parents


@pytest.fixture
def recording() -> JointRecording:
    names = SENSOR_JOINTS[Sensor.KINECT_V1]
    positions = np.arange(5 * 20 * 3.0).reshape(5, 20, 3)
    state = np.arange(100).reshape(5, 20) % 3
    return JointRecording(Tracks(names, positions, 30.0), state, Sensor.KINECT_V1)


@pytest.mark.parametrize(
    ("sensor", "n_joints"),
    [(Sensor.KINECT_V1, 20), (Sensor.KINECT_V2, 25), (Sensor.AZURE_KINECT, 32)],
)
def test_each_sensor_has_its_joints_in_one_tree(sensor, n_joints):
    names = SENSOR_JOINTS[sensor]
    parents = joint_parents(names)

    assert len(set(names)) == n_joints
    assert parents.count(-1) == 1
    for joint in range(n_joints):
        assert names[up_to_the_root(joint, parents)] == names[0]


def up_to_the_root(joint: int, parents: tuple[int, ...]) -> int:
    for _ in parents:
        joint = parents[joint] if parents[joint] >= 0 else joint
    return joint


@pytest.mark.parametrize("sensor", list(SENSOR_JOINTS))
def test_left_and_right_have_symmetric_parents(sensor):
    names = SENSOR_JOINTS[sensor]
    tree = {
        name: names[parent] for name, parent in zip(names, joint_parents(names), strict=True)
    }
    for name, parent in tree.items():
        if name.endswith("Left"):
            assert tree[name.replace("Left", "Right")] == parent.replace("Left", "Right")


@pytest.mark.parametrize(
    ("sensor", "number", "name", "parent"),
    [
        (Sensor.KINECT_V1, 2, "ShoulderCenter", "Spine"),
        (Sensor.KINECT_V1, 19, "FootRight", "AnkleRight"),
        (Sensor.KINECT_V2, 2, "Neck", "SpineShoulder"),
        (Sensor.KINECT_V2, 20, "SpineShoulder", "SpineMid"),
        (Sensor.KINECT_V2, 24, "ThumbRight", "WristRight"),
        (Sensor.AZURE_KINECT, 4, "ClavicleLeft", "SpineChest"),
        (Sensor.AZURE_KINECT, 18, "HipLeft", "Pelvis"),
        (Sensor.AZURE_KINECT, 26, "Head", "Neck"),
        (Sensor.AZURE_KINECT, 31, "EarRight", "Head"),
    ],
)
def test_numbers_and_parents_equal_those_of_the_manufacturer(sensor, number, name, parent):
    names = SENSOR_JOINTS[sensor]

    assert names[number] == name
    assert names[joint_parents(names)[number]] == parent


def test_joint_without_its_parent_gets_the_next_ancestor():
    assert joint_parents(("Neck", "SpineBase", "HandLeft", "beard")) == (1, -1, 1, -1)


def test_slice_keeps_tracks_and_states_aligned(recording):
    cut = recording.slice(1, 3)

    assert (cut.n_frames, cut.n_joints, cut.frame_rate) == (2, 20, 30.0)
    assert_array_equal(cut.tracks.positions, recording.tracks.positions[1:3])
    assert_array_equal(cut.tracking_state, recording.tracking_state[1:3])
    assert cut.sensor is Sensor.KINECT_V1


def test_other_tracks_keep_the_state(recording):
    moved = recording.with_tracks(
        recording.tracks.with_positions(recording.tracks.positions + 1)
    )

    assert_array_equal(moved.tracking_state, recording.tracking_state)
    assert moved.tracking_state.dtype == np.int8
    with pytest.raises(InvalidMotionError, match=r"shape \(2, 20\), not \(5, 20\)"):
        recording.with_tracks(recording.tracks.slice(0, 2))


def test_recording_copies_its_arrays_and_can_be_pickled(recording):
    state = np.full((5, 20), 2, dtype=np.int8)
    result = JointRecording(recording.tracks, state, Sensor.OTHER)
    state[:] = 0

    copied = pickle.loads(pickle.dumps(result))

    assert (copied.tracking_state == 2).all()
    assert copied.sensor is Sensor.OTHER


@pytest.mark.parametrize("wrong", [3, -1, 0.5, np.nan, 258])
def test_recording_raises_for_invalid_states(recording, wrong):
    state = np.zeros((5, 20))
    state[2, 3] = wrong
    with pytest.raises(InvalidMotionError, match="must be 0"):
        JointRecording(recording.tracks, state, Sensor.OTHER)


def test_recording_raises_for_an_invalid_sensor(recording):
    with pytest.raises(
        InvalidMotionError, match=r"'kinect' is not a sensor.*Sensor\.AZURE_KINECT"
    ):
        JointRecording(recording.tracks, None, "kinect")
