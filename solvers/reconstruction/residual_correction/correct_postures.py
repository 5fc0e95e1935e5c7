"""Subtract a sensor's errors from a recording with a residual prior [ZH14, chapter 5]."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import JointRecording
from ...motion.humanoid import posture_positions
from ...progress import Progress, unwatched, within
from ...settings import Choice, Settings, setting
from ..joint_rotations import (
    JointOffsets,
    LimbTwists,
    Reconstruction,
    find_anchors,
    positions_from_postures,
)
from ..reliability import (
    WRONG_RELIABILITY,
    Reliability,
    measure_reliability,
    posture_reliability,
)
from .inputs import SmoothedPostures, smooth_postures
from .prediction import Prediction
from .residual_prior import ResidualPrior
from .smooth_trajectories import TrajectoryFilter, smooth_trajectories

CONFIDENCE_DISTANCE_M = 0.05
"""Confidence is, by definition, the probability that a joint is within this distance (m) of its
true position."""


class CorrectionMethod(Choice):
    """Frames from which each frame is smoothed."""

    WHOLE_TAKE = "whole take", "Smooth over the frames before and after each frame"
    CAUSAL = "causal", "Smooth over the frames before each frame only"


@dataclass(frozen=True, kw_only=True)
class CorrectionSettings(Settings):
    """Settings of `correct_postures`."""

    method: CorrectionMethod = setting(
        CorrectionMethod.WHOLE_TAKE,
        "Choose how to combine offsets, smoothness and reliability",
    )
    smoothing: float = setting(
        0.05, "Remove jitter shorter than about this; higher is smoother but blurs motion",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    shift: bool = setting(
        True, "Also correct the constant joint offset of the sensor, as from skin to joint",
    )  # fmt: skip
    change: float = setting(
        0.9, "How much of the pose-dependent offset to apply; 1 relies fully on the prior",
        minimum=0.0, maximum=1.0, advanced=True,
    )  # fmt: skip


def correct_postures(
    recording: JointRecording,
    prior: ResidualPrior,
    *,
    reliability: Reliability | None = None,
    twists: LimbTwists | None = None,
    settings: CorrectionSettings = CorrectionSettings(),
    progress: Progress = unwatched,
) -> Reconstruction:
    """Correct the sensor's errors in joint positions with a residual prior.

    The mean offset of the take and a fraction of its change, less in takes unlike the training
    data, are subtracted. Over the complete take, the distance to the corrected positions,
    weighted by reliability, and the accelerations are minimized.

    Parameters
    ----------
    recording : JointRecording
    prior : ResidualPrior
    reliability : Reliability, optional
        Computed by `measure_reliability` by default.
    twists : LimbTwists, optional
        Axial rotations from similar library poses; by default flexion alone determines them.
    settings : CorrectionSettings
    progress : Progress

    Returns
    -------
    Reconstruction
        Its confidence is the probability that a joint is within 5 cm of its true position
        (without `shift`: apart from a constant offset); outside the prior's training data,
        the reliability.

    Raises
    ------
    InvalidMotionError
        The joint names do not describe a body.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong, 5.2.
    """
    reliability = reliability or measure_reliability(
        recording, progress=within(progress, 0.0, 0.3)
    )
    weights = posture_reliability(recording, reliability.combined)
    progress(0.4, "Correcting")
    corrected = predict_postures(recording, prior, weights, settings)
    progress(0.9, "Correcting")
    result = assemble_correction(recording, prior, reliability, corrected, twists)
    progress(1.0, "Corrected")
    return result


class TakeOffsets(NamedTuple):
    """How a sensor errs in one take, on average."""

    mean: Array
    """Mean offset of each joint, shape (20, 3), meters, relative to the heading."""
    fraction: Array
    """Fraction of the pose-dependent offset that is applied, shape (20,)."""


class CorrectedPostures(NamedTuple):
    """Corrected posture joints, the prediction of the prior, and its variances."""

    positions: Array
    prediction: Prediction
    variances: Array
    shift: Array | None
    """Constant offset in world axes, shape (n_frames, 20, 3); None if it was not corrected."""
    uses_prior: bool
    method: str
    offsets: TakeOffsets | None = None


def assemble_correction(
    recording: JointRecording,
    prior: ResidualPrior,
    reliability: Reliability,
    corrected: CorrectedPostures,
    twists: LimbTwists | None = None,
    joint_offsets: JointOffsets | None = None,
    level: float | None = None,
) -> Reconstruction:
    """Return all joints of a recording, and their confidence.

    `joint_offsets`, and `level`, the mean log variance, are those of other frames of this
    actor; by default they are measured here.
    """
    weights = posture_reliability(recording, reliability.combined)
    coverage = corrected.prediction.coverage if corrected.uses_prior else 0.0
    probability = prior.confidence(
        corrected.variances,
        CONFIDENCE_DISTANCE_M,
        constant=corrected.shift is not None,
        level=level,
    )
    confidence = coverage * probability + (1.0 - coverage) * weights
    tracks = recording.tracks
    joints = positions_from_postures(
        tracks.names,
        tracks.positions,
        reliability.combined,
        posture_positions(recording),
        corrected.positions,
        joint_offsets,
    )
    joints[:, ~tracks.visible.any(axis=0)] = np.nan
    anchors = find_anchors(tracks.names)
    shift = None if corrected.shift is None else corrected.shift[:, anchors]
    rebuilt = tracks.with_positions(joints)
    method = f"smoothed ({corrected.method})"
    if corrected.uses_prior:
        method += f" with a residual prior of {prior.source}"
    return Reconstruction(rebuilt, reliability, confidence[:, anchors], method, twists, shift)


def predict_postures(
    recording: JointRecording,
    prior: ResidualPrior,
    weights: Array,
    settings: CorrectionSettings,
) -> CorrectedPostures:
    """Return corrected posture joints, given the reliability of each, (n_frames, 20)."""
    causal = settings.method is CorrectionMethod.CAUSAL
    smooth = smooth_postures(recording, float(prior.smoothing), weights, causal=causal)
    prediction = prior.predict(smooth, causal=causal)
    fraction = settings.change * prediction.coverage.mean(axis=0)
    offsets = TakeOffsets(mean_offset(prediction, weights), fraction)
    frames = settings.smoothing * recording.frame_rate
    smoother = (
        TrajectoryFilter(frames).update
        if causal
        else partial(smooth_trajectories, frames=frames)
    )
    return subtract_offsets(smooth, prediction, offsets, weights, prior, settings, smoother)


def subtract_offsets(
    smooth: SmoothedPostures,
    prediction: Prediction,
    offsets: TakeOffsets,
    weights: Array,
    prior: ResidualPrior,
    settings: CorrectionSettings,
    smoother: Callable[[Array, Array], Array],
) -> CorrectedPostures:
    """Return posture joints without the sensor's offsets, smoothed with the given function.

    `weights` has the shape (n_frames, 20), 0 to 1. `smoother` gets positions (n_frames, 20, 3),
    meters, and their weights.
    """
    mean, fraction = offsets
    predicted = smooth.positions + smooth.rotate_to_world(
        fraction[:, None] * (prediction.offsets - mean)
    )
    shift = shift_in_world(smooth, mean) if settings.shift else None
    if shift is not None:
        predicted += shift
    return CorrectedPostures(
        smoother(predicted, np.maximum(weights, WRONG_RELIABILITY)),
        prediction,
        prediction.variances + prior.constant_variances(constant=settings.shift),
        shift,
        uses_prior=settings.change > 0.0 or settings.shift,
        method=settings.method.value,
        offsets=offsets,
    )


def shift_in_world(smooth: SmoothedPostures, mean: Array) -> Array:
    """Return a constant offset of each joint, (20, 3), in world axes, (n_frames, 20, 3)."""
    return smooth.rotate_to_world(np.broadcast_to(mean, smooth.positions.shape))


def mean_offset(prediction: Prediction, weights: Array) -> Array:
    """Return the mean offset of each joint over the take, shape (20, 3)."""
    joint_weights = np.maximum(weights, WRONG_RELIABILITY)[..., None]
    mean = (joint_weights * prediction.offsets).sum(axis=0) / joint_weights.sum(axis=0)
    return np.asarray(mean)
