"""The terms of reliability: vibration, segment lengths, the tracker's own word, and their mean.

Each has shape (n_frames, n_joints), 0 to 1.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d

from ...motion import JointRecording
from ...motion.skeletons import INFERRED, TRACKED
from .settings import SENSOR_RATE_HZ, ReliabilitySettings

Array = NDArray[np.float64]

MIN_TRACKED_CONFIDENCE = 0.5
"""Confidence from which on a joint was seen and not guessed."""


def behaviour_term(positions: Array, frame_rate: float, settings: ReliabilitySettings) -> Array:
    """Return 1 for a steady path, 0 for one that turns to and fro [SHJT13, eq. 1 to 4].

    Displacements are those within 1/30 s, or a frame where that is longer. Eq. 3 gives the
    cosine, which eq. 4 takes for an angle in degrees; here it is the angle.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres
    frame_rate : float, hertz
    settings : ReliabilitySettings
    """
    step = frame_count(1.0 / SENSOR_RATE_HZ, frame_rate)
    turns = path_angles(positions, step, settings.slowest * step / frame_rate)
    n_averaged = frame_count(settings.vibration_window, frame_rate)
    if settings.causal:
        turns = np.concatenate([np.zeros_like(turns[:step]), turns[:-step]])[: len(turns)]
    if not settings.causal:
        n_averaged = 2 * (n_averaged // 2) + 1
    turns = _weighted_mean(turns, np.ones(n_averaged), settings.causal)
    floor, roof = settings.vibration_floor, settings.vibration_roof
    return 1.0 - np.clip((turns - floor) / (roof - floor), 0.0, 1.0)  # eq. 4


def path_angles(positions: Array, step: int, shortest: float) -> Array:
    """Return by how many degrees the path turns at each frame; 0 where it hardly moves."""
    turns = np.zeros(positions.shape[:2])
    if len(positions) > 2 * step:
        moved = positions[step:] - positions[:-step]  # eq. 1 and 2
        lengths = vector_lengths(moved)
        before, after = lengths[:-step], lengths[step:]
        far = (before > shortest) & (after > shortest)  # False for NaN
        along = np.einsum("nc,nc->n", moved[:-step][far], moved[step:][far])
        cosine = np.clip(along / (before[far] * after[far]), -1.0, 1.0)
        turns[step:-step][far] = np.degrees(np.arccos(cosine))  # eq. 3
    return turns


def kinematics_term(lengths: Array, reference: Array, parents: NDArray[np.intp]) -> Array:
    """Return 1 where all segments at a joint have their length [SHJT13, eq. 5 and 6].

    Parameters
    ----------
    lengths : shape (n_frames, n_joints), metres
        Of the segment from its parent to each joint; NaN where there is none, or not seen.
    reference : shape (n_joints,), metres
        What those lengths should be; NaN where that is not known.
    parents : shape (n_joints,)
        -1 for roots.
    """
    usable = np.where(reference > 0.0, reference, np.nan)
    wrong = np.minimum(np.abs(lengths - usable) / usable, 1.0)  # eq. 5
    return 1.0 - mean_at_joints(wrong, parents)  # eq. 6


def mean_at_joints(values: Array, parents: NDArray[np.intp]) -> Array:
    """Return the means over the segments that meet at each joint; 0 where none is known."""
    known = np.isfinite(values)
    values = np.where(known, values, 0.0)
    n_joints = len(parents)
    meets = np.eye(n_joints)  # segment (by its lower joint) to joint
    child = np.flatnonzero(parents >= 0)
    meets[child, parents[child]] = 1.0
    count = known.astype(np.float64) @ meets
    return np.asarray(values @ meets / np.maximum(count, 1.0))


def tracking_term(recording: JointRecording, settings: ReliabilitySettings) -> Array:
    """Return what the tracker says of each joint [SHJT13, eq. 7]; 1 where it says nothing.

    One that tells a confidence in the place of a state is taken at its word: from what an
    inferred joint counts for, where it has none, to 1.
    """
    state, confidence = recording.tracking_state, recording.tracks.confidence
    if state is not None:
        inferred = np.where(state == INFERRED, settings.inferred, 0.0)
        return np.where(state == TRACKED, 1.0, inferred)
    if confidence is None:
        return np.ones(recording.tracks.positions.shape[:2])
    return np.asarray(settings.inferred + (1.0 - settings.inferred) * confidence)


def is_tracked(recording: JointRecording) -> NDArray[np.bool_]:
    """Tell which joints the tracker saw, and did not only guess."""
    visible = recording.tracks.visible
    state, confidence = recording.tracking_state, recording.tracks.confidence
    if state is not None:
        return np.asarray(visible & (state == TRACKED))
    return (
        visible
        if confidence is None
        else np.asarray(visible & (confidence >= MIN_TRACKED_CONFIDENCE))
    )


def gaussian_mean(values: Array, frame_rate: float, settings: ReliabilitySettings) -> Array:
    """Average over the window, the frame itself counting most [SHJT13, eq. 8].

    The paper names neither the width of the Gaussian nor that weights add up to 1; here its
    standard deviation is a third of the window. Not causal: half the window on each side.
    """
    span = frame_count(settings.window, frame_rate)
    if settings.causal:
        weights = np.exp(-0.5 * (np.arange(span) / (span / 3.0)) ** 2)
    else:
        offsets = np.arange(-(span // 2), span // 2 + 1)
        weights = np.exp(-0.5 * (offsets / (span / 3.0)) ** 2)
    return _weighted_mean(values, weights, settings.causal)


def frame_count(seconds: float, frame_rate: float) -> int:
    """Return how many frames a time has, at least one."""
    return max(1, round(seconds * frame_rate))


def _weighted_mean(values: Array, weights: Array, causal: bool) -> Array:
    """Average over the frames that there are; causal: the first weight is the present's."""
    inside = weighted_sum(np.ones(len(values)), weights, causal)
    total = weighted_sum(values, weights, causal)
    return np.asarray(np.minimum(total / inside[:, None], values.max(initial=0.0)))


def weighted_sum(values: Array, weights: Array, causal: bool) -> Array:
    """Add up neighbouring frames; causal: the first weight is for the present, others past."""
    if causal:
        weights = np.concatenate([np.zeros(len(weights) - 1), weights])
    return np.asarray(convolve1d(values, weights, axis=0, mode="constant"))


def vector_lengths(vectors: Array) -> Array:
    """Return the lengths of vectors along the last axis."""
    return np.asarray(np.sqrt(np.einsum("...c,...c->...", vectors, vectors)))
