"""Movements that nearly are gestures, and were taken for them on recordings."""

import numpy as np

from solvers.gestures.events import Gesture
from solvers.gestures.recognition import GestureRecognizer, recognize_gestures
from solvers.samples import perform_gestures
from solvers.samples.performance import CLAP_READY, CLAPPED, FAR, GESTURES, REST


def recognized(*names: str) -> list[Gesture]:
    made = perform_gestures([*names])
    events = recognize_gestures(made.times, made.positions, made.confidence)
    return [event.gesture for event in events]


def test_arms_that_swing_up_from_the_sides_do_not_clap(monkeypatch):
    """They were apart while they hung only."""
    _, clapped, *rest = GESTURES["clap"]
    hanging, low = (0.35, 0.0, -0.93), (0.0, 0.1, -0.9)
    swing = ((0.4, hanging, hanging), (0.2, low, low), (0.15, *clapped[1:]), *rest)
    monkeypatch.setitem(GESTURES, "clap", swing)

    assert recognized("clap") == []


def test_hands_that_touch_do_not_zoom(monkeypatch):
    """They move from 7 to 17 hundredths of an arm length apart."""
    together, parted = (-0.3, 0.6, -0.3), (-0.25, 0.6, -0.3)
    held = ((0.7, together, together), (1.0, together, together), (1.0, parted, parted))
    monkeypatch.setitem(GESTURES, "zoom in", (*held, *GESTURES["zoom in"][3:]))

    assert Gesture.ZOOM not in recognized("zoom in")


def test_hands_that_meet_behind_the_back_do_not_clap(monkeypatch):
    open_arms, behind = (0.4, 0.1, -0.6), (-0.3, -0.15, -0.7)
    meet = ((0.5, open_arms, open_arms), (0.25, behind, behind), (0.1, behind, behind))
    monkeypatch.setitem(
        GESTURES, "clap", (*meet, (0.3, open_arms, open_arms), *GESTURES["clap"][4:])
    )

    assert recognized("clap") == []


def test_arms_that_are_spread_wide_do_not_zoom(monkeypatch):
    wide, less = (0.85, 0.45, -0.2), (0.7, 0.6, -0.2)
    held = ((0.7, wide, wide), (1.0, wide, wide), (0.4, less, less), None, (0.6, REST, REST))
    monkeypatch.setitem(GESTURES, "zoom in", held)

    assert recognized("zoom in") == []


def test_clap_of_still_hands_does_not_zoom(monkeypatch):
    clap = ((0.12, CLAPPED, CLAPPED), (0.1, CLAPPED, CLAPPED), (0.3, CLAP_READY, CLAP_READY))
    held = ((0.7, FAR, FAR), (1.0, FAR, FAR), *clap, *GESTURES["clap"][4:])
    monkeypatch.setitem(GESTURES, "clap", held)

    assert recognized("clap") == [Gesture.CAPTURE_START]


def test_hand_that_is_up_before_and_after_a_break_is_not_held():
    made = perform_gestures(["hand up"])
    event = recognize_gestures(made.times, made.positions, made.confidence)[0]
    raised = made.positions[np.searchsorted(made.times, event.time)]
    recognizer = GestureRecognizer()
    for time in np.linspace(0.0, 0.5, 16):
        recognizer.update(time, raised, np.ones(20))

    assert recognizer.update(3.0, raised, np.ones(20)) == ()


def test_library_is_asked_for_and_a_clip_chosen_while_it_is_shown():
    gestures = ["hand up", "rest", "hand up", "rest", "left hand up", "rest"]

    assert recognized(*gestures) == [
        Gesture.HAND_UP, Gesture.HAND_UP_AGAIN, Gesture.LEFT_HAND_UP,
    ]  # fmt: skip
    assert recognized("left hand up", "rest") == []
