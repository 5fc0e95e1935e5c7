"""Terms of reliability: vibration, segment lengths, the tracking state, and their mean.

Each has shape (n_frames, n_joints), 0 to 1.
"""

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import JointRecording
from ...motion.skeletons import INFERRED, TRACKED
from .settings import SENSOR_RATE_HZ, ReliabilitySettings

MIN_TRACKED_CONFIDENCE = 0.5
"""Confidence from which on a joint counts as tracked, not inferred: by definition, the middle
of its range. Devices that report a confidence instead of a state need it."""


def behavior_term(positions: Array, frame_rate: float, settings: ReliabilitySettings) -> Array:
    """Return 1 for a smooth path, 0 for one that vibrates [SHJT13, eq. 1 to 4].

    Displacements are those within 1/30 s, or within one frame where that is longer. Eq. 3 gives
    a cosine, which eq. 4 uses as an angle in degrees; here it is the angle.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), meters
    frame_rate : float, hertz
    settings : ReliabilitySettings
    """
    step = frame_count(1.0 / SENSOR_RATE_HZ, frame_rate)
    angles = path_angles(positions, step, settings.min_vibration_speed * step / frame_rate)
    n_averaged = frame_count(settings.vibration_window, frame_rate)
    if settings.causal:
        angles = np.concatenate([np.zeros_like(angles[:step]), angles[:-step]])[: len(angles)]
    if not settings.causal:
        n_averaged = 2 * (n_averaged // 2) + 1
    angles = _weighted_mean(angles, np.ones(n_averaged), settings.causal)
    floor, roof = settings.min_vibration_angle, settings.max_vibration_angle
    return 1.0 - np.clip((angles - floor) / (roof - floor), 0.0, 1.0)  # eq. 4


def path_angles(positions: Array, step: int, shortest: float) -> Array:
    """Return the change of direction at each frame, degrees; 0 where the path hardly moves.

    Shape (n_frames, n_joints), of positions (n_frames, n_joints, 3) that move by more than
    `shortest` meters in `step` frames.
    """
    angles = np.zeros(positions.shape[:2])
    if len(positions) > 2 * step:
        moved = positions[step:] - positions[:-step]  # eq. 1 and 2
        lengths = vector_lengths(moved)
        before, after = lengths[:-step], lengths[step:]
        is_moving = (before > shortest) & (after > shortest)  # False for NaN
        products = np.einsum("nc,nc->n", moved[:-step][is_moving], moved[step:][is_moving])
        cosine = np.clip(products / (before[is_moving] * after[is_moving]), -1.0, 1.0)
        angles[step:-step][is_moving] = np.degrees(np.arccos(cosine))  # eq. 3
    return angles


def kinematics_term(lengths: Array, reference: Array, parents: NDArray[np.intp]) -> Array:
    """Return 1 where all segments at a joint have their length [SHJT13, eq. 5 and 6].

    Parameters
    ----------
    lengths : shape (n_frames, n_joints), meters
        Of the segment from its parent to each joint; NaN where there is none or it is missing.
    reference : shape (n_joints,), meters
        Expected lengths; NaN where unknown.
    parents : shape (n_joints,)
        -1 for roots.
    """
    valid_reference = np.where(reference > 0.0, reference, np.nan)
    errors = np.minimum(np.abs(lengths - valid_reference) / valid_reference, 1.0)  # eq. 5
    return 1.0 - mean_at_joints(errors, parents)  # eq. 6


def mean_at_joints(values: Array, parents: NDArray[np.intp]) -> Array:
    """Return the mean over the segments that meet at each joint; 0 where none is known.

    Shape (n_frames, n_joints), of values of the segments by their lower joint, NaN where
    unknown.
    """
    is_known = np.isfinite(values)
    values = np.where(is_known, values, 0.0)
    n_joints = len(parents)
    incidence = np.eye(n_joints)  # segment (by its lower joint) to joint
    children = np.flatnonzero(parents >= 0)
    incidence[children, parents[children]] = 1.0
    count = is_known.astype(np.float64) @ incidence
    return np.asarray(values @ incidence / np.maximum(count, 1.0))


def tracking_term(recording: JointRecording, settings: ReliabilitySettings) -> Array:
    """Return the tracking state as a reliability [SHJT13, eq. 7], shape (n_frames, n_joints).

    A confidence, where the device reports one instead of a state, is mapped linearly to the
    range from `settings.inferred` to 1. Without either, all is 1.
    """
    state, confidence = recording.tracking_state, recording.tracks.confidence
    if state is not None:
        inferred = np.where(state == INFERRED, settings.inferred, 0.0)
        return np.where(state == TRACKED, 1.0, inferred)
    if confidence is None:
        return np.ones(recording.tracks.positions.shape[:2])
    return np.asarray(settings.inferred + (1.0 - settings.inferred) * confidence)


def is_tracked(recording: JointRecording) -> NDArray[np.bool_]:
    """Return which joints the device tracked and did not only infer, (n_frames, n_joints)."""
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
    """Average over the window with Gaussian weights centered on the frame [SHJT13, eq. 8].

    The paper specifies neither the width of the Gaussian nor a normalization. Here the standard
    deviation is a third of the window, and the weights add up to 1. If not causal, half the
    window is on each side. Values have the shape (n_frames, ...).
    """
    n_window = frame_count(settings.window, frame_rate)
    if settings.causal:
        weights = np.exp(-0.5 * (np.arange(n_window) / (n_window / 3.0)) ** 2)
    else:
        offsets = np.arange(-(n_window // 2), n_window // 2 + 1)
        weights = np.exp(-0.5 * (offsets / (n_window / 3.0)) ** 2)
    return _weighted_mean(values, weights, settings.causal)


def frame_count(seconds: float, frame_rate: float) -> int:
    """Return the number of frames in a time, at least 1."""
    return max(1, round(seconds * frame_rate))


def _weighted_mean(values: Array, weights: Array, causal: bool) -> Array:
    """Average over existing frames; if causal, the first weight is for the current frame."""
    weight_sums = weighted_sum(np.ones(len(values)), weights, causal)
    sums = weighted_sum(values, weights, causal)
    return np.asarray(np.minimum(sums / weight_sums[:, None], values.max(initial=0.0)))


def weighted_sum(values: Array, weights: Array, causal: bool) -> Array:
    """Sum neighboring frames of values, (n_frames, ...), with weights, (n_weights,).

    If causal, the first weight is for the current frame, and the next are for earlier ones.
    """
    if causal:
        weights = np.concatenate([np.zeros(len(weights) - 1), weights])
    return np.asarray(scipy.ndimage.convolve1d(values, weights, axis=0, mode="constant"))


def vector_lengths(vectors: Array) -> Array:
    """Return the lengths, (...), of vectors, (..., 3)."""
    return np.asarray(np.sqrt(np.einsum("...c,...c->...", vectors, vectors)))
