"""Correct a sensor's errors as published in [ZH14]."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...motion import JointRecording
from ...motion.humanoid import posture_positions
from ...progress import Progress, unwatched, within
from ...settings import Settings, setting
from ...signals import fill_gaps
from ..joint_rotations import Reconstruction
from ..reliability import (
    ReliabilityMethod,
    ReliabilitySettings,
    measure_reliability,
    posture_reliability,
)
from ..residual_correction import (
    CorrectedPostures,
    ResidualPrior,
    assemble_correction,
    mean_offset,
    shift_in_world,
    smooth_postures,
)

CM_PER_M = 100.0
"""[ZH14] gives no unit for its weights; with meters the temporal term would vanish."""
REFERENCE_RATE_HZ = 30.0
"""Frame rate in hertz for which the weights are specified. By definition: that of the
Kinect."""


@dataclass(frozen=True, kw_only=True)
class ThreeTermSettings(Settings):
    """Settings of `reconstruct_published_residuals`."""

    spatial: float = setting(0.6, "Weight of the predicted offsets", minimum=0.0, maximum=10.0)
    temporal: float = setting(0.2, "Weight of constant velocities", minimum=0.0, maximum=10.0)
    reliable: float = setting(
        0.2, "Weight of staying at reliable observations", minimum=0.0, maximum=10.0
    )
    causal: bool = setting(False, "Measure reliability from earlier frames only")
    shift: bool = setting(True, "Also correct the constant joint offset of the sensor")
    change: bool = setting(True, "Apply the pose-dependent offset")


def reconstruct_published_residuals(
    recording: JointRecording,
    prior: ResidualPrior,
    *,
    settings: ThreeTermSettings = ThreeTermSettings(),
    progress: Progress = unwatched,
) -> Reconstruction:
    """Correct joints with a residual prior, by the three energy terms of [1]_.

    E = w_S E_S + w_T E_T + w_R E_R (eq. 5.1, 5.4, 5.5, 5.6) is minimized frame by frame in
    closed form, since all terms are quadratic and diagonal. Result and errors are those of
    `correct_postures`.

    Parameters
    ----------
    recording : JointRecording
    prior : ResidualPrior
    settings : ThreeTermSettings
    progress : Progress

    References
    ----------
    .. [1] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong, 5.2.
    """
    reliability = measure_reliability(
        recording,
        settings=ReliabilitySettings(
            method=ReliabilityMethod.PUBLISHED, causal=settings.causal
        ),
        progress=within(progress, 0.0, 0.1),
    )
    progress(0.5, "Correcting")
    weights = posture_reliability(recording, reliability.combined)
    smooth = smooth_postures(recording, float(prior.smoothing), weights, causal=False)
    prediction = prior.predict(smooth, causal=True)
    mean = mean_offset(prediction, weights)
    predicted = smooth.positions.copy()
    if settings.change:
        predicted += smooth.rotate_to_world(prediction.offsets - mean)
    shift = shift_in_world(smooth, mean) if settings.shift else None
    if shift is not None:
        predicted += shift
    variances = prediction.variances + prior.constant_variances(constant=settings.shift)
    corrected = CorrectedPostures(
        minimize_terms(recording, predicted, variances, weights, settings),
        prediction,
        variances,
        shift,
        uses_prior=settings.change or settings.shift,
        method="published",
    )
    progress(0.9, "Correcting")
    result = assemble_correction(recording, prior, reliability, corrected)
    progress(1.0, "Corrected")
    return result


def minimize_terms(
    recording: JointRecording,
    predicted: Array,
    variances: Array,
    weights: Array,
    settings: ThreeTermSettings,
) -> Array:
    """Minimize eq. 5.6 of [ZH14] in each frame, given the frames 1/30 and 1/15 s before.

    Predicted offsets, in meters, have the shape (n_frames, 20, 3), variances and weights
    (n_frames, 20).
    """
    observed = fill_gaps(posture_positions(recording)) * CM_PER_M
    offsets = predicted * CM_PER_M - observed
    spatial = settings.spatial / (2.0 * variances * CM_PER_M**2)
    measured = settings.reliable * weights**2
    result = observed.copy()
    step = max(round(recording.frame_rate / REFERENCE_RATE_HZ), 1)
    for frame in range(len(observed)):
        temporal = settings.temporal if frame >= 2 * step else 0.0
        total = spatial[frame] + measured[frame] + temporal
        weighted_sum = spatial[frame][:, None] * offsets[frame]
        if frame >= 2 * step:
            extrapolated = (
                2.0 * result[frame - step] - result[frame - 2 * step] - observed[frame]
            )
            weighted_sum = weighted_sum + temporal * extrapolated
        result[frame] = observed[frame] + weighted_sum / np.maximum(total, 1e-12)[:, None]
    return result / CM_PER_M
