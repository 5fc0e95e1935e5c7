"""Joints that a depth camera tracked, with the tracking state of each."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from .depth_sensors import Sensor, joint_parents
from .tracks import Tracks

NOT_TRACKED, INFERRED, TRACKED = 0, 1, 2


@dataclass(frozen=True, eq=False)
class JointRecording:
    """Joints of one body as a depth camera tracked them. NaN: missing.

    Attributes
    ----------
    tracks : Tracks
        One point per joint, in the order of the tracker or of the file.
    tracking_state : int8 array, shape (n_frames, n_joints), or None
        2 tracked, 1 inferred from other joints, 0 not tracked; None if the tracker did not
        report it.
    sensor : Sensor
    """

    tracks: Tracks
    tracking_state: NDArray[np.int8] | None
    sensor: Sensor

    def __post_init__(self) -> None:
        if not isinstance(self.sensor, Sensor):
            raise InvalidMotionError(
                f"{self.sensor!r} is not a sensor; choose one of"
                f" {', '.join(f'Sensor.{sensor.name}' for sensor in Sensor)}."
            )
        if self.tracking_state is not None:
            object.__setattr__(self, "tracking_state", self._check_state(self.tracking_state))

    def _check_state(self, tracking_state: NDArray[np.int8]) -> NDArray[np.int8]:
        state = np.asarray(tracking_state)
        if state.shape != self.tracks.positions.shape[:2]:
            raise InvalidMotionError(
                f"Tracking states need shape {self.tracks.positions.shape[:2]}, not"
                f" {state.shape}."
            )
        if not np.isin(state, (NOT_TRACKED, INFERRED, TRACKED)).all():
            raise InvalidMotionError(
                "Tracking states must be 0 (not tracked), 1 (inferred) or 2 (tracked)."
            )
        return state.astype(np.int8)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the joints."""
        return self.tracks.names

    @property
    def parents(self) -> tuple[int, ...]:
        """Index of each joint's parent (`joint_parents`); -1 for the root."""
        return joint_parents(self.tracks.names)

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return self.tracks.n_frames

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return self.tracks.n_points

    @property
    def frame_rate(self) -> float:
        """Frames per second."""
        return self.tracks.frame_rate

    def with_tracks(self, tracks: Tracks) -> "JointRecording":
        """Return the recording with other positions and the same tracking state."""
        return replace(self, tracks=tracks)

    def slice(self, start: int, stop: int) -> "JointRecording":
        """Return frames `start` up to but without `stop`."""
        state = None if self.tracking_state is None else self.tracking_state[start:stop]
        return replace(self, tracks=self.tracks.slice(start, stop), tracking_state=state)
