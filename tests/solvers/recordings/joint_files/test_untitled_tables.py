"""Tables of numbers without titles are read where these are a known order of joints."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording
from solvers.motion.skeletons.point_layouts import LAYOUTS
from solvers.recordings.conventions import are_frame_numbers

F, RATE_HZ = 40, 25.0
SMPL = (
    "hips", "leftUpperLeg", "rightUpperLeg", "spine", "leftLowerLeg", "rightLowerLeg", "chest",
    "leftFoot", "rightFoot", "upperChest", "leftToes", "rightToes", "neck", "leftShoulder",
    "rightShoulder", "head", "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
    "leftHand", "rightHand",
)  # fmt: skip
"""Roles in the order of SMPL."""


@pytest.fixture(scope="module")
def body(walker):
    """Positions of the joints of SMPL, shape (F, 22, 3), meters."""
    return np.stack([walker[role][:F] for role in SMPL], axis=1)


@pytest.mark.parametrize("above", [[], ["time"], ["frame", "time"]])
@pytest.mark.parametrize("confidence", [False, True])
def test_numbers_of_a_known_order_need_no_titles(read_any, body, above, confidence):
    """They are not refused for the lack of titles."""
    if confidence:
        body = np.concatenate([body, np.ones((*body.shape[:2], 1))], axis=-1)
    stamps = {"frame": str, "time": lambda k: str(k / RATE_HZ)}
    lines = [
        ",".join([*(stamps[each](k) for each in above), *(f"{x:.5f}" for x in frame.flat)])
        for k, frame in enumerate(body)
    ]

    recording = read_any("\n".join(lines))

    assert isinstance(recording, JointRecording)
    assert recording.frame_rate == (RATE_HZ if above else 20.0)
    assert recording.names == LAYOUTS["SMPL"]
    sizes = [np.ptp(each[..., 2]) for each in (recording.tracks.positions, body)]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-3)


@pytest.mark.parametrize("order", ["pq", "pqc", "cpq"])
def test_quaternions_next_to_the_positions_are_left_out(read_any, body, rng, order):
    """As in dumps of the Kinect's joints; what is no quaternion is no joint."""
    quaternions = rng.normal(size=(*body.shape[:2], 4))
    quaternions /= np.linalg.norm(quaternions, axis=-1, keepdims=True)
    quaternions[:, 3] = 0.0
    states = np.full((*body.shape[:2], 1), 2.0)
    parts = {"p": body, "q": quaternions, "c": states}
    values = np.concatenate([parts[each] for each in order], axis=-1)

    recording = read_any("\n".join(" ".join(f"{x:.5f}" for x in row.flat) for row in values))

    assert recording.names == LAYOUTS["SMPL"]
    sizes = [np.ptp(each[..., 2]) for each in (recording.tracks.positions, body)]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-3)
    parts["q"] *= 1.5
    values = np.concatenate([parts[each] for each in order], axis=-1)
    with pytest.raises(InvalidFileError, match="table without titles"):
        read_any("\n".join(" ".join(f"{x:.5f}" for x in row.flat) for row in values))


@pytest.mark.parametrize("above", [[], ["time"], ["frame", "time"]])
def test_the_values_of_pandas_in_json_are_such_a_table(read_any, body, above):
    """Times among the values are not those of a joint."""
    stamps = {"frame": lambda k: k, "time": lambda k: k / RATE_HZ}
    rows = [
        [*(stamps[each](k) for each in above), *frame.ravel().tolist()]
        for k, frame in enumerate(body)
    ]

    recording = read_any(json.dumps(rows))

    assert recording.frame_rate == (RATE_HZ if above else 20.0)
    sizes = [np.ptp(each[..., 2]) for each in (recording.tracks.positions, body)]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-3)


def test_values_of_no_body_in_json_are_refused(read_any, body):
    rows = [[k / RATE_HZ, *frame[::-1].ravel().tolist()] for k, frame in enumerate(body)]

    with pytest.raises(InvalidFileError, match="without titles, and its numbers form no body"):
        read_any(json.dumps(rows))


def test_numbers_of_frames_are_no_seconds(read_any, body):
    """As in UTKinect: without titles, the first cell counts the frames from any number."""
    lines = [
        f"{250 + k} " + " ".join(f"{x:.5f}" for x in frame.flat) for k, frame in enumerate(body)
    ]

    recording = read_any("\n".join(lines))

    assert (recording.n_frames, recording.frame_rate) == (F, 20.0)


@pytest.mark.parametrize(("step", "rate"), [(1, 20.0), (2, 15.0), (5, 6.0), (20, 50.0)])
def test_small_steps_are_those_of_frames(read_any, body, step, rate):
    """Numbers two apart are not milliseconds, 500 Hz. SMPL has 20 Hz by default."""
    lines = [
        f"{step * k} " + " ".join(f"{x:.5f}" for x in frame.flat)
        for k, frame in enumerate(body)
    ]

    recording = read_any("\n".join(lines))

    assert (recording.n_frames, recording.frame_rate) == (F, pytest.approx(rate))


@pytest.mark.parametrize(
    ("numbers", "are_frames"),
    [
        ([0, 2, 4, 6], True),
        ([7, 8, 9, 30, 31], True),
        ([0, 16, 33, 50, 66], False),
        ([0, 1, 17, 33, 50], False),
        ([0, 4, 8, 12, 17], False),
        ([1577836800, 1577836801, 1577836802], False),
        ([0.0, 0.5, 1.0], False),
    ],
)
def test_milliseconds_and_seconds_are_no_numbers_of_frames(numbers, are_frames):
    assert are_frame_numbers(numbers) == are_frames


def test_numbers_of_no_body_are_refused(read_any, rng):
    lines = [",".join(f"{x:.4f}" for x in row) for row in rng.normal(size=(20, 51))]

    with pytest.raises(InvalidFileError, match=r"form no body in a known order.*LeftHand_x"):
        read_any("\n".join(lines))
