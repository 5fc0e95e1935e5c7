"""Solve of the button Record Live: a stream of joints becomes motion of a rig's controls."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from time import monotonic, sleep
from typing import Any, NamedTuple

import numpy as np

from ...solvers.arrays import Array, Flags
from ...solvers.errors import InvalidMotionError, MocapAssistError
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings.streams import (
    ListenerState,
    PoseFrame,
    StreamFrame,
    StreamListener,
    StreamProtocol,
    allowed_networks,
)
from ...solvers.workflows import LiveTake, LiveTakeSettings, PoseTake
from ..scene.controls import BoneKeys, TargetRig
from ..track.pose_previews import Show, no_preview
from .solve_live_rig import LiveRig, LiveRigChoices, channels_of
from .stream_state import state_text

POLL_INTERVAL_S = 0.002
"""Seconds between two looks at the socket. It bounds the delay, and the processor's load."""
MAX_SILENCE_S = 10.0
"""Seconds without a pose after which a recording of fixed duration ends. It guards scripts."""
NOTHING_RECORDED = "Nothing was recorded: the actor was not measured yet."


@dataclass(frozen=True, eq=False)
class LiveProblem:
    """All that Record Live depends on."""

    port: int
    protocol: StreamProtocol
    allowed: str
    """Addresses of other machines that may send; empty: none."""
    target: TargetRig
    settings: LiveTakeSettings
    duration_s: float
    """After calibration; 0: until Esc."""
    first_frame: float
    """Frame of the scene at which the recording starts."""
    rig: LiveRigChoices = LiveRigChoices()
    person: int = 0
    """Number of the person to follow; 0: the first one."""


class RecordedTake(NamedTuple):
    """Channels of each bone for all frames."""

    frame_rate: float
    first_frame: float
    frames: Array
    """Numbers of the frames, shape (n_frames,), from 0; some may be left out."""
    keys: Mapping[str, BoneKeys]
    confidence: Mapping[str, Array]
    contacts: Flags | None = None
    """When the left and the right foot were held, shape (n_frames, 2), if feet are held."""
    remark: str = ""


def record_live(
    problem: LiveProblem, *, progress: Progress = unwatched, show: Show = no_preview
) -> RecordedTake:
    """Receive, reconstruct and retarget frames until the duration is over.

    Silence and errors end the recording, which then holds the frames before.

    Raises
    ------
    InvalidMotionError
        No data came, or no body was found in it.
    """
    shown: list[Any] = []

    def keep(preview: Any) -> None:
        show(preview)
        shown.append(preview)

    try:
        _record(problem, progress, keep)
    except MocapAssistError as error:
        if len(shown) > 1:
            return recorded_take(shown)._replace(remark=str(error))
        raise
    return recorded_take(shown)


def _record(problem: LiveProblem, progress: Progress, keep: Show) -> None:
    last_pose = monotonic()
    networks = allowed_networks(problem.allowed)
    with StreamListener(
        problem.port, problem.protocol, networks, person=problem.person
    ) as listener:
        recorder = _Recorder(problem, keep)
        while not recorder.is_done:
            frames = listener.poll()
            if recorder.add(frames):
                last_pose = monotonic()
            elif problem.duration_s and monotonic() - last_pose > MAX_SILENCE_S:
                raise InvalidMotionError(_silence_text(problem.port, listener.state))
            progress(*_state(recorder, listener.state))
            if not frames:
                sleep(POLL_INTERVAL_S)


class _Recorder:
    """Turns frames of a stream, of joints or of bones, into those of the rig."""

    def __init__(self, problem: LiveProblem, keep: Show) -> None:
        self.take: LiveTake | PoseTake | None = None
        self._problem, self._keep = problem, keep
        self._rig: LiveRig | None = None
        self._first: int | None = None
        self._n_frames = 0

    @property
    def is_done(self) -> bool:
        """Whether the duration is over."""
        return bool(self._problem.duration_s) and self.recorded_fraction >= 1.0

    @property
    def recorded_fraction(self) -> float:
        """Fraction of the duration that is recorded; 1 for a recording that Esc ends."""
        if not self._problem.duration_s:
            return 1.0
        if self._rig is None:
            return 0.0
        return self._n_frames / (self._problem.duration_s * self._rig.frame_rate)

    def add(self, frames: Sequence[StreamFrame]) -> bool:
        """Take frames that came together; return whether they show the actor."""
        if not frames:
            return False
        if self.take is None:
            self.take = _take_for(frames[0], self._problem.settings)
        poses = self.take.add(frames)
        if self.take.calibration is None:
            return self.take.calibrated_fraction > 0.0
        if self._rig is None:
            problem = self._problem
            self._rig = LiveRig(
                problem.target,
                problem.rig,
                self.take.calibration,
                self.take.names,
                problem.first_frame,
            )
            self._keep(self._rig.bones)
            return True
        for pose in poses:
            self._keep(self._rig.keys(pose, self.take.n_skipped))
            self._first = pose.frame if self._first is None else self._first
            self._n_frames = pose.frame - self._first + 1
        return bool(poses)


def _take_for(frame: StreamFrame, settings: LiveTakeSettings) -> LiveTake | PoseTake:
    """Return the live take for a stream of such frames."""
    return PoseTake(settings) if isinstance(frame, PoseFrame) else LiveTake(settings)


def recorded_take(previews: Iterable[Any]) -> RecordedTake:
    """Return the recording that these previews are.

    Raises
    ------
    InvalidMotionError
        They hold no frame.
    """
    bones, *frames = [*previews] or [None]
    if not frames:
        raise InvalidMotionError(NOTHING_RECORDED)
    numbers = np.array([each.frame for each in frames], dtype=np.float64)
    rotations, locations, confidence = (
        np.stack([getattr(each, name) for each in frames]).astype(np.float64)
        for name in ("rotations", "locations", "confidence")
    )
    n_skipped = frames[-1].n_skipped
    return RecordedTake(
        bones.frame_rate,
        bones.first_frame,
        numbers - numbers[0],
        channels_of(bones, rotations, locations),
        dict(zip(bones.rated, confidence.T, strict=True)),
        np.array([each.contacts for each in frames]) if bones.has_contacts else None,
        f"{n_skipped} frames were skipped, as the solver was busy." if n_skipped else "",
    )


def _state(recorder: _Recorder, state: ListenerState) -> tuple[float, str]:
    """Return fraction and message of the progress."""
    take = recorder.take
    if take is None:
        return 0.0, state_text("Waiting for the tracker.", state)
    if take.calibration is None:
        return take.calibrated_fraction, state_text(
            "Measuring the actor: move arms and legs.", state
        )
    text = state_text("Recording the actor.", state, take.has_other_body)
    return recorder.recorded_fraction, text


def _silence_text(port: int, state: ListenerState) -> str:
    """Return why nothing was recorded for a while."""
    if state.counts.why and not state.counts.frames:
        return state.counts.why
    return (
        f"No actor data was received on port {port} for {MAX_SILENCE_S:.0f} seconds."
        " Start the tracker, and check the port."
    )
