"""A session before the camera: frames in, commands and performances out."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..gestures import Gesture, GestureEvent, GestureRecogniser, GestureSettings, Mode
from ..motion import JointRecording
from ..motion.humanoid import POSTURE_JOINTS, joints_of_names
from ..recordings.live import Heard, LiveFrame, StreamReader, recording_of

Array = NDArray[np.float64]

USUAL = GestureSettings()
SHORTEST = 0.5
"""Seconds that a performance must last to be searched for."""
MOST_FRAMES = 20_000
"""Frames that are kept of a performance."""
TOO_SHORT = "The performance was too short to search for. Clap, perform, and clap again."
DROPPED = "No second clap ended the performance, so it was dropped."


@dataclass(frozen=True, eq=False)
class News:
    """What a session has heard since it was last asked."""

    frame: LiveFrame | None
    """The newest one."""
    events: tuple[GestureEvent, ...]
    query: JointRecording | None
    """The performance that has just been ended."""
    message: str
    """Why there is no query though one was to be expected, or nothing."""


class LiveSession:
    """Follows one actor through a stream; what comes in is dropped or counts, and never raises.

    Parameters
    ----------
    settings : GestureSettings
    """

    def __init__(self, settings: GestureSettings = USUAL) -> None:
        self._settings = settings
        self._stream = StreamReader()
        self._recogniser = GestureRecogniser(settings)
        self._performed: list[LiveFrame] = []
        self._last: LiveFrame | None = None

    @property
    def mode(self) -> Mode:
        """What the actor is doing."""
        return self._recogniser.mode

    @property
    def heard(self) -> Heard:
        """How many frames came in, and why others were dropped."""
        return self._stream.heard

    def receive(self, datagrams: Iterable[bytes]) -> News:
        """Take what came in; return what it says."""
        news = News(None, (), None, "")
        for frame in self._stream.read(*datagrams):
            news = self._told(news, frame)
        return news

    def _told(self, news: News, frame: LiveFrame) -> News:
        """Add what a frame says."""
        events = self._break_off(frame)
        places, trust = pose_from_frame(frame)
        events += self._recogniser.see(frame.time, places, trust)
        news = replace(news, frame=frame, events=news.events + events)
        for event in events:
            news = self._captured(news, event)
        if self.mode is Mode.CAPTURING and len(self._performed) < MOST_FRAMES:
            self._performed.append(frame)
        return news

    def _break_off(self, frame: LiveFrame) -> tuple[GestureEvent, ...]:
        """Begin anew with another actor, or another stream."""
        last, self._last = self._last, frame
        if last is None or (frame.body == last.body and frame.time > last.time):
            return ()
        was, self._recogniser = self.mode, GestureRecogniser(self._settings)
        if was is not Mode.CAPTURING:
            return ()
        return (GestureEvent(Gesture.CAPTURE_DROPPED, frame.time, frame.time),)

    def _captured(self, news: News, event: GestureEvent) -> News:
        """Begin or end the performance, as the event says."""
        if event.gesture is Gesture.CAPTURE_START:
            self._performed = []
        elif event.gesture is Gesture.CAPTURE_DROPPED:
            self._performed = []
            return replace(news, message=DROPPED)
        elif event.gesture is Gesture.CAPTURE_END:
            frames = [frame for frame in self._performed if frame.time <= event.began]
            self._performed = []
            return _performance(news, frames)
        return news


def _performance(news: News, frames: list[LiveFrame]) -> News:
    if not frames or frames[-1].time - frames[0].time < SHORTEST:
        return replace(news, message=TOO_SHORT)
    try:
        return replace(news, query=recording_of(frames), message="")
    except InvalidFileError as error:
        return replace(news, message=str(error))


def pose_from_frame(frame: LiveFrame) -> tuple[Array, Array]:
    """Return the joints of postures, (20, 3) in metres, and how sure they are, (20,)."""
    positions, confidence = (
        np.full((len(POSTURE_JOINTS), 3), np.nan),
        np.zeros(len(POSTURE_JOINTS)),
    )
    for role, joint in _places(frame.names):
        positions[role] = frame.positions[joint]
        confidence[role] = frame.confidence[joint]
    return positions, confidence


@lru_cache(maxsize=64)
def _places(names: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    """Return which joint of postures each named joint is."""
    found = joints_of_names(names)
    return tuple((POSTURE_JOINTS.index(role), joint) for role, joint in found.items())
