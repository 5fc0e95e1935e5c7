"""Recognition on a Kinect: subjects 3 and 4, who were not used to set thresholds."""

from itertools import pairwise

import numpy as np
import pytest

from solvers.gestures.events import Gesture
from solvers.gestures.recognition import recognize_gestures
from solvers.gestures.settings import GestureSettings
from solvers.motion.humanoid.posture_joints import posture_positions
from solvers.recordings import read_joints
from solvers.recordings.streams import frames_from_recording
from solvers.workflows.live.live_session import pose_from_frame

CLAP, WAVE = "a10", "a02"
DEFAULT_SETTINGS = GestureSettings()


def gestures_in(path, settings=DEFAULT_SETTINGS):
    recording = read_joints(path)
    frames = [pose_from_frame(frame) for frame in frames_from_recording(recording)]
    positions, confidence = (np.stack(each) for each in zip(*frames, strict=True))
    times = np.arange(len(frames)) / recording.frame_rate
    return {
        event.gesture for event in recognize_gestures(times, positions, confidence, settings)
    }


def test_most_claps_and_all_waves_are_reported(recordings):
    folder = recordings / "kinect" / "msr_action3d"
    always = GestureSettings(waves_need_hand_up=False)

    claps = [gestures_in(path) for path in sorted(folder.glob(f"{CLAP}_s0[34]_*"))]
    waves = [gestures_in(path, always) for path in sorted(folder.glob(f"{WAVE}_s0[34]_*"))]

    assert len(claps) >= 6 and len(waves) >= 3
    assert (
        sum(Gesture.CAPTURE_START in recognized_gestures for recognized_gestures in claps) >= 4
    )
    assert all(
        {Gesture.PAGE_BACK, Gesture.PAGE_NEXT} & recognized_gestures
        for recognized_gestures in waves
    )


@pytest.mark.parametrize("subject", ["03", "04"])
def test_exercises_give_no_command(recordings, subject):
    """Four minutes of squats, lunges and arm raises, as one stream."""
    paths = sorted((recordings / "kinect" / "ui_prmd").glob(f"*_s{subject}_*"))
    clips = [posture_positions(read_joints(path)) for path in paths]
    positions = np.concatenate(clips)

    events = recognize_gestures(np.arange(len(positions)) / 30.0, positions)

    assert len(positions) > 3 * 60 * 30
    assert events == ()


def test_confidence_is_that_of_the_recording(recordings):
    path = next((recordings / "kinect" / "msr_action3d").glob("a10_s03_*"))
    recording = read_joints(path)

    frames = list(frames_from_recording(recording))

    positions = np.stack([pose_from_frame(frame)[0] for frame in frames])
    np.testing.assert_array_equal(positions, posture_positions(recording))
    assert all(one.time < other.time for one, other in pairwise(frames))
