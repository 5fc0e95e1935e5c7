"""`replay`: a recording goes over loopback, each frame at its time."""

import json
import socket

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.command_line.replay_verb import pace_packets
from solvers.motion import Tracks
from solvers.motion.humanoid.posture_joints import postures_from_motion
from solvers.recordings import write_bvh, write_joints, write_trc
from solvers.recordings.streams import StreamProtocol, encode_recording
from solvers.recordings.streams.frames.joint_frames import decode_frame
from solvers.samples import (
    GaitSettings,
    PerformanceSettings,
    perform_gestures,
    walking_gait,
)


@pytest.fixture
def wave(tmp_path):
    """A wave of one or two seconds, as a file."""
    performance = perform_gestures(["wave right"], PerformanceSettings(frame_rate=15.0))
    write_joints(performance.recording(), tmp_path / "wave.json")
    return performance, tmp_path / "wave.json"


@pytest.fixture
def listener():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        bound.bind(("127.0.0.1", 0))
        bound.setblocking(False)
        yield bound


def came(listener):
    frames = []
    while True:
        try:
            frames.append(decode_frame(listener.recv(65536)))
        except BlockingIOError:
            return frames


def test_every_frame_arrives_in_order(call, wave, listener):
    performance, path = wave
    port = listener.getsockname()[1]

    status, out, err = call("replay", path, "--port", port, "--speed", 100, "--json")

    frames = came(listener)
    assert (status, err) == (0, "")
    assert json.loads(out)["n_frames"] == len(frames) == len(performance.times)
    assert_allclose([frame.time for frame in frames], performance.times, atol=1e-5)
    positions = np.stack([frame.positions for frame in frames])
    assert_allclose(positions, performance.positions, atol=1e-4)


def test_frames_are_sent_on_time_when_sending_is_slow(wave):
    recording = wave[0].recording()
    clock = [100.0]
    sent = []

    for (line,) in pace_packets(
        encode_recording(recording, StreamProtocol.JSON), 2.0, lambda: clock[0],
        lambda seconds: clock.__setitem__(0, clock[0] + seconds),
    ):  # fmt: skip
        sent.append((decode_frame(line).time, clock[0] - 100.0))
        clock[0] += 0.01

    messages, passed = np.array(sent).T
    assert_allclose(passed, messages / 2.0, atol=1e-5)


def test_time_increases_when_the_recording_repeats(wave):
    recording = wave[0].recording()
    packets = encode_recording(recording, StreamProtocol.JSON, is_repeated=True)

    times = [next(packets).time for _ in range(3 * recording.n_frames)]

    assert_allclose(np.diff(times), 1 / recording.frame_rate)


def test_a_motion_is_sent_as_the_joints_of_a_kinect(call, tmp_path, listener):
    walk = walking_gait(GaitSettings(duration=0.5, frame_rate=30.0))
    write_bvh(walk, tmp_path / "walk.bvh")

    call("replay", tmp_path / "walk.bvh", "--port", listener.getsockname()[1], "--speed", 100)

    frames = came(listener)
    assert len(frames) == walk.n_frames and "WristRight" in frames[0].names
    positions = np.stack([frame.positions for frame in frames])
    assert_allclose(positions, postures_from_motion(walk), atol=1e-3)


def test_replay_works_without_a_receiver(call, wave):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    status, out, _ = call("replay", wave[1], "--port", port, "--speed", 100)

    assert status == 0 and out.startswith("Sent ")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--port", "0"), "port is 0; it must be between 1 and 65535."),
        (("--port", "70000"), "port is 70000"),
        (("--speed", "0"), "speed is 0"),
        (("--speed", "nan"), "speed is nan"),
    ],
)
def test_invalid_options_are_reported(call, wave, options, words):
    status, _, err = call("replay", wave[1], *options)

    assert status == 2 and words in err


def test_more_points_than_a_stream_holds_are_refused(call, tmp_path):
    markers = Tracks(
        tuple(f"m{number}" for number in range(70)), np.arange(1050.0).reshape(5, 70, 3), 30.0
    )
    write_trc(markers, tmp_path / "many.trc")

    status, _, err = call("replay", tmp_path / "many.trc", "--speed", 100)

    assert status == 2 and "70 points; a live stream has at most 64" in err
