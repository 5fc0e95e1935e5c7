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
MAX_GAP_FRAMES = 60
"""Number of frames without data after which the filters start again. It bounds the time that a
long gap takes."""


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
        Since the first frame after calibration, at the rate of the stream.
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
        return [pose for frame in arrived[-MAX_WAITING:] for pose in self._started.add(frame)]

    def _calibrate(self, frames: list[LiveFrame]) -> None:
        for frame in frames:
            if self._first_frames and frame.time <= self._first_frames[-1].time:
                self._first_frames.clear()  # another sender, or the same one again
            self._first_frames.append(frame)
        if self.calibrated_fraction < 1.0:
            return
        try:
            recording = recording_from_frames(self._first_frames)
        except InvalidFileError:  # nothing was tracked: wait for the actor
            self._first_frames.clear()
            return
        settings = ReconstructSettings(smoothing=self._settings.smoothing)
        self._started = _StartedTake(recording, settings, self._first_frames[-1].time)
        self._first_frames.clear()


class _StartedTake:
    """A take whose actor was measured."""

    def __init__(
        self, recording: JointRecording, settings: ReconstructSettings, last_time: float
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
        self._last = _complete_pose(self.calibration, self.calibration.n_frames - 1)
        self._start, self._slot = last_time, 0

    @property
    def names(self) -> tuple[str, ...]:
        return self._actor.names

    def add(self, frame: LiveFrame) -> list[LiveMotion]:
        """Return the poses up to this frame: one, or more after a gap, or none."""
        if frame.names != self._actor.names:
            return []
        slot = round((frame.time - self._start) * self._actor.frame_rate)
        n_missing = slot - self._slot - 1
        if n_missing >= MAX_GAP_FRAMES or slot < self._slot:
            self._reconstructor = LiveReconstructor(self._actor)
            self._start = frame.time - (self._slot + 1) / self._actor.frame_rate
            slot, n_missing = self._slot + 1, 0
        missing = ObservedFrame(np.full((len(frame.names), 3), np.nan))
        if slot == self._slot:
            return []
        observed = [missing] * n_missing + [
            ObservedFrame(frame.positions, frame.states, frame.confidence)
        ]
        return [self._reconstruct(each) for each in observed]

    def _reconstruct(self, observed: ObservedFrame) -> LiveMotion:
        pose, actor = self._reconstructor.update(observed), self._actor
        self._slot += 1
        motion = motion_from_positions(
            Tracks(actor.names, pose.positions[None], actor.frame_rate),
            joint_parents(actor.names),
            pose.reliability[None],
            skeleton=self.calibration.skeleton,
            twists=pose.twists,
            refine=False,
        )
        self._last = _complete_pose(motion, 0, self._last)
        return LiveMotion(self._slot, self._last, pose)


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
