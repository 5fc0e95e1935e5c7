"""Turn a live stream of joints into poses of a skeleton, and keep what was shown."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import JointRecording, Motion, Tracks, joint_parents
from ...reconstruction import (
    LivePose,
    LiveReconstructor,
    ObservedFrame,
    ReconstructSettings,
    measure_actor,
    reconstruct,
)
from ...reconstruction.joint_rotations import motion_from_positions
from ...recordings.live import LiveFrame, recording_from_frames
from ...settings import Settings, setting

MAX_WAITING = 2
"""Number of frames that may wait to be reconstructed; older ones are skipped. It bounds the
delay when frames arrive faster than they are reconstructed."""
N_WARM_UP_FRAMES = 10
"""Number of frames of the calibration with which the filters begin. It guards the first poses
against a jump, and bounds the time in which the stream waits."""
MAX_GAP_S = 0.5
"""Seconds without data after which the actor is measured from the start, or the filters begin
again. It guards filters, whose frames follow each other, and lengths from a few frames."""


@dataclass(frozen=True, kw_only=True)
class LiveTakeSettings(Settings):
    """Settings of `LiveTake`."""

    calibration_s: float = setting(
        3.0, "Time at the start in which the actor is measured; move arms and legs", unit="s",
        minimum=1.0, maximum=30.0, label="Calibration",
    )  # fmt: skip
    smoothing: float = setting(
        0.05, "Remove jitter shorter than about this; higher is smoother but later",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip


class LiveMotion(NamedTuple):
    """One frame of the actor.

    Attributes
    ----------
    frame : int
        Time slot after calibration, at the rate of the stream; slots without data are left out.
    motion : Motion
        One frame, without gaps.
    joints : LivePose
    """

    frame: int
    motion: Motion
    joints: LivePose


class LiveTake:
    """Measures an actor in the first seconds of a stream, and then reconstructs each frame.

    Parameters
    ----------
    settings : LiveTakeSettings
    """

    def __init__(self, settings: LiveTakeSettings = LiveTakeSettings()) -> None:
        self._settings = settings
        self._first_frames: list[LiveFrame] = []
        self._started: _StartedTake | None = None
        self.n_skipped = 0
        """Number of frames that came faster than they were reconstructed."""

    @property
    def calibration(self) -> Motion | None:
        """The motion in which the actor was measured; None as long as that lasts."""
        return None if self._started is None else self._started.calibration

    @property
    def names(self) -> tuple[str, ...]:
        """The joints of the sensor; none as long as the actor is measured."""
        return () if self._started is None else self._started.names

    @property
    def calibrated_fraction(self) -> float:
        """Fraction of the calibration that is done, 0 to 1."""
        if self._started is not None or not self._first_frames:
            return float(self._started is not None)
        elapsed = self._first_frames[-1].time - self._first_frames[0].time
        return min(elapsed / self._settings.calibration_s, 1.0)

    def add(self, frames: Iterable[LiveFrame]) -> list[LiveMotion]:
        """Reconstruct frames that arrived together, in their order.

        Raises
        ------
        InvalidMotionError
            The joints are not those of a body, or the actor was hardly observed.
        """
        arrived = list(frames)
        if self._started is None:
            self._calibrate(arrived)
            return []
        self.n_skipped += max(len(arrived) - MAX_WAITING, 0)
        poses = [self._started.add(frame) for frame in arrived[-MAX_WAITING:]]
        return [pose for pose in poses if pose is not None]

    def _calibrate(self, frames: list[LiveFrame]) -> None:
        for frame in frames:
            if self._first_frames and not _continues(self._first_frames[-1], frame):
                self._first_frames.clear()
            self._first_frames.append(frame)
        if self.calibrated_fraction < 1.0:
            return
        try:
            recording = recording_from_frames(self._first_frames)
        except InvalidFileError:  # nothing was tracked: wait for the actor
            self._first_frames.clear()
            return
        settings = ReconstructSettings(smoothing=self._settings.smoothing)
        self._started = _StartedTake(recording, settings, self._first_frames[-1])
        self._first_frames.clear()


class _StartedTake:
    """A take whose actor was measured."""

    def __init__(
        self, recording: JointRecording, settings: ReconstructSettings, last: LiveFrame
    ) -> None:
        self._actor = measure_actor(recording, settings=settings)
        causal = replace(settings, causal=True)
        found = reconstruct(recording, settings=causal)
        self.calibration = motion_from_positions(
            found.tracks, recording.parents, found.reliability.combined, refine=False
        )
        self._reconstructor = LiveReconstructor(self._actor)
        n_warm_up = min(N_WARM_UP_FRAMES, recording.n_frames)
        for frame in _observed_frames(recording, recording.n_frames - n_warm_up):
            self._reconstructor.update(frame)
        self._pose = _complete_pose(self.calibration, self.calibration.n_frames - 1)
        self._last, self._start, self._slot = last, last.time, 0

    @property
    def names(self) -> tuple[str, ...]:
        return self._actor.names

    def add(self, frame: LiveFrame) -> LiveMotion | None:
        """Return the pose of a frame; None if it has other joints, or shares its time slot.

        Slots without a frame stay empty. After a gap, and with another body, the filters begin
        again; a clock that was set back goes on from the last slot.
        """
        actor = self._actor
        if frame.names != actor.names:
            return None
        if not _continues(self._last, frame):
            self._reconstructor = LiveReconstructor(actor)
        if frame.time <= self._last.time:
            self._start = frame.time - (self._slot + 1) / actor.frame_rate
        slot = round((frame.time - self._start) * actor.frame_rate)
        self._last = frame
        if slot <= self._slot:
            return None
        self._slot = slot
        observed = ObservedFrame(frame.positions, frame.states, frame.confidence)
        return LiveMotion(slot, *self._reconstruct(observed))

    def _reconstruct(self, observed: ObservedFrame) -> tuple[Motion, LivePose]:
        found, actor = self._reconstructor.update(observed), self._actor
        motion = motion_from_positions(
            Tracks(actor.names, found.positions[None], actor.frame_rate),
            joint_parents(actor.names),
            found.reliability[None],
            skeleton=self.calibration.skeleton,
            twists=found.twists,
            refine=False,
        )
        self._pose = _complete_pose(motion, 0, self._pose)
        return self._pose, found


def _continues(last: LiveFrame, frame: LiveFrame) -> bool:
    """Return whether a frame shows the same body soon after the last one."""
    return frame.body == last.body and 0.0 < frame.time - last.time <= MAX_GAP_S


def _observed_frames(recording: JointRecording, first: int) -> Iterable[ObservedFrame]:
    states, confidence = recording.tracking_state, recording.tracks.confidence
    for frame in range(first, recording.n_frames):
        yield ObservedFrame(
            recording.tracks.positions[frame],
            None if states is None else states[frame],
            None if confidence is None else confidence[frame],
        )


def _complete_pose(motion: Motion, frame: int, last: Motion | None = None) -> Motion:
    """Return one frame of a motion; unknown rotations are those of the last frame."""
    identity = np.array([1.0, 0.0, 0.0, 0.0])
    rotations, root_positions = motion.rotations[[frame]], motion.root_positions[[frame]]
    last_rotations = identity if last is None else last.rotations
    last_position: Array | float = 0.0 if last is None else last.root_positions
    is_known = np.isfinite(rotations).all(axis=-1, keepdims=True)
    return Motion(
        motion.skeleton,
        np.where(is_known, rotations, last_rotations),
        np.where(np.isfinite(root_positions), root_positions, last_position),
        motion.frame_rate,
    )
