"""Use a live stream of posed skeletons unchanged, frame by frame."""

from collections.abc import Iterable

import numpy as np

from ...errors import InvalidFileError, InvalidMotionError
from ...motion import Motion, find_humanoid_map
from ...motion.humanoid import ESSENTIAL_ROLES
from ...recordings.streams import PoseFrame, StreamFrame, measured_rate, motion_from_poses
from .first_frames import FirstFrames
from .live_motion import DEFAULT_SETTINGS, LiveMotion, LiveTakeSettings
from .time_slots import TimeSlots, is_continued

MAX_WAITING = 12
"""Number of frames that may wait to be taken; older ones are skipped. It bounds the delay when
frames arrive faster than they are taken: a tenth of a second."""


class PoseTake:
    """Measures a skeleton in the first seconds of a stream, and then takes each frame.

    Parameters
    ----------
    settings : LiveTakeSettings
    """

    names: tuple[str, ...] = ()
    """None: a stream of rotations says nothing of confidence."""

    def __init__(self, settings: LiveTakeSettings = DEFAULT_SETTINGS) -> None:
        self._first_frames = FirstFrames(settings.calibration_s, _continues)
        self._slots: TimeSlots | None = None
        self.calibration: Motion | None = None
        """The motion in which the skeleton was measured; None as long as that lasts."""
        self.n_skipped = 0
        """Number of frames that came faster than they were taken."""
        self.has_other_body = False
        """Whether the last frame was left out, as it has other bones than the calibration."""

    @property
    def calibrated_fraction(self) -> float:
        """Fraction of the calibration that is done, 0 to 1."""
        return self._first_frames.fraction if self.calibration is None else 1.0

    def add(self, frames: Iterable[StreamFrame]) -> list[LiveMotion]:
        """Take frames of bones that arrived together, in their order.

        Raises
        ------
        InvalidMotionError
            The bones are not those of a body.
        """
        received = list(frames)
        arrived = [frame for frame in received if isinstance(frame, PoseFrame)]
        if self.calibration is None:
            self._calibrate(arrived)
            return []
        self.n_skipped += max(len(arrived) - MAX_WAITING, 0)
        self.has_other_body = bool(received) and not arrived
        poses = [self._take(frame) for frame in arrived[-MAX_WAITING:]]
        return [pose for pose in poses if pose is not None]

    def _calibrate(self, frames: list[PoseFrame]) -> None:
        if not (complete := self._first_frames.collect(frames)):
            return
        try:
            rate = measured_rate(complete)
        except InvalidFileError:  # the clock of the sender stands still
            return
        calibration = motion_from_poses(complete, rate)
        roles = find_humanoid_map(calibration.skeleton)
        if missing := [role for role in ESSENTIAL_ROLES if role not in roles.joints]:
            raise InvalidMotionError(
                f"The stream has no bones for {', '.join(missing[:4])}. Send the complete body."
            )
        self._slots = TimeSlots(complete[-1].time, rate)
        self.calibration = calibration

    def _take(self, frame: PoseFrame) -> LiveMotion | None:
        """Return the pose of a frame; None if it has other bones, or shares its time slot."""
        assert self.calibration is not None and self._slots is not None
        skeleton = self.calibration.skeleton
        self.has_other_body = frame.names != skeleton.names
        if self.has_other_body:
            return None
        slot = self._slots.next(frame.time)
        if slot is None:
            return None
        motion = Motion(
            skeleton,
            np.array(frame.rotations[None]),
            np.array(frame.root_position[None]),
            self.calibration.frame_rate,
        )
        return LiveMotion(slot, motion, None, frame.body)


def _continues(last: PoseFrame, frame: PoseFrame) -> bool:
    """Return whether a frame shows the same body soon after the last one."""
    is_same = frame.body == last.body and frame.skeleton is last.skeleton
    return is_same and is_continued(frame.time - last.time)
