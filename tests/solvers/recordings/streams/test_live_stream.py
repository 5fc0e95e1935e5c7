"""Frames in order and of one body, whatever comes; and what stands between two claps."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError, InvalidSettingError
from solvers.motion import Sensor
from solvers.recordings.streams.frames.joint_frames import LiveFrame, decode_frame, encode_frame
from solvers.recordings.streams.frames.stream_reader import (
    MAX_LINES,
    StreamReader,
    recording_from_frames,
)
from solvers.recordings.streams.receiver import MAX_DATAGRAMS, Receiver
from solvers.samples import perform_gestures


def frame(time, body=0, position=0.0):
    return LiveFrame(time, body, ("Head",), np.full((1, 3), position), np.ones(1))


def read(reader, *frames):
    return [
        (came.time, came.body) for each in frames for came in reader.read(encode_frame(each))
    ]


def test_late_frames_are_dropped_and_counted():
    reader = StreamReader()

    came = read(reader, *[frame(time) for time in (0.0, 0.1, 0.1, 0.05, 0.2)])

    assert came == [(0.0, 0), (0.1, 0), (0.2, 0)]
    assert (reader.counts.frames, reader.counts.late, reader.counts.dropped) == (3, 2, 2)


def test_a_sender_that_was_started_again_is_heard():
    reader = StreamReader()

    came = read(reader, frame(100.0), frame(0.0), frame(0.1))

    assert came == [(100.0, 0), (0.0, 0), (0.1, 0)]


def test_a_short_take_that_is_sent_again_is_heard_but_for_its_first_frames():
    reader = StreamReader()
    times = [number / 30 for number in range(30)]

    came = read(reader, *[frame(time) for time in times + times])

    assert [time for time, _ in came] == pytest.approx(times + times[4:], abs=1e-6)


def test_two_senders_at_once_do_not_take_turns():
    reader = StreamReader()
    pairs = [(1.0 + number / 30, number / 30) for number in range(30)]

    came = read(reader, *[frame(time) for pair in pairs for time in pair])

    assert [time for time, _ in came] == pytest.approx([time for time, _ in pairs], abs=1e-6)


def test_the_first_body_is_followed_until_it_is_gone():
    reader = StreamReader()

    came = read(
        reader, frame(0.0, 2), frame(0.0, 1), frame(0.1, 2), frame(0.9, 1), frame(1.2, 1),
        frame(1.3, 2), frame(1.3, 1),
    )  # fmt: skip

    assert came == [(0.0, 2), (0.1, 2), (1.2, 1), (1.3, 1)]
    assert reader.counts.others == 3


def test_one_datagram_may_hold_many_lines_and_bad_ones():
    reader = StreamReader()
    lines = [encode_frame(frame(0.0)), b"nonsense\n", b"\r\n", encode_frame(frame(0.1))]

    came = list(reader.read(b"".join(lines)))

    assert [each.time for each in came] == [0.0, 0.1]
    assert reader.counts.unreadable == 1
    assert reader.counts.why == "A frame is not readable as JSON."


@given(st.lists(st.binary(max_size=80) | st.floats(0, 9).map(lambda t: encode_frame(frame(t)))))
def test_nothing_raises_and_all_is_counted(datagrams):
    reader = StreamReader()

    came = [each for datagram in datagrams for each in reader.read(datagram)]

    lines = [line for each in datagrams for line in each.splitlines() if line.strip()]
    assert reader.counts.frames == len(came)
    assert reader.counts.frames + reader.counts.dropped == len(lines)


def test_a_recording_of_uneven_frames_is_even(rng):
    performed = perform_gestures(["wave right"])
    times = np.linspace(5.0, 7.0, 61)
    late = times + rng.normal(scale=0.003, size=61)
    positions = np.sin(late)[:, None, None] * np.ones((1, 20, 3))
    names = performed.recording().names
    frames = [
        LiveFrame(float(time), 0, names, position, np.full(20, 0.8), None, Sensor.KINECT_V1)
        for time, position in zip(late, positions, strict=True)
    ]

    recording = recording_from_frames(frames)

    assert recording.frame_rate == 30.0 and recording.sensor is Sensor.KINECT_V1
    assert recording.n_frames in {60, 61}
    moments = late[0] + np.arange(recording.n_frames) / 30.0
    expected = np.sin(moments)[:, None, None] * np.ones((1, 20, 3))
    assert_allclose(recording.tracks.positions[:60], expected[:60], atol=1e-3)
    assert_allclose(recording.tracks.confidence, 0.8)


def test_missing_frames_are_gaps():
    frames = [frame(number / 30, position=float(number)) for number in range(60)]

    recording = recording_from_frames(frames[:20] + frames[30:])

    assert recording.n_frames == 60
    missing = np.isnan(recording.tracks.positions[:, 0, 0])
    assert missing[20:30].all() and missing.sum() == 10


def test_joints_of_other_names_are_left_out():
    frames = [frame(number / 30, position=1.0) for number in range(10)]
    frames[4] = replace(frames[4], names=("Foot",))

    recording = recording_from_frames(frames)

    assert recording.names == ("Head",)
    assert np.isnan(recording.tracks.positions[4]).all()


def test_nothing_cannot_be_a_recording():
    with pytest.raises(InvalidFileError, match="no frames"):
        recording_from_frames([])
    with pytest.raises(InvalidFileError, match="no joint that is observed"):
        recording_from_frames([replace(frame(0.0), positions=np.full((1, 3), np.nan))])


def test_the_receiver_listens_on_loopback_only_and_never_waits(send_to):
    with Receiver(0) as receiver:
        host, port = receiver.address
        assert host == "127.0.0.1"
        assert receiver.poll() == []
        send_to(port, *[b"%d" % number for number in range(MAX_DATAGRAMS + 10)])

        first, second = receiver.poll(), receiver.poll()

    assert first + second == [b"%d" % number for number in range(MAX_DATAGRAMS + 10)]
    assert len(first) == MAX_DATAGRAMS


@pytest.mark.parametrize(
    "junk",
    [
        [b"x\n" * 32_700] * 16,
        [b"\n" * 65_000] * 16,
        [b"[1,1]\n"] * 5000,
        [b"[" + b"1," * 16_000 + b"1]\n"] * 40,
        [b"x" * 65_000] * 16,
    ],
    ids=["short lines", "blank lines", "small datagrams", "long lines", "one line"],
)
def test_burst_of_junk_is_parsed_up_to_a_bound_and_counted(junk, monkeypatch):
    decoded = []

    def decode(line):
        decoded.append(len(line))
        return decode_frame(line)

    monkeypatch.setattr("solvers.recordings.streams.frames.stream_reader.decode_frame", decode)
    reader = StreamReader()

    came = [each.time for each in reader.read(encode_frame(frame(0.0)), *junk)]

    assert (came, reader.counts.frames) == ([0.0], 1)
    assert len(decoded) <= MAX_LINES
    n_lines = sum(len(datagram.splitlines()) for datagram in junk)
    blank = sum(not line.strip() for each in junk for line in each.splitlines())
    looked_at = min(n_lines, MAX_LINES - 1)
    assert reader.counts.skipped == n_lines - looked_at
    assert reader.counts.unreadable == (0 if blank else looked_at)
    assert [each.time for each in reader.read(encode_frame(frame(0.1)))] == [0.1]


def test_the_receiver_takes_no_more_bytes_at_once_than_it_may(send_to, monkeypatch):
    monkeypatch.setattr("solvers.recordings.streams.receiver.MAX_POLL_BYTES", 1000)
    with Receiver(0) as receiver:
        send_to(receiver.address[1], *[b"x" * 100] * 25)

        counts = [len(receiver.poll()) for _ in range(4)]

    assert counts == [10, 10, 5, 0]


def test_port_in_use_is_reported():
    with Receiver(0) as receiver, pytest.raises(InvalidSettingError, match="another program"):
        Receiver(receiver.address[1])
    for wrong in (-1, 70_000):
        with pytest.raises(InvalidSettingError, match=f"Port {wrong}"):
            Receiver(wrong)


def test_closed_receiver_returns_nothing():
    receiver = Receiver(0)
    port = receiver.address[1]

    receiver.close()
    receiver.close()

    assert receiver.poll() == []
    Receiver(port).close()


def test_each_frame_is_compared_a_few_times_when_all_have_other_joints():
    compared = []

    class Names(tuple):
        __hash__ = tuple.__hash__

        def __eq__(self, other):
            compared.append(other)
            return super().__eq__(other)

    frames = [
        replace(frame(number / 30.0), names=Names([f"Head {number}"])) for number in range(100)
    ]

    assert recording_from_frames([*frames, replace(frames[7], time=4.0)]).names == ("Head 7",)
    assert len(compared) < 5 * len(frames)
