"""Turn a live stream of joints into poses of a skeleton, and record them."""

from collections.abc import Iterable
from dataclasses import replace

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
from ...recordings.streams import LiveFrame, StreamFrame, recording_from_frames
from .first_frames import FirstFrames
from .live_motion import DEFAULT_SETTINGS, LiveMotion, LiveTakeSettings
from .time_slots import TimeSlots, is_continued

MAX_WAITING = 2
"""Number of frames that may wait to be reconstructed; older ones are skipped. It bounds the
delay when frames arrive faster than they are reconstructed."""
N_WARM_UP_FRAMES = 10
"""Number of frames of the calibration with which the filters begin. It guards the first poses
against a jump, and bounds the time in which the stream waits."""


class LiveTake:
    """Measures an actor in the first seconds of a stream, and then reconstructs each frame.

    Parameters
    ----------
    settings : LiveTakeSettings
    """

    def __init__(self, settings: LiveTakeSettings = DEFAULT_SETTINGS) -> None:
        self._settings = settings
        self._first_frames = FirstFrames(settings.calibration_s, _continues)
        self._started: _StartedTake | None = None
        self.n_skipped = 0
        """Number of frames that came faster than they were reconstructed."""
        self.has_other_body = False
        """Whether the last frame was left out, as it has other joints than the calibration."""

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
        return self._first_frames.fraction if self._started is None else 1.0

    def add(self, frames: Iterable[StreamFrame]) -> list[LiveMotion]:
        """Reconstruct frames of joints that arrived together, in their order.

        Raises
        ------
        InvalidMotionError
            The joints are not those of a body, or the actor was hardly observed.
        """
        received = list(frames)
        arrived = [frame for frame in received if isinstance(frame, LiveFrame)]
        if self._started is None:
            self._calibrate(arrived)
            return []
        self.n_skipped += max(len(arrived) - MAX_WAITING, 0)
        if received:
            self.has_other_body = not arrived or arrived[-1].names != self.names
        poses = [self._started.add(frame) for frame in arrived[-MAX_WAITING:]]
        return [pose for pose in poses if pose is not None]

    def _calibrate(self, frames: list[LiveFrame]) -> None:
        if not (complete := self._first_frames.collect(frames)):
            return
        try:
            recording = recording_from_frames(complete)
        except InvalidFileError:  # nothing was tracked: wait for the actor
            return
        settings = ReconstructSettings(smoothing=self._settings.smoothing)
        self._started = _StartedTake(recording, settings, complete[-1])


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
        self._last = last
        self._slots = TimeSlots(last.time, recording.frame_rate)

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
        slot = self._slots.next(frame.time)
        self._last = frame
        if slot is None:
            return None
        observed = ObservedFrame(frame.positions, frame.states, frame.confidence)
        return LiveMotion(slot, *self._reconstruct(observed), frame.body)

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
    return frame.body == last.body and is_continued(frame.time - last.time)


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
