"""Normalize clips to postures of a standard body at the origin with one heading [ZH14, 3.2]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import JointRecording, Motion, Tracks, resample
from ...motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    POSTURE_JOINTS,
    estimate_bone_lengths,
    normalize_postures,
    posture_positions,
    postures_from_motion,
    resize_postures,
)
from ...signals import fill_gaps

Recording = Motion | Tracks | JointRecording

MAX_BRIDGED_GAP_S = 0.3
"""Seconds; shorter gaps are interpolated linearly. It guards joints that flicker; over a longer
gap a straight line is not a movement."""


@dataclass(frozen=True, eq=False)
class ClipPostures:
    """Postures of a recording that can be compared between actors.

    Attributes
    ----------
    positions : shape (n_frames, 20, 3), meters
        Joints of the standard body relative to its hips, facing -Y; in the order of
        `POSTURE_JOINTS`. NaN: not tracked.
    root_velocity : shape (n_frames, 4)
        Velocity of the hips to the left, backward and up relative to the heading, in meters per
        second, and turning rate, in radians per second.
    frame_rate : float, hertz
    """

    positions: Array
    root_velocity: Array
    frame_rate: float

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.positions)


def clip_postures(recording: Recording, frame_rate: float | None = None) -> ClipPostures:
    """Remove heading, position and actor size from a recording.

    Bones keep their directions and get the lengths of a standard body (eq. 3.2 and 3.3), so
    that rigs, actors and sensors can be compared. A joint whose parent was not tracked keeps
    its observed position, in the scale of the complete body. Short gaps are interpolated.

    Parameters
    ----------
    recording : Motion, Tracks or JointRecording
        Skeletons need recognizable arms and legs; points need the names of Kinect joints or of
        humanoid roles.
    frame_rate : float, hertz, optional
        Frame rate of the result; default: that of the recording.

    Raises
    ------
    InvalidMotionError
        No body is recognized, or no joint was tracked.
    """
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    rate = frame_rate or tracks.frame_rate
    if isinstance(tracks, Motion):
        motion = tracks if rate == tracks.frame_rate else resample(tracks, rate)
        joints = Tracks(POSTURE_JOINTS, postures_from_motion(motion), rate)
        positions = _bridge_short_gaps(joints).positions
    else:
        positions = posture_positions(resample(_bridge_short_gaps(tracks), rate))
    if not np.isfinite(positions).any():
        raise InvalidMotionError("No joint was tracked in any frame.")
    body = normalize_postures(positions, rate)
    scale = ADULT_BONE_LENGTHS_M.sum() / max(estimate_bone_lengths(body.postures).sum(), 1e-6)
    angles = np.unwrap(body.headings)
    return ClipPostures(
        resize_postures(body.postures, ADULT_BONE_LENGTHS_M, scale),
        np.column_stack([
            _actor_velocity(_per_second(scale * body.hip_positions, rate), body.headings),
            _per_second(angles, rate),
        ]),
        rate,
    )  # fmt: skip


def half_precision(values: Array) -> NDArray[np.float16]:
    """Return values, of any shape, in half precision, clipped to its range."""
    largest = float(np.finfo(np.float16).max)
    return np.clip(values, -largest, largest).astype("<f2")


def _bridge_short_gaps(tracks: Tracks) -> Tracks:
    """Interpolate short gaps linearly, before resampling to a lower rate lengthens them."""
    observed = tracks.visible
    if observed.all():
        return tracks
    frames = np.arange(len(observed), dtype=np.float64)[:, None]
    before = np.maximum.accumulate(np.where(observed, frames, -np.inf))
    after = np.minimum.accumulate(np.where(observed, frames, np.inf)[::-1])[::-1]
    short = after - before <= MAX_BRIDGED_GAP_S * tracks.frame_rate + 1.0
    return tracks.with_positions(
        np.where(short[..., None], fill_gaps(tracks.positions), np.nan)
    )


def _per_second(values: Array, frame_rate: float) -> Array:
    if len(values) < 2:
        return np.zeros_like(values)
    return np.asarray(np.gradient(values, 1.0 / frame_rate, axis=0))


def _actor_velocity(velocity: Array, headings: Array) -> Array:
    """Return world velocities relative to the heading of the actor."""
    cos, sin = np.cos(headings), np.sin(headings)
    x, y, z = velocity.T
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=-1)
