"""Frames in, commands and performances out, as if an actor stood there."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.gestures.events import Gesture
from solvers.gestures.recognition import Mode
from solvers.gestures.settings import GestureSettings
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, find_humanoid_map
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.recordings.streams import PoseFrame, StreamReader
from solvers.recordings.streams.frames import pose_frames
from solvers.recordings.streams.frames.joint_frames import (
    LiveFrame,
    encode_frame,
    frames_from_recording,
)
from solvers.samples import GaitSettings, PerformanceSettings, perform_gestures, walking_gait
from solvers.workflows.live import live_session
from solvers.workflows.live.live_session import NO_END, TOO_SHORT, LiveSession, pose_from_frame


def lines_of(made, body=0, since=0.0, **settings):
    recording = perform_gestures(made, PerformanceSettings(**settings)).recording()
    return [
        encode_frame(replace(frame, time=frame.time + since))
        for frame in frames_from_recording(recording, body)
    ]


def receive(session, lines):
    """All events, queries and messages, as Blender would get them: a few lines at a time."""
    reader = StreamReader()
    news = [
        session.add(reader.read(*lines[start : start + 3])) for start in range(0, len(lines), 3)
    ]
    events = [event.gesture for each in news for event in each.events]
    queries = [each.query for each in news if each.query is not None]
    return events, queries, [each.message for each in news if each.message]


def test_motion_between_claps_is_the_query():
    made = ["clap", "hand up", "wave left", "clap", "rest"]
    performance = perform_gestures(made)
    session = LiveSession()

    events, queries, messages = receive(session, lines_of(made))

    assert events == [Gesture.CAPTURE_START, Gesture.CAPTURE_END] and not messages
    (query,) = queries
    assert isinstance(query, JointRecording) and query.sensor is Sensor.KINECT_V1
    assert query.names == SENSOR_JOINTS[Sensor.KINECT_V1] and query.frame_rate == 30.0
    began, ended = (done for name, done in performance.made if name == "clap")
    assert query.n_frames / 30.0 == pytest.approx(ended - began - 0.65, abs=0.3)
    start = int(
        np.argmin(np.abs(performance.positions - query.tracks.positions[0]).sum((1, 2)))
    )
    expected = performance.positions[start : start + query.n_frames]
    assert_allclose(query.tracks.positions, expected, atol=1e-3)


def test_session_recognizes_all_commands():
    made = ["hand up", "wave right", "rest", "clap", "rest", "clap", "rest", "zoom in"]

    events, queries, _ = receive(LiveSession(), lines_of(made, noise=0.005))

    assert events[:4] == [
        Gesture.HAND_UP, Gesture.PAGE_NEXT, Gesture.CAPTURE_START, Gesture.CAPTURE_END,
    ]  # fmt: skip
    assert set(events[4:]) == {Gesture.ZOOM} and len(queries) == 1


def test_performance_without_duration_is_dropped():
    session = LiveSession()

    events, queries, messages = receive(session, lines_of(["clap", "clap", "rest"]))
    assert events == [Gesture.CAPTURE_START, Gesture.CAPTURE_END]
    n_frames = [query.n_frames for query in queries]
    assert n_frames == [] or n_frames[0] >= 15
    assert messages == ([] if queries else [TOO_SHORT])


def test_restarted_sender_drops_the_performance():
    session = LiveSession()
    receive(session, lines_of(["rest", "rest", "clap", "rest"]))
    assert session.mode is Mode.CAPTURING

    events, queries, messages = receive(session, lines_of(["hand up"]))

    assert (events[0], queries, messages) == (Gesture.CAPTURE_DROPPED, [], [NO_END])
    assert events[1:] == [Gesture.HAND_UP]


def test_second_actor_does_not_end_the_performance():
    session = LiveSession()
    receive(session, lines_of(["clap"], body=1))

    events, _, _ = receive(session, lines_of(["clap"], body=2, since=10.0))

    assert events == [Gesture.CAPTURE_DROPPED, Gesture.CAPTURE_START]


def test_recorded_frames_are_limited():
    session = LiveSession(GestureSettings(longest_capture=600.0))
    receive(session, lines_of(["clap"]))
    (last,) = lines_of(["rest"])[:1]
    del last
    still = lines_of(["rest"] * 20, since=20.0, frame_rate=240.0)

    receive(session, still)

    assert session.mode is Mode.CAPTURING
    assert len(session._performed) <= 20_000


def test_without_frames_nothing_happens():
    news = LiveSession().add([])

    assert (news.frame, news.events, news.query, news.message) == (None, (), None, "")


def test_roles_are_found_once_when_frames_with_other_joints_come_together(monkeypatch):
    searched = []
    monkeypatch.setattr(
        live_session, "posture_joint_indices", lambda names: searched.append(names) or {}
    )
    frames = [
        LiveFrame(number / 30, 0, ("head", f"joint {number}"), np.ones((2, 3)), np.ones(2))
        for number in range(20)
    ]

    news = LiveSession().add(frames)

    assert searched == [frames[-1].names] and news.frame is frames[-1]


def test_roles_of_bones_are_found_once_when_other_skeletons_come_together(monkeypatch):
    searched = []

    def find(skeleton):
        searched.append(skeleton)
        return find_humanoid_map(skeleton)

    monkeypatch.setattr(pose_frames, "find_humanoid_map", find)
    walk = walking_gait(GaitSettings(duration=1.0))
    skeletons = [replace(walk.skeleton) for _ in range(20)]
    frames = [
        PoseFrame(number / 30, 0, skeleton, walk.rotations[0], walk.root_positions[0])
        for number, skeleton in enumerate(skeletons)
    ]

    LiveSession().add(frames)

    assert searched == [skeletons[-1]]


@pytest.mark.parametrize("names", [("a", "b"), ("Head",), ("hips", "head")])
def test_frames_without_arms_have_no_gestures(names):
    session = LiveSession()
    indices = np.ones((len(names), 3))

    for number in range(60):
        frame = LiveFrame(number / 30, 0, names, indices, np.ones(len(names)))
        assert session.add([frame]).events == ()


def test_joints_of_every_sensor_are_recognized():
    for sensor in (Sensor.KINECT_V1, Sensor.KINECT_V2, Sensor.AZURE_KINECT):
        names = SENSOR_JOINTS[sensor]
        indices = np.arange(3.0 * len(names)).reshape(-1, 3)

        positions, confidence = pose_from_frame(
            LiveFrame(0.0, 0, names, indices, np.ones(len(names)))
        )

        assert np.isfinite(positions).all() and (confidence == 1.0).all()
        wrist = positions[POSTURE_JOINTS.index("rightHand")]
        assert wrist.tolist() == indices[names.index("WristRight")].tolist()
