"""The lines of a live stream: out and in again, and whatever else may come over a socket."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import JointRecording, Sensor, Tracks
from solvers.recordings.streams.frames.joint_frames import (
    MAX_LINE_BYTES,
    LiveFrame,
    decode_frame,
    encode_frame,
    frames_from_recording,
)

LINE = {
    "format": "mocap-assist-live",
    "version": 1,
    "time": 1.5,
    "body": 3,
    "sensor": "kinect_v2",
    "names": ["Head", "HandLeft"],
    "positions": [[0.1, 1.2, 1.7], None],
    "confidence": [0.9, 0.4],
    "states": [2, 1],
}
"""As docs/formats/joints/live_joints.md shows it."""


def line(**changes) -> bytes:
    message = {**LINE, **changes}
    return json.dumps({key: value for key, value in message.items() if value != "-"}).encode()


def test_reads_what_the_document_shows():
    frame = decode_frame(line())

    assert (frame.time, frame.body, frame.sensor) == (1.5, 3, Sensor.KINECT_V2)
    assert frame.names == ("Head", "HandLeft")
    assert_array_equal(frame.positions, [[0.1, 1.2, 1.7], [np.nan] * 3])
    assert_array_equal(frame.confidence, [0.9, 0.0])
    assert_array_equal(frame.states, [2, 0])


@pytest.mark.parametrize(
    ("left_out", "confidence", "states"),
    [
        ({"confidence": "-"}, [1.0, 0.0], [2, 0]),
        ({"states": "-"}, [0.9, 0.0], None),
        ({"confidence": "-", "states": "-", "body": "-", "sensor": "-"}, [1.0, 0.0], None),
    ],
)
def test_what_may_be_left_out(left_out, confidence, states):
    frame = decode_frame(line(**left_out))

    assert_array_equal(frame.confidence, confidence)
    assert states is None if frame.states is None else frame.states.tolist() == states


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"format": "else"}, "format"),
        ({"version": 2}, "version"),
        ({"time": "-"}, "time"),
        ({"time": "1.5"}, "time"),
        ({"time": True}, "time"),
        ({"time": 1e300}, "time"),
        ({"body": -1}, "body"),
        ({"body": 1.5}, "body"),
        ({"body": [1]}, "body"),
        ({"sensor": "eye"}, "sensor"),
        ({"sensor": ["eye"]}, "sensor"),
        ({"names": []}, "names"),
        ({"names": ["Head", "Head"]}, "names"),
        ({"names": ["Head", 2]}, "names"),
        ({"names": ["Head", ["HandLeft"]]}, "names"),
        ({"names": ["Head", "x" * 65]}, "names"),
        ({"names": ["Head", "a\nb"]}, "names"),
        ({"names": [f"joint {number}" for number in range(65)]}, "names"),
        ({"positions": "-"}, "positions"),
        ({"positions": [[0, 0, 0]]}, "positions"),
        ({"positions": [[0, 0], None]}, "coordinates"),
        ({"positions": [[0, 0, "1"], None]}, "position"),
        ({"positions": [[0, 0, None], None]}, "position"),
        ({"positions": [[0, 0, 101], None]}, "position"),
        ({"positions": [[0, 0, 10**400], None]}, "position"),
        ({"positions": {"Head": [0, 0, 0]}}, "positions"),
        ({"confidence": [1]}, "confidences"),
        ({"confidence": [1, 1.1]}, "confidence"),
        ({"confidence": [-0.1, 1]}, "confidence"),
        ({"confidence": [None, 1]}, "confidence"),
        ({"states": [2, 3]}, "states"),
        ({"states": [2, 1.0]}, "states"),
        ({"states": [2, True]}, "states"),
    ],
)
def test_decode_frame_refuses_invalid_values(changes, words):
    with pytest.raises(InvalidMotionError, match=words):
        decode_frame(line(**changes))


@pytest.mark.parametrize(
    "damaged",
    [
        b"",
        b"null",
        b"[1]",
        b"\xff\xfe",
        line()[:-1],
        line()[:-1] + b', "more": NaN}',
        line().replace(b"1.5", b"NaN"),
        line().replace(b"1.5", b"Infinity"),
        line().replace(b"1.5", b"1e999"),
        b"[" * 20_000,
        b'{"a":' * 5_000,
        b"9" * 10_000,
        line() + b" " * MAX_LINE_BYTES,
    ],
)
def test_refuses_what_is_no_frame(damaged):
    with pytest.raises(InvalidMotionError):
        decode_frame(damaged)


@given(st.binary(max_size=300))
def test_bytes_of_any_kind_are_a_frame_or_refused(noise):
    with pytest.raises(InvalidMotionError):
        decode_frame(noise)


@given(
    st.dictionaries(
        st.sampled_from(sorted(LINE)),
        st.recursive(
            st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
            lambda each: st.lists(each, max_size=4) | st.dictionaries(st.text(), each),
            max_leaves=10,
        ),
    )
)
def test_json_of_any_kind_is_a_frame_or_refused(changes):
    message = json.dumps({**LINE, **changes}).encode()

    try:
        frame = decode_frame(message)
    except InvalidMotionError:
        return

    assert np.isfinite(frame.time) and len(frame.positions) == len(frame.names)
    assert ((frame.confidence >= 0) & (frame.confidence <= 1)).all()
    assert not np.isinf(frame.positions).any()


@given(
    st.integers(1, 64).flatmap(
        lambda n: st.tuples(
            st.lists(
                st.none() | st.tuples(*[st.floats(-100, 100)] * 3), min_size=n, max_size=n
            ),
            st.lists(st.floats(0, 1), min_size=n, max_size=n),
            st.none() | st.lists(st.integers(0, 2), min_size=n, max_size=n),
        )
    ),
    st.floats(-1e6, 1e6),
)
def test_frame_survives_encoding_and_decoding(joints, time):
    indices, confidence, states = joints
    positions = np.array([(np.nan,) * 3 if index is None else index for index in indices])
    observed = np.isfinite(positions).all(axis=-1)
    sent = LiveFrame(
        time,
        7,
        tuple(f"joint {number}" for number in range(len(indices))),
        positions,
        np.where(observed, confidence, 0.0),
        None if states is None else np.where(observed, states, 0).astype(np.int8),
    )

    came = decode_frame(encode_frame(sent))

    assert came.time == pytest.approx(sent.time, abs=1e-6)
    assert (came.body, came.names, came.sensor) == (sent.body, sent.names, sent.sensor)
    assert_allclose(came.positions, sent.positions, atol=1e-4)
    assert_allclose(came.confidence, sent.confidence, atol=1e-4)
    assert_array_equal(came.states, sent.states)


def test_frames_of_a_recording():
    positions = np.arange(12.0).reshape(2, 2, 3)
    positions[1, 1] = np.nan
    states = np.array([[2, 1], [2, 1]], dtype=np.int8)
    tracks = Tracks(("Head", "HandLeft"), positions, 25.0)

    first, second = frames_from_recording(
        JointRecording(tracks, states, Sensor.KINECT_V2), body=4
    )

    assert (first.time, second.time, second.body) == (0.0, 1 / 25, 4)
    assert_array_equal(first.confidence, [1.0, 0.5])
    assert_array_equal(second.confidence, [1.0, 0.0])
    assert_array_equal(second.positions, positions[1])


def test_lists_without_end_are_refused():
    with pytest.raises(InvalidMotionError, match="more than 256 lists"):
        decode_frame(b"[" + b"[]," * 10_900 + b"[]]")
