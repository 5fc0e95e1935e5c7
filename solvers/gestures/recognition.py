"""Recognize gesture commands in a stream of poses, frame by frame [ZH14, section 3.5]."""

from dataclasses import replace
from enum import Enum
from math import inf

import numpy as np

from ..arrays import Array
from .events import Gesture, GestureEvent
from .hand_tracking import HandEstimator, Hands
from .settings import GestureSettings
from .still_gestures import HandUp, Turn, Zoom
from .stroke_gestures import Clap, Wave

MAX_BREAK_S = 0.5
"""Seconds without a frame, or without hands, after which all gestures are reset. It guards
gestures that would begin before a break of the stream and end after it
(`test_hand_that_is_up_before_and_after_a_break_is_not_held`)."""
DEFAULT_SETTINGS = GestureSettings()


class Mode(Enum):
    """Activity of the actor."""

    IDLE = "idle"
    BROWSING = "browsing"
    CAPTURING = "capturing"


class GestureRecognizer:
    """Recognize the gestures of one actor.

    The raised right hand shows the library. While it is shown, waves of that hand to the right
    and left turn its pages, the hand raised again asks for all clips, and the raised left hand
    chooses one. A clap starts a performance and the next one ends it; all other
    gestures are ignored in between. Both hands, held still in front of the chest, grab the view
    and zoom by their distance; the straight right arm grabs and turns it. All thresholds are in
    arm lengths, in the actor's own right, forward and up directions, from past frames only.

    The source names the gestures and leaves their recognition open; the rules here are ours.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong,
       section 3.5.
    """

    def __init__(self, settings: GestureSettings = DEFAULT_SETTINGS) -> None:
        self._settings = settings
        self._reader = HandEstimator(settings)
        self._clap, self._wave = Clap(settings), Wave(settings)
        self._hand_up = HandUp(settings)
        self._left_up = HandUp(settings, Gesture.LEFT_HAND_UP)
        self._zoom, self._turn = Zoom(settings), Turn(settings)
        self._mode = Mode.IDLE
        self._mode_since = self._time = self._hands_time = float("-inf")
        self._last_clap_time = float("-inf")

    @property
    def mode(self) -> Mode:
        """Current activity of the actor."""
        return self._mode

    def update(
        self, time: float, positions: Array, confidence: Array
    ) -> tuple[GestureEvent, ...]:
        """Process one frame; return the events that it completes.

        Skips a frame whose time is not finite, or not later than that of the frame before.

        Parameters
        ----------
        time : float, seconds
        positions : shape (20, 3), meters, Z up
            In the order of `POSTURE_JOINTS`; NaN is missing.
        confidence : shape (20,), 0 to 1

        Returns
        -------
        tuple of GestureEvent
            Empty in most frames; a dropped capture comes first.
        """
        if not self._time < time < inf:
            return ()
        self._time = time
        events = self._end_timeouts(time)
        hands = self._reader.read(time, positions, confidence)
        if time - self._hands_time > MAX_BREAK_S:
            self._reset()
        if hands is None:
            self._clap.mark_missing(time)
            return events
        self._hands_time = time
        return (*events, *self._react(hands))

    def _end_timeouts(self, time: float) -> tuple[GestureEvent, ...]:
        """End the browsing or capture that has lasted too long."""
        since = time - self._mode_since
        if self._mode is Mode.BROWSING and since > self._settings.browse_for:
            self._enter(Mode.IDLE, time)
        if self._mode is Mode.CAPTURING and since > self._settings.longest_capture:
            began = self._mode_since
            self._enter(Mode.IDLE, time)
            return (GestureEvent(Gesture.CAPTURE_DROPPED, time, began),)
        return ()

    def _react(self, hands: Hands) -> tuple[GestureEvent, ...]:
        zoom, turn = self._zoom.update(hands), self._turn.update(hands)
        clap = self._clap.update(hands, self._zoom.is_active)
        if clap is not None:
            return self._handle_clap(clap)
        if self._mode is Mode.CAPTURING:
            return ()
        browsing = self._mode is Mode.BROWSING or not self._settings.waves_need_hand_up
        up, wave = self._hand_up.update(hands), self._wave.update(hands)
        chosen = self._left_up.update(hands)
        if not browsing or self._turn.is_active:
            wave = None
        if self._mode is not Mode.BROWSING:
            chosen = None
        elif up is not None:
            up = replace(up, gesture=Gesture.HAND_UP_AGAIN)
        found = tuple(event for event in (up, wave, chosen) if event is not None)
        if found:
            self._enter(Mode.BROWSING, hands.time)
        return (*found, *(event for event in (zoom, turn) if event is not None))

    def _handle_clap(self, clap: GestureEvent) -> tuple[GestureEvent, ...]:
        since, self._last_clap_time = clap.time - self._last_clap_time, clap.time
        if since < self._settings.clap_pause:
            return ()
        ends = self._mode is Mode.CAPTURING
        self._enter(Mode.IDLE if ends else Mode.CAPTURING, clap.time)
        self._reset()
        return (replace(clap, gesture=Gesture.CAPTURE_END) if ends else clap,)

    def _enter(self, mode: Mode, time: float) -> None:
        self._mode, self._mode_since = mode, time

    def _reset(self) -> None:
        for detector in (
            self._clap, self._wave, self._hand_up, self._left_up, self._zoom, self._turn,
        ):  # fmt: skip
            detector.reset()


def recognize_gestures(
    times: Array,
    positions: Array,
    confidence: Array | None = None,
    settings: GestureSettings = DEFAULT_SETTINGS,
) -> tuple[GestureEvent, ...]:
    """Return the gestures of a complete recording, exactly as a live stream reports them.

    Parameters
    ----------
    times : shape (n_frames,), seconds
    positions : shape (n_frames, 20, 3), meters, Z up
        As `solvers.motion.humanoid.posture_joints.posture_positions` returns them.
    confidence : shape (n_frames, 20), 0 to 1, optional
    settings : GestureSettings
    """
    recognizer = GestureRecognizer(settings)
    confidences = np.ones(positions.shape[:2]) if confidence is None else confidence
    events = [
        event
        for time, frame_positions, frame_confidence in zip(
            times, positions, confidences, strict=True
        )
        for event in recognizer.update(float(time), frame_positions, frame_confidence)
    ]
    return tuple(events)
