"""Turn a live stream of joints into gestures and recorded performances."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...gestures import Gesture, GestureEvent, GestureRecognizer, GestureSettings, Mode
from ...motion import JointRecording, Skeleton
from ...motion.humanoid import POSTURE_JOINTS, posture_joint_indices
from ...recordings.streams import (
    LiveFrame,
    PoseFrame,
    StreamFrame,
    joints_from_pose,
    recording_from_frames,
)

GESTURE_SETTINGS = GestureSettings()
MIN_PERFORMANCE_S = 0.5
"""Minimum duration in seconds of a performance to search with. It guards a performance that
ends where it begins (`test_performance_without_duration_is_dropped`)."""
MAX_FRAMES = 20_000
"""Maximum number of recorded frames of a performance. It bounds the memory: eleven minutes at
30 Hz."""
TOO_SHORT = "The performance was too short to search for. Clap, perform, and clap again."
NO_END = "No second clap ended the performance, so it was dropped."


@dataclass(frozen=True, eq=False)
class SessionUpdate:
    """Events that a session received since the last call."""

    frame: LiveFrame | None
    """The newest frame."""
    events: tuple[GestureEvent, ...]
    query: JointRecording | None
    """The performance that has just ended."""
    message: str
    """Why an expected query is missing; empty otherwise."""


class LiveSession:
    """Follow one actor through the frames of a stream.

    Parameters
    ----------
    settings : GestureSettings
    """

    def __init__(self, settings: GestureSettings = GESTURE_SETTINGS) -> None:
        self._settings = settings
        self._recognizer = GestureRecognizer(settings)
        self._performed: list[LiveFrame] = []
        self._last: LiveFrame | None = None

    @property
    def mode(self) -> Mode:
        """The current activity of the actor."""
        return self._recognizer.mode

    def add(self, frames: Iterable[StreamFrame]) -> SessionUpdate:
        """Process frames of one body that arrived together; return what they show.

        Frames with other joints than the last one are dropped. A sender that renames its joints
        in every frame would stop the window, as finding their roles takes time.
        """
        update = SessionUpdate(None, (), None, "")
        for frame in _with_last_joints(list(frames)):
            joints = joints_from_pose(frame) if isinstance(frame, PoseFrame) else frame
            update = self._add_frame(update, joints)
        return update

    def _add_frame(self, update: SessionUpdate, frame: LiveFrame) -> SessionUpdate:
        """Add the events of a frame."""
        events = self._restart_if_needed(frame)
        positions, confidence = pose_from_frame(frame)
        events += self._recognizer.update(frame.time, positions, confidence)
        update = replace(update, frame=frame, events=update.events + events)
        for event in events:
            update = self._apply_event(update, event)
        if self.mode is Mode.CAPTURING and len(self._performed) < MAX_FRAMES:
            self._performed.append(frame)
        return update

    def _restart_if_needed(self, frame: LiveFrame) -> tuple[GestureEvent, ...]:
        """Restart the recognizer when the actor or the stream changes."""
        last, self._last = self._last, frame
        if last is None or (frame.body == last.body and frame.time > last.time):
            return ()
        mode, self._recognizer = self.mode, GestureRecognizer(self._settings)
        if mode is not Mode.CAPTURING:
            return ()
        return (GestureEvent(Gesture.CAPTURE_DROPPED, frame.time, frame.time),)

    def _apply_event(self, update: SessionUpdate, event: GestureEvent) -> SessionUpdate:
        """Start, drop or end the recording of a performance."""
        if event.gesture is Gesture.CAPTURE_START:
            self._performed = []
        elif event.gesture is Gesture.CAPTURE_DROPPED:
            self._performed = []
            return replace(update, message=NO_END)
        elif event.gesture is Gesture.CAPTURE_END:
            frames = [frame for frame in self._performed if frame.time <= event.began]
            self._performed = []
            return _performance(update, frames)
        return update


def _with_last_joints(frames: list[StreamFrame]) -> list[StreamFrame]:
    """Return the frames that have the joints of the last one."""
    return [frame for frame in frames if _joints_of(frame) == _joints_of(frames[-1])]


def _joints_of(frame: StreamFrame) -> Skeleton | tuple[str, ...]:
    """Return what the roles of the joints are found from."""
    return frame.skeleton if isinstance(frame, PoseFrame) else frame.names


def _performance(update: SessionUpdate, frames: list[LiveFrame]) -> SessionUpdate:
    if not frames or frames[-1].time - frames[0].time < MIN_PERFORMANCE_S:
        return replace(update, message=TOO_SHORT)
    try:
        return replace(update, query=recording_from_frames(frames), message="")
    except InvalidFileError as error:
        return replace(update, message=str(error))


def pose_from_frame(frame: LiveFrame) -> tuple[Array, Array]:
    """Return positions of the posture joints, (20, 3) meters, and their confidence, (20,)."""
    positions, confidence = (
        np.full((len(POSTURE_JOINTS), 3), np.nan),
        np.zeros(len(POSTURE_JOINTS)),
    )
    for role, joint in _posture_columns(frame.names):
        positions[role] = frame.positions[joint]
        confidence[role] = frame.confidence[joint]
    return positions, confidence


@lru_cache(maxsize=64)
def _posture_columns(names: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    """Return pairs of posture joint and column for these names."""
    found = posture_joint_indices(names)
    return tuple((POSTURE_JOINTS.index(role), joint) for role, joint in found.items())
