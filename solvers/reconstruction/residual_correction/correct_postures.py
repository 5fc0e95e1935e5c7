"""Take a sensor's errors out of a recording with a residual prior [ZH14, chapter 5]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...motion import JointRecording
from ...motion.humanoid import posture_positions
from ...progress import Progress, unwatched, within
from ...settings import Choice, Settings, setting
from ...signals import bridged
from ..joint_rotations import LimbTwists, Reconstruction, all_joints, anchors, follow_joints
from ..reliability import Reliability, measure_reliability, posture_reliability
from .inputs import calm_postures
from .predicted import Foretold
from .prior import ResidualPrior
from .smooth_paths import followed, smoothed

Array = NDArray[np.float64]

CENTIMETRES = 100.0
"""[ZH14] names no unit for its weights; with metres the temporal term would vanish."""
LEAST = 0.02
"""Weight of a joint that is not trusted at all, so that gaps are bridged smoothly."""
REFERENCE_RATE = 30.0
SURE_WITHIN = 0.05
"""Metres. Confidence is the chance that a joint lies within this of where it was."""


class CorrectionMethod(Choice):
    """How offsets, smoothness and trust are brought together."""

    WHOLE_TAKE = "whole take", "Smooth over the frames before and after each frame"
    CAUSAL = "causal", "Smooth over the frames before each frame only"
    PUBLISHED = (
        "published",
        "Weight three terms frame by frame, as Zhou et al. (2014)",
        "Zhou et al. 2014",
    )


@dataclass(frozen=True, kw_only=True)
class CorrectionSettings(Settings):
    """How a residual prior is applied."""

    method: CorrectionMethod = setting(
        CorrectionMethod.WHOLE_TAKE,
        "How offsets, smoothness and reliability are combined",
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
    spatial: float = setting(
        0.6, "Weight of the predicted offsets; published method only",
        minimum=0.0, maximum=10.0, advanced=True,
    )  # fmt: skip
    temporal: float = setting(
        0.2, "Weight of constant velocities; published method only",
        minimum=0.0, maximum=10.0, advanced=True,
    )  # fmt: skip
    trust: float = setting(
        0.2, "Weight of staying at reliable observations; published method only",
        minimum=0.0, maximum=10.0, advanced=True,
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
    """Move joints from where a sensor saw them to where they were, as far as is known.

    Published: minimise E = w_S E_S + w_T E_T + w_R E_R (eq. 5.1, 5.4, 5.5, 5.6), frame by frame
    in closed form, since all three are quadratic and diagonal. The default takes the mean
    offset of the take and a part of its change, and minimises over the whole take the distance
    to that, weighted by reliability, and the accelerations.

    Parameters
    ----------
    recording : JointRecording
    prior : ResidualPrior
    reliability : Reliability, optional
        Measured by `measure_reliability` where it is not given.
    twists : LimbTwists, optional
        How like postures have limbs twisted; by default bends alone tell it.
    settings : CorrectionSettings
    progress : Progress

    Returns
    -------
    Reconstruction
        Its confidence is the chance that a joint lies within 5 cm of where it was (without
        `shift`: beside a constant offset); where the prior knows nothing, the reliability.

    Raises
    ------
    InvalidMotionError
        No body is recognised in the names of the joints.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong, 5.2.
    """
    trust = reliability or measure_reliability(recording, progress=within(progress, 0.0, 0.3))
    weights = posture_reliability(recording, trust.combined)
    progress(0.4, "Correcting")
    corrected, told, variances = foretell_places(recording, prior, weights, settings)
    progress(0.9, "Correcting")
    asked = settings.change > 0.0 or settings.shift
    heard = told.coverage if asked else 0.0
    chance = prior.confidence(variances, SURE_WITHIN, constant=settings.shift)
    confidence = heard * chance + (1.0 - heard) * weights
    tracks = recording.tracks
    joints = all_joints(
        tracks.names, tracks.positions, trust.combined, posture_positions(recording), corrected
    )
    joints[:, ~tracks.visible.any(axis=0)] = np.nan
    confidence = confidence[:, anchors(tracks.names)]
    rebuilt = tracks.with_positions(joints)
    motion = follow_joints(rebuilt, recording.parents, trust.combined, twists=twists)
    progress(1.0, "Corrected")
    method = f"steadied ({settings.method.value})"
    if asked:
        method += f" with a residual prior of {prior.source}"
    return Reconstruction(rebuilt, motion, trust, confidence, method, twists)


def foretell_places(
    recording: JointRecording,
    prior: ResidualPrior,
    weights: Array,
    settings: CorrectionSettings,
) -> tuple[Array, Foretold, Array]:
    """Return the joints of postures where they were, what the prior told, and variances."""
    causal = settings.method is CorrectionMethod.CAUSAL
    calm = calm_postures(recording, float(prior.calm), weights, ahead=not causal)
    told = prior.predict(calm, ahead=settings.method is CorrectionMethod.WHOLE_TAKE)
    foretold = calm.positions + calm.turn_back(_offsets(told, weights, settings))
    variances = told.variances + prior.lasting_variances(constant=settings.shift)
    if settings.method is CorrectionMethod.PUBLISHED:
        places = _frame_by_frame(recording, foretold, variances, weights, settings)
        return places, told, variances
    steady = followed if causal else smoothed
    frames = settings.smoothing * recording.frame_rate
    return steady(foretold, np.maximum(weights, LEAST), frames), told, variances


def _offsets(told: Foretold, weights: Array, settings: CorrectionSettings) -> Array:
    """Return the offsets to apply: their mean over the take, and what changes with posture.

    Of the change a part is applied, and less of it in takes unlike those that were learned.
    """
    weighed = np.maximum(weights, LEAST)[..., None]
    mean = (weighed * told.offsets).sum(axis=0) / weighed.sum(axis=0)
    constant = mean if settings.shift else np.zeros_like(mean)
    if settings.method is CorrectionMethod.PUBLISHED and settings.change > 0.0:
        return np.asarray(told.offsets + (constant - mean))
    share = settings.change * told.coverage.mean(axis=0)
    return np.asarray(constant + share[:, None] * (told.offsets - mean))


def _frame_by_frame(
    recording: JointRecording,
    foretold: Array,
    variances: Array,
    weights: Array,
    settings: CorrectionSettings,
) -> Array:
    """Minimise eq. 5.6 of [ZH14] in each frame, after those 1/30 and 1/15 s before."""
    seen = bridged(posture_positions(recording)) * CENTIMETRES
    offsets = foretold * CENTIMETRES - seen
    spatial = settings.spatial / (2.0 * variances * CENTIMETRES**2)
    trust = settings.trust * weights**2
    result = seen.copy()
    step = max(round(recording.frame_rate / REFERENCE_RATE), 1)
    for frame in range(len(seen)):
        temporal = settings.temporal if frame >= 2 * step else 0.0
        total = spatial[frame] + trust[frame] + temporal
        wanted = spatial[frame][:, None] * offsets[frame]
        if frame >= 2 * step:
            steady = 2.0 * result[frame - step] - result[frame - 2 * step] - seen[frame]
            wanted = wanted + temporal * steady
        result[frame] = seen[frame] + wanted / np.maximum(total, 1e-12)[:, None]
    return result / CENTIMETRES
