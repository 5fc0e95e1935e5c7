"""Both ways together: postures of clean clips for what was lost, residuals for what is off."""

from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording, Sensor, Tracks
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting
from ..signals import bridged, steadied
from .joint_rotations import Reconstruction
from .pose_completion import (
    PostureMethod,
    PostureSettings,
    blend_short_gaps,
    complete_joints,
    reconstruct_postures,
)
from .pose_library import PostureLibrary
from .reliability import (
    ReliabilityMethod,
    ReliabilitySettings,
    fix_left_right_swaps,
    measure_reliability,
)
from .residual_correction import (
    CorrectionMethod,
    CorrectionSettings,
    ResidualPrior,
    correct_postures,
    load_residual_prior,
)

Array = NDArray[np.float64]

SHIPPED_PRIOR = Path(__file__).parent / "residual_correction" / "residuals.npz"

OBSERVED_RELIABILITY, REPLACED_RELIABILITY = 0.5, 0.2
"""Joints that are trusted more than the first stay where they were seen; those trusted less
than the second are where the postures say."""
HALF_WEIGHT_M = 0.15
"""Metres from its calmed path beyond which postures count for less than what was seen of a
joint: sensors that err by more are hardly trusted at all."""
WRONG_RELIABILITY, UNCERTAIN_RELIABILITY = 0.02, 0.07
"""Trust up to which that is so, and from which on it is not. On intact takes of UI-PRMD joints
that are trusted by 0.1 to 0.5 are 10 cm off, those below 0.05 by 40 cm."""
SMOOTHING_S = 0.1
"""Seconds of the Gaussian that calms what was seen."""


class ReconstructMethod(Enum):
    """What poses are rebuilt with."""

    BOTH = "both"
    """Lost joints by postures of clean clips, then all by the residual prior."""
    POSTURES = "postures"
    """Postures of clean clips alone."""
    RESIDUALS = "residuals"
    """The residual prior alone; gaps are bridged smoothly."""
    PUBLISHED_POSTURES = "shum"
    """[SHJT13]: its reliability, and its stochastic search frame after frame."""
    PUBLISHED_RESIDUALS = "zhou"
    """[ZH14]: the same reliability, and its three terms frame after frame."""


@dataclass(frozen=True, kw_only=True)
class ReconstructSettings(Settings):
    """How poses are rebuilt from a depth camera's joints."""

    method: ReconstructMethod = setting(
        ReconstructMethod.BOTH,
        "Both rebuilds lost joints from clean postures and then takes out how the sensor errs;"
        " the others do one of these alone; Shum and Zhou do so as their papers have it",
    )
    smoothing: float = setting(
        0.05, "Movements shorter than about this are jitter; higher is smoother and blunter",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    n_neighbours: int = setting(
        30, "Clean postures that each lost pose is made of; more vary more",
        minimum=2, maximum=200,
    )  # fmt: skip
    inferred: float = setting(
        0.5, "What a joint counts for that the sensor itself only guessed; 0 rebuilds all of"
        " them, as published; 0.5 those that also look wrong",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    causal: bool = setting(
        False, "Use only what came before each frame, as a live system must; less smooth"
    )
    shift: bool = setting(
        False, "Also move each joint by the offset that the prior's sensor always has, as from"
        " the skin to the joint; for recordings of the very sensor that the prior learned",
    )  # fmt: skip


DEFAULT_SETTINGS = ReconstructSettings()
PUBLISHED_METHODS = (
    ReconstructMethod.PUBLISHED_POSTURES,
    ReconstructMethod.PUBLISHED_RESIDUALS,
)
RESIDUAL_METHODS = (ReconstructMethod.RESIDUALS, ReconstructMethod.PUBLISHED_RESIDUALS)


def reconstruct(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    settings: ReconstructSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Rebuild clean poses from what a depth camera's tracker saw.

    Left and right are given back where the tracker exchanged them for a moment. Each joint's
    reliability is measured. What is not reliable is rebuilt from postures of clean clips that
    are like the rest (`reconstruct_postures`); how the sensor errs in such postures is taken
    out (`correct_postures`); and a skeleton of constant bone lengths follows. Causal joints
    know the actor and what came before, and so keep exchanges, which take the future to tell.

    Parameters
    ----------
    recording : JointRecording
        15 to 32 joints of a body, among them the hips; NaN where not tracked.
    postures : PostureLibrary, optional
        The one that is shipped by default.
    prior : ResidualPrior, optional
        The one that is shipped by default, for recordings of the sensor that it learned, a
        Kinect v2; those of others are steadied only.
    settings : ReconstructSettings
    progress : Progress

    Returns
    -------
    Reconstruction

    Raises
    ------
    InvalidMotionError
        No body is recognised in the names, or hardly a joint was ever seen.
    SolveCancelled
        Raised by `progress`.
    """
    if not (settings.causal or settings.method in PUBLISHED_METHODS):
        recording = fix_left_right_swaps(recording)
    trust = measure_reliability(
        recording,
        settings=_reliability_settings(settings),
        progress=within(progress, 0.0, 0.1),
    )
    known = prior is not None or recording.sensor is Sensor.KINECT_V2
    if settings.method in RESIDUAL_METHODS:
        return correct_postures(
            recording,
            prior or shipped_residual_prior(),
            reliability=trust,
            settings=_correction_settings(settings, known),
            progress=within(progress, 0.1, 1.0),
        )
    if settings.method is not ReconstructMethod.BOTH:
        return reconstruct_postures(
            recording,
            postures,
            settings=_posture_settings(settings),
            reliability=trust,
            progress=within(progress, 0.1, 1.0),
        )
    rebuilt = complete_joints(
        recording,
        postures,
        trust.combined,
        _posture_settings(settings),
        within(progress, 0.1, 0.7),
    )
    lost = _replacement_weights(
        recording.tracks, trust.combined, rebuilt.tracks, not settings.causal
    )
    sure = np.maximum(trust.combined, lost * rebuilt.confidence)
    places = rebuilt.tracks
    if not settings.causal:
        believed = recording.tracks.visible & (lost <= 0.0)
        places = places.with_positions(
            blend_short_gaps(
                recording.tracks.positions, believed, places.positions, recording.frame_rate
            )
        )
    corrected = correct_postures(
        replace(recording, tracks=_blend_tracks(recording.tracks, places, lost)),
        prior or shipped_residual_prior(),
        reliability=replace(trust, combined=sure),
        twists=rebuilt.twists,
        settings=_correction_settings(settings, known),
        progress=within(progress, 0.7, 1.0),
    )
    confidence = np.minimum(corrected.confidence, np.maximum(1.0 - lost, rebuilt.confidence))
    return Reconstruction(
        corrected.tracks, corrected.motion, trust, confidence,
        f"{rebuilt.method}; {corrected.method}", rebuilt.twists,
    )  # fmt: skip


def _replacement_weights(seen: Tracks, trust: Array, rebuilt: Tracks, ahead: bool) -> Array:
    """Return how far postures are to replace what was seen, (n_frames, n_joints), 0 to 1.

    What was seen of a joint but is doubted says at least about where it is; a posture that has
    it elsewhere is not the one.
    """
    lost = np.clip(
        (OBSERVED_RELIABILITY - trust) / (OBSERVED_RELIABILITY - REPLACED_RELIABILITY), 0.0, 1.0
    )
    known = seen.visible.any(axis=0)
    calm = bridged(seen.positions[:, known], ahead=ahead)
    calm = steadied(calm, SMOOTHING_S * seen.frame_rate, ahead=ahead)
    away = np.zeros(trust.shape)
    away[:, known] = np.linalg.norm(rebuilt.positions[:, known] - calm, axis=-1)
    near = 1.0 / (1.0 + (away / HALF_WEIGHT_M) ** 4)
    held = np.clip(
        (trust - WRONG_RELIABILITY) / (UNCERTAIN_RELIABILITY - WRONG_RELIABILITY), 0.0, 1.0
    )
    return np.where(seen.visible, lost * (1.0 - held + held * near), lost)


def _blend_tracks(seen: Tracks, rebuilt: Tracks, lost: Array) -> Tracks:
    """Return joints where they were seen, and where they were lost as postures have them."""
    share = np.where(seen.visible, lost, 1.0)[..., None]
    places = np.where(seen.visible[..., None], seen.positions, 0.0)
    return seen.with_positions(share * rebuilt.positions + (1.0 - share) * places)


def _reliability_settings(settings: ReconstructSettings) -> ReliabilitySettings:
    if settings.method in PUBLISHED_METHODS:
        return ReliabilitySettings(method=ReliabilityMethod.PUBLISHED, causal=settings.causal)
    return ReliabilitySettings(causal=settings.causal, inferred=settings.inferred)


def _posture_settings(settings: ReconstructSettings) -> PostureSettings:
    published = settings.method in PUBLISHED_METHODS
    return PostureSettings(
        method=PostureMethod.PUBLISHED if published else PostureMethod.PROBABLE,
        causal=settings.causal,
        n_neighbours=settings.n_neighbours,
    )


def _correction_settings(settings: ReconstructSettings, known: bool) -> CorrectionSettings:
    """Return how to correct; what is not known of a sensor cannot be taken out."""
    method = CorrectionMethod.CAUSAL if settings.causal else CorrectionMethod.WHOLE_TAKE
    if settings.method in PUBLISHED_METHODS:
        method = CorrectionMethod.PUBLISHED
    usual = CorrectionSettings()
    return CorrectionSettings(
        method=method,
        smoothing=settings.smoothing,
        shift=settings.shift and known,
        change=usual.change if known else 0.0,
    )


@cache
def shipped_residual_prior() -> ResidualPrior:
    """Return the prior that is shipped: a Kinect v2 against markers (UI-PRMD, ODC-PDDL)."""
    return load_residual_prior(SHIPPED_PRIOR)
