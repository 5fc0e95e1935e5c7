"""Clips as postures of one body that stands in one place and faces one way [ZH14, 3.2]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointRecording, Motion, Tracks, resample
from ...motion.humanoid import (
    POSTURE_JOINTS,
    USUAL_LENGTHS,
    body_lengths,
    motion_postures,
    normalise,
    posture_positions,
    resize,
)
from ...signals import bridged

Array = NDArray[np.float64]
Recording = Motion | Tracks | JointRecording

MAX_BRIDGED_GAP_S = 0.3
"""Seconds of a gap that a straight line bridges."""


@dataclass(frozen=True, eq=False)
class ClipPostures:
    """What of a recording can be compared with other people's.

    Attributes
    ----------
    positions : shape (n_frames, 20, 3), metres
        Joints of the standard body relative to its hips, facing -Y; in the order of
        `POSTURE_JOINTS`. NaN: not tracked.
    course : shape (n_frames, 4)
        How fast the hips move to the left, backward and up, as the actor faces, in metres per
        second, and how fast he turns, in radians per second.
    frame_rate : float, hertz
    """

    positions: Array
    course: Array
    frame_rate: float

    @property
    def n_frames(self) -> int:
        """How many frames there are."""
        return len(self.positions)


def clip_postures(recording: Recording, frame_rate: float | None = None) -> ClipPostures:
    """Take heading, place and the size of the actor out of a recording.

    Bones keep their directions and get the lengths of a standard body (eq. 3.2 and 3.3), so
    that rigs, actors and sensors can be compared. A joint that hangs on one that was not
    tracked lies where it was seen, in the scale of the whole body. Short gaps are bridged.

    Parameters
    ----------
    recording : Motion, Tracks or JointRecording
        Skeletons need arms and legs that are recognised; points must be named as those of a
        Kinect or by humanoid roles.
    frame_rate : float, hertz, optional
        At which to see it; that of the recording without.

    Raises
    ------
    InvalidMotionError
        No body is recognised, or nothing of it was tracked.
    """
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    rate = frame_rate or tracks.frame_rate
    if isinstance(tracks, Motion):
        motion = tracks if rate == tracks.frame_rate else resample(tracks, rate)
        joints = Tracks(POSTURE_JOINTS, motion_postures(motion), rate)
        positions = _bridge_short_gaps(joints).positions
    else:
        positions = posture_positions(resample(_bridge_short_gaps(tracks), rate))
    if not np.isfinite(positions).any():
        raise InvalidMotionError("No joint was tracked in any frame.")
    body = normalise(positions, rate)
    scale = USUAL_LENGTHS.sum() / max(body_lengths(body.postures).sum(), 1e-6)
    turns = np.unwrap(body.headings)
    return ClipPostures(
        resize(body.postures, USUAL_LENGTHS, scale),
        np.column_stack([
            _actor_velocity(_per_second(scale * body.places, rate), body.headings),
            _per_second(turns, rate),
        ]),
        rate,
    )  # fmt: skip


def half_precision(values: Array) -> NDArray[np.float16]:
    """Return numbers as they are stored; those beyond its range, of no motion, are the last."""
    largest = float(np.finfo(np.float16).max)
    return np.clip(values, -largest, largest).astype("<f2")


def _bridge_short_gaps(tracks: Tracks) -> Tracks:
    """Draw straight lines over short gaps; points before a lower rate makes them longer."""
    seen = tracks.visible
    if seen.all():
        return tracks
    frames = np.arange(len(seen), dtype=np.float64)[:, None]
    before = np.maximum.accumulate(np.where(seen, frames, -np.inf))
    after = np.minimum.accumulate(np.where(seen, frames, np.inf)[::-1])[::-1]
    known = after - before <= MAX_BRIDGED_GAP_S * tracks.frame_rate + 1.0
    return tracks.with_positions(np.where(known[..., None], bridged(tracks.positions), np.nan))


def _per_second(values: Array, frame_rate: float) -> Array:
    if len(values) < 2:
        return np.zeros_like(values)
    return np.asarray(np.gradient(values, 1.0 / frame_rate, axis=0))


def _actor_velocity(velocity: Array, headings: Array) -> Array:
    """Return world velocities as the actor sees them."""
    cos, sin = np.cos(headings), np.sin(headings)
    x, y, z = velocity.T
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=-1)
