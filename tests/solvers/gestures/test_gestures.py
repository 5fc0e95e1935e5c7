"""Recognize simulated gestures, and ignore movements that are no gestures."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.gestures.events import Gesture
from solvers.gestures.recognition import GestureRecognizer, Mode, recognize_gestures
from solvers.gestures.settings import GestureSettings
from solvers.motion.humanoid.posture_joints import MIRROR_JOINTS
from solvers.samples import PerformanceSettings, perform_gestures
from solvers.samples.performance import GESTURES

EXPECTED = {
    "hand up": Gesture.HAND_UP,
    "wave right": Gesture.PAGE_NEXT,
    "wave left": Gesture.PAGE_BACK,
    "clap": Gesture.CAPTURE_START,
}
BROWSING = ["hand up", "rest", "wave right", "wave right", "wave left", "rest"]
MAX_DELAY_S = {"hand up": 1.2, "wave right": 0.1, "wave left": 0.1, "clap": 0.1}
"""Maximum seconds from the end of a gesture to its event; a raised hand must be held."""


def recognized(performance, chosen=None) -> list[Gesture]:
    events = recognize_gestures(
        performance.times,
        performance.positions,
        performance.confidence,
        chosen or GestureSettings(),
    )
    return [event.gesture for event in events]


@pytest.mark.parametrize("frame_rate", [15.0, 30.0, 60.0])
def test_each_gesture_is_reported_once_and_in_time(frame_rate):
    performance = perform_gestures(
        [*BROWSING, "clap"], PerformanceSettings(frame_rate=frame_rate)
    )

    events = recognize_gestures(performance.times, performance.positions)

    assert [event.gesture for event in events] == [
        EXPECTED[name] for name, _ in performance.made
    ]
    for event, (name, done) in zip(events, performance.made, strict=True):
        assert event.began < event.time
        assert done - 0.25 <= event.time <= done + MAX_DELAY_S[name] + 2.0 / frame_rate


@pytest.mark.parametrize("seed", range(5))
def test_recognition_tolerates_noise_dropouts_and_late_frames(seed):
    corrupted = PerformanceSettings(
        noise=0.01, hidden=0.5, dropped=0.1, lateness=0.005, seed=seed
    )

    gestures = recognized(perform_gestures([*BROWSING, "clap", "rest", "clap"], corrupted))

    assert gestures[0] is Gesture.HAND_UP
    assert gestures.count(Gesture.PAGE_NEXT) == 2 and gestures.count(Gesture.PAGE_BACK) == 1
    assert gestures[-2:] == [Gesture.CAPTURE_START, Gesture.CAPTURE_END]


@pytest.mark.parametrize("seed", range(20))
def test_standing_with_noise_gives_no_gesture(seed):
    corrupted = PerformanceSettings(
        noise=0.02, hidden=1.0, dropped=0.2, lateness=0.01, seed=seed
    )

    assert recognized(perform_gestures(["rest"] * 30, corrupted)) == []


@settings(max_examples=15)
@given(
    heading=st.floats(-pi, pi),
    size=st.floats(0.5, 1.5),
    position=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
)
def test_recognition_ignores_heading_size_and_position(heading, size, position):
    result = ["hand up", "wave right", "turn", "clap"]
    plain = perform_gestures(result)
    moved = perform_gestures(result, PerformanceSettings(heading=heading, size=size))

    expected = recognize_gestures(plain.times, plain.positions)
    events = recognize_gestures(moved.times, moved.positions + position)

    assert [event.gesture for event in events] == [event.gesture for event in expected]
    assert [event.amount for event in events] == pytest.approx([e.amount for e in expected])


def test_zoom_is_the_factor_of_the_hands_distance():
    for name, factor in (("zoom in", 1.27 / 0.57), ("zoom out", 0.57 / 1.27)):
        performance = perform_gestures([name])

        events = recognize_gestures(performance.times, performance.positions)

        assert {event.gesture for event in events} == {Gesture.ZOOM}
        assert np.prod([event.amount for event in events]) == pytest.approx(factor, rel=0.2)


def test_hands_that_zoom_out_do_not_clap():
    """Though they end as near as in a clap, and fast enough."""
    for seed in range(10):
        corrupted = PerformanceSettings(noise=0.02, seed=seed)

        assert Gesture.CAPTURE_START not in recognized(
            perform_gestures(["zoom out", "rest"], corrupted)
        )


def test_arm_that_turns_the_view_does_not_wave(monkeypatch):
    raised, held, (_, _, left), *rest = GESTURES["turn"]
    across = (-0.3, 0.9, 0.0)
    swung = (raised, held, (0.8, across, left), (0.3, across, left), *rest[2:])
    monkeypatch.setitem(GESTURES, "turn", swung)
    always = GestureSettings(waves_need_hand_up=False)

    assert set(recognized(perform_gestures(["turn", "rest"]), always)) == {Gesture.TURN}


def test_turn_is_the_angle_of_the_straight_arm():
    """From (0.7, 0.66) to straight ahead: counter-clockwise from above."""
    performance = perform_gestures(["turn"])

    events = recognize_gestures(performance.times, performance.positions)

    assert {event.gesture for event in events} == {Gesture.TURN}
    swung = pi / 2 - np.arctan2(0.66, 0.7)
    assert sum(event.amount for event in events) == pytest.approx(swung, abs=0.06)


def test_gestures_between_two_claps_are_ignored():
    performance = perform_gestures(["clap", *BROWSING, "zoom in", "turn", "clap"])

    assert recognized(performance) == [Gesture.CAPTURE_START, Gesture.CAPTURE_END]


def test_performance_ends_before_the_last_clap_starts():
    performance = perform_gestures(["clap", "rest", "clap"])

    start, end = recognize_gestures(performance.times, performance.positions)

    opened = performance.made[1][1] - 0.3 - 0.1 - 0.25
    assert start.time < end.began <= opened + 0.15 < end.time


def test_waves_count_only_while_the_library_is_shown():
    separate = perform_gestures(["wave right", "rest"])
    late = perform_gestures(["hand up", *["rest"] * 16, "wave right", "rest"])

    assert recognized(separate) == []
    assert recognized(late) == [Gesture.HAND_UP]
    always = GestureSettings(waves_need_hand_up=False)
    assert recognized(separate, always) == [Gesture.PAGE_NEXT]


def test_left_hand_gives_no_gesture():
    performance = perform_gestures([*BROWSING, "turn"])
    mirrored = performance.positions[:, list(MIRROR_JOINTS)] * (-1.0, 1.0, 1.0)

    assert recognize_gestures(performance.times, mirrored) == ()


@pytest.mark.parametrize(("seconds", "expected"), [(0.3, [Gesture.CAPTURE_START]), (4.0, [])])
def test_slowly_closing_hands_do_not_clap(monkeypatch, seconds, expected):
    ready, clapped, *rest = GESTURES["clap"]
    near = (-0.03, 0.65, -0.35)
    slowed = (ready, (seconds, near, near), (0.15, *clapped[1:]), *rest)
    monkeypatch.setitem(GESTURES, "clap", slowed)

    assert [
        each for each in recognized(perform_gestures(["clap"])) if each is not Gesture.ZOOM
    ] == expected


def test_clap_above_the_head_is_ignored(monkeypatch):
    """A jumping jack has it, and it must fit between two claps."""
    over = tuple(
        step and (step[0], *((hand[0], hand[1] * 0.3, 0.9) for hand in step[1:]))
        for step in GESTURES["clap"]
    )
    monkeypatch.setitem(GESTURES, "clap", over)

    assert recognized(perform_gestures(["clap", "clap"])) == []


@pytest.mark.parametrize("hidden_within", [0.15, 0.25, 0.35])
def test_clap_with_an_occluded_touch_is_reported(hidden_within):
    performance = perform_gestures(["clap"])
    arms = [6, 7, 10, 11]
    gap = np.linalg.norm(performance.positions[:, 10] - performance.positions[:, 6], axis=-1)
    performance.confidence[np.ix_(gap < hidden_within, arms)] = 0.0

    assert recognized(performance) == [Gesture.CAPTURE_START]


def test_applause_counts_once(monkeypatch):
    ready, clapped, parted, _, done, *rest = GESTURES["clap"]
    again = (clapped[0], *clapped[1:]), (0.25, *ready[1:])
    monkeypatch.setitem(
        GESTURES, "clap", (ready, clapped, (0.25, *ready[1:]), *again, *again, done, *rest)
    )
    assert parted[1:] == clapped[1:]

    assert recognized(perform_gestures(["clap", "rest", "clap"])) == [
        Gesture.CAPTURE_START, Gesture.CAPTURE_END,
    ]  # fmt: skip


def test_dropping_hands_do_not_zoom(monkeypatch):
    """They meet while they fall, after they held the view."""
    near, held, *_ = GESTURES["zoom out"]
    fall = (0.6, (-0.1, 0.35, -0.9), (-0.1, 0.35, -0.9))
    monkeypatch.setitem(GESTURES, "zoom out", (near, held, fall))

    performance = perform_gestures(["zoom out"])
    events = recognize_gestures(performance.times, performance.positions)

    assert np.prod([event.amount for event in events]) == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize(("fraction", "expected"), [(0.5, [Gesture.CAPTURE_START]), (1.0, [])])
def test_single_moving_hand_does_not_clap(monkeypatch, fraction, expected):
    """From 0.98 arm lengths between the hands to 0.08, by the right one alone or by both."""
    seconds = [key[0] for key in GESTURES["clap"] if key]
    distances = (0.3, 0.6, -0.4), (0.0, 0.6, -0.4)
    direction = 0.9 * fraction, 0.9 * (1.0 - fraction)
    near = tuple((x - step, y, z) for (x, y, z), step in zip(distances, direction, strict=True))
    keys = (distances, near, near, distances, ((0.05, 0.05, -0.96),) * 2)
    result = tuple((time, *key) for time, key in zip(seconds, keys, strict=False))
    monkeypatch.setitem(GESTURES, "clap", result)

    assert recognized(perform_gestures(["clap"])) == expected


def test_both_hands_up_give_no_gesture(monkeypatch):
    both = tuple(step and (step[0], step[1], step[1]) for step in GESTURES["hand up"])
    monkeypatch.setitem(GESTURES, "hand up", both)

    assert recognized(perform_gestures(["hand up"])) == []


def test_capture_without_an_end_is_dropped():
    patient = GestureSettings(longest_capture=5.0)

    gestures = recognized(perform_gestures(["clap", *["rest"] * 8, "clap"]), patient)

    assert gestures == [
        Gesture.CAPTURE_START, Gesture.CAPTURE_DROPPED, Gesture.CAPTURE_START,
    ]  # fmt: skip


def test_missing_joints_give_no_gesture():
    performance = perform_gestures([*BROWSING, "clap"])

    assert recognized(replace(performance, confidence=0.0 * performance.confidence)) == []
    assert recognized(replace(performance, positions=np.nan * performance.positions)) == []


def test_late_and_duplicate_frames_are_skipped():
    performance = perform_gestures([*BROWSING, "clap"])
    n = len(performance.times)
    order = np.stack([np.arange(n), np.maximum(np.arange(n) - 3, 0)], axis=1).ravel()

    events = recognize_gestures(performance.times[order], performance.positions[order])

    assert events == recognize_gestures(performance.times, performance.positions)


def test_break_in_the_stream_resets_gestures_but_not_the_mode():
    performance = perform_gestures(["clap", "rest"])
    recognizer = GestureRecognizer()
    for time, positions in zip(performance.times, performance.positions, strict=True):
        recognizer.update(time, positions, np.ones(20))

    recognizer.update(performance.times[-1] + 10.0, performance.positions[0], np.ones(20))

    assert recognizer.mode is Mode.CAPTURING


@given(
    frames=st.lists(
        st.tuples(
            st.floats(allow_nan=True),
            st.sampled_from([0.0, 1e-9, 1.0, 99.0, np.nan]),
            st.floats(0.0, 1.0),
        ),
        max_size=20,
    )
)
def test_no_frame_raises(frames):
    recognizer = GestureRecognizer()
    for time, size, confidence in frames:
        positions = size * np.sin(np.arange(60.0)).reshape(20, 3)
        recognizer.update(time, positions, np.full(20, confidence))
