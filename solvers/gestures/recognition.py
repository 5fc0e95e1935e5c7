"""Commands by gesture, from a stream of postures, frame by frame [ZH14, section 3.5]."""

from dataclasses import replace
from enum import Enum
from math import inf

import numpy as np
from numpy.typing import NDArray

from .events import Gesture, GestureEvent
from .hand_signals import HandReader, Hands
from .holds import HandUp, Turn, Zoom
from .settings import GestureSettings
from .strokes import Clap, Wave

Array = NDArray[np.float64]

LONGEST_BREAK = 0.5
"""Seconds without a frame, or without hands, after which no gesture goes on."""
USUAL = GestureSettings()


class Mode(Enum):
    """What the actor is doing."""

    IDLE = "idle"
    BROWSING = "browsing"
    CAPTURING = "capturing"


class GestureRecognizer:
    """Listens to one actor: right hand up, waves, claps, hands apart, right arm turning.

    The right hand, held up, shows the library; while it is shown, waves of that hand to the
    right and left page it. A clap starts a performance and the next one ends it; nothing else
    counts between them. Both hands, held still before the chest, take hold of the view and
    zoom by their distance; so does the stretched right arm, and turns it. All is judged in
    arm lengths, in the actor's own right, forward and up, by what was seen so far.

    The source names the gestures and leaves open how they are told; the rules here are ours.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong,
       section 3.5.
    """

    def __init__(self, settings: GestureSettings = USUAL) -> None:
        self._settings = settings
        self._reader = HandReader(settings)
        self._clap, self._wave = Clap(settings), Wave(settings)
        self._hand_up = HandUp(settings)
        self._zoom, self._turn = Zoom(settings), Turn(settings)
        self._mode = Mode.IDLE
        self._mode_since = self._time = self._hands_at = float("-inf")
        self._clapped_at = float("-inf")

    @property
    def mode(self) -> Mode:
        """What the actor is doing."""
        return self._mode

    def see(self, time: float, positions: Array, confidence: Array) -> tuple[GestureEvent, ...]:
        """Take one frame; return what it completed.

        Skips a frame whose time is not finite, or not later than that of the frame before.

        Parameters
        ----------
        time : float, seconds
        positions : shape (20, 3), metres, Z up
            In the order of `POSTURE_JOINTS`; NaN: not tracked.
        confidence : shape (20,), 0 to 1

        Returns
        -------
        tuple of GestureEvent
            None in most frames; a dropped capture first.
        """
        if not self._time < time < inf:
            return ()
        self._time = time
        events = self._outlast(time)
        hands = self._reader.read(time, positions, confidence)
        if time - self._hands_at > LONGEST_BREAK:
            self._forget()
        if hands is None:
            self._clap.lose(time)
            return events
        self._hands_at = time
        return (*events, *self._react(hands))

    def _outlast(self, time: float) -> tuple[GestureEvent, ...]:
        """End what has gone on for too long."""
        since = time - self._mode_since
        if self._mode is Mode.BROWSING and since > self._settings.browse_for:
            self._enter(Mode.IDLE, time)
        if self._mode is Mode.CAPTURING and since > self._settings.longest_capture:
            began = self._mode_since
            self._enter(Mode.IDLE, time)
            return (GestureEvent(Gesture.CAPTURE_DROPPED, time, began),)
        return ()

    def _react(self, hands: Hands) -> tuple[GestureEvent, ...]:
        zoom, turn = self._zoom.see(hands), self._turn.see(hands)
        clap = self._clap.see(hands, self._zoom.holds)
        if clap is not None:
            return self._clapped(clap)
        if self._mode is Mode.CAPTURING:
            return ()
        browsing = self._mode is Mode.BROWSING or not self._settings.waves_need_hand_up
        up, wave = self._hand_up.see(hands), self._wave.see(hands)
        if not browsing or self._turn.holds:
            wave = None
        if up is not None or wave is not None:
            self._enter(Mode.BROWSING, hands.time)
        return tuple(event for event in (up, wave, zoom, turn) if event is not None)

    def _clapped(self, clap: GestureEvent) -> tuple[GestureEvent, ...]:
        since, self._clapped_at = clap.time - self._clapped_at, clap.time
        if since < self._settings.clap_pause:
            return ()
        ends = self._mode is Mode.CAPTURING
        self._enter(Mode.IDLE if ends else Mode.CAPTURING, clap.time)
        self._forget()
        return (replace(clap, gesture=Gesture.CAPTURE_END) if ends else clap,)

    def _enter(self, mode: Mode, time: float) -> None:
        self._mode, self._mode_since = mode, time

    def _forget(self) -> None:
        for detector in (self._clap, self._wave, self._hand_up, self._zoom, self._turn):
            detector.forget()


def recognize_gestures(
    times: Array,
    positions: Array,
    confidence: Array | None = None,
    settings: GestureSettings = USUAL,
) -> tuple[GestureEvent, ...]:
    """Return the gestures of a whole recording, as they would have been told while it ran.

    Parameters
    ----------
    times : shape (n_frames,), seconds
    positions : shape (n_frames, 20, 3), metres, Z up
        As `solvers.motion.humanoid.posture_joints.posture_positions` returns them.
    confidence : shape (n_frames, 20), 0 to 1, optional
    settings : GestureSettings
    """
    recogniser = GestureRecognizer(settings)
    sure = np.ones(positions.shape[:2]) if confidence is None else confidence
    events = [
        event
        for time, places, trust in zip(times, positions, sure, strict=True)
        for event in recogniser.see(float(time), places, trust)
    ]
    return tuple(events)
