"""Both ways together: postures of clean clips for what was lost, residuals for what is off."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording, Sensor, Tracks
from ..progress import Progress, unwatched, within
from ..settings import Choice, Settings, setting
from ..signals import bridged, steadied
from .joint_rotations import Reconstruction
from .pose_completion import (
    PostureMethod,
    PostureSettings,
    bridged_losses,
    rebuilt_joints,
    reconstruct_postures,
)
from .pose_library import PostureLibrary
from .reliability import (
    ReliabilityMethod,
    ReliabilitySettings,
    measure_reliability,
    undo_exchanges,
)
from .residual_correction import (
    CorrectionMethod,
    CorrectionSettings,
    ResidualPrior,
    correct_postures,
    load_residual_prior,
)

Array = NDArray[np.float64]

SHIPPED = Path(__file__).parent / "residual_correction" / "residuals.npz"

DOUBTED, LOST = 0.5, 0.2
"""Joints that are trusted more than the first stay where they were seen; those trusted less
than the second are where the postures say."""
FAR = 0.15
"""Metres from its calmed path beyond which postures count for less than what was seen of a
joint: sensors that err by more are hardly trusted at all."""
WRONG, DOUBTFUL = 0.02, 0.07
"""Trust up to which that is so, and from which on it is not. On intact takes of UI-PRMD joints
that are trusted by 0.1 to 0.5 are 10 cm off, those below 0.05 by 40 cm."""
CALM = 0.1
"""Seconds of the Gaussian that calms what was seen."""


class ReconstructMethod(Choice):
    """What poses are rebuilt with."""

    BOTH = "both", "Rebuild missing joints from clean poses, then correct sensor errors"
    """Lost joints by postures of clean clips, then all by the residual prior."""
    POSTURES = "postures", "Only rebuild missing joints from clean poses", "Poses Only"
    """Postures of clean clips alone."""
    RESIDUALS = (
        "residuals",
        "Only correct sensor errors; gaps are interpolated smoothly",
        "Sensor Errors Only",
    )
    """The residual prior alone; gaps are bridged smoothly."""
    PUBLISHED_POSTURES = (
        "shum",
        "Rebuild missing joints as published by Shum et al. (2013)",
        "Shum et al. 2013",
    )
    """[SHJT13]: its reliability, and its stochastic search frame after frame."""
    PUBLISHED_RESIDUALS = (
        "zhou",
        "Correct sensor errors as published by Zhou et al. (2014)",
        "Zhou et al. 2014",
    )
    """[ZH14]: the same reliability, and its three terms frame after frame."""


@dataclass(frozen=True, kw_only=True)
class ReconstructSettings(Settings):
    """How poses are rebuilt from a depth camera's joints."""

    method: ReconstructMethod = setting(
        ReconstructMethod.BOTH,
        "What to rebuild, and how",
    )
    smoothing: float = setting(
        0.05, "Remove jitter shorter than about this; higher is smoother but blurs motion",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    n_neighbours: int = setting(
        30, "Number of clean poses that each rebuilt pose is made of; more vary more",
        minimum=2, maximum=200, label="Neighbors",
    )  # fmt: skip
    inferred: float = setting(
        0.5, "Weight of joints that the sensor only guessed; 0 rebuilds them all",
        minimum=0.0, maximum=1.0, label="Weight of Inferred Joints",
    )  # fmt: skip
    causal: bool = setting(False, "Use only earlier frames, as in a live system; less smooth")
    shift: bool = setting(
        False, "Also correct the constant joint offsets of this sensor model",
    )  # fmt: skip


USUAL = ReconstructSettings()
PUBLISHED = (ReconstructMethod.PUBLISHED_POSTURES, ReconstructMethod.PUBLISHED_RESIDUALS)
RESIDUALS = (ReconstructMethod.RESIDUALS, ReconstructMethod.PUBLISHED_RESIDUALS)


def reconstruct(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    settings: ReconstructSettings = USUAL,
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
    if not (settings.causal or settings.method in PUBLISHED):
        recording = undo_exchanges(recording)
    trust = measure_reliability(
        recording,
        settings=_signs(settings),
        progress=within(progress, 0.0, 0.1),
    )
    known = prior is not None or recording.sensor is Sensor.KINECT_V2
    if settings.method in RESIDUALS:
        return correct_postures(
            recording,
            prior or shipped_residual_prior(),
            reliability=trust,
            settings=_correction(settings, known),
            progress=within(progress, 0.1, 1.0),
        )
    if settings.method is not ReconstructMethod.BOTH:
        return reconstruct_postures(
            recording,
            postures,
            settings=_synthesis(settings),
            reliability=trust,
            progress=within(progress, 0.1, 1.0),
        )
    rebuilt = rebuilt_joints(
        recording, postures, trust.combined, _synthesis(settings), within(progress, 0.1, 0.7)
    )
    lost = _lost(recording.tracks, trust.combined, rebuilt.tracks, not settings.causal)
    sure = np.maximum(trust.combined, lost * rebuilt.confidence)
    places = rebuilt.tracks
    if not settings.causal:
        believed = recording.tracks.visible & (lost <= 0.0)
        places = places.with_positions(
            bridged_losses(
                recording.tracks.positions, believed, places.positions, recording.frame_rate
            )
        )
    corrected = correct_postures(
        replace(recording, tracks=_blended(recording.tracks, places, lost)),
        prior or shipped_residual_prior(),
        reliability=replace(trust, combined=sure),
        twists=rebuilt.twists,
        settings=_correction(settings, known),
        progress=within(progress, 0.7, 1.0),
    )
    confidence = np.minimum(corrected.confidence, np.maximum(1.0 - lost, rebuilt.confidence))
    return Reconstruction(
        corrected.tracks, corrected.motion, trust, confidence,
        f"{rebuilt.method}; {corrected.method}", rebuilt.twists,
    )  # fmt: skip


def _lost(seen: Tracks, trust: Array, rebuilt: Tracks, ahead: bool) -> Array:
    """Return how far postures are to replace what was seen, (n_frames, n_joints), 0 to 1.

    What was seen of a joint but is doubted says at least about where it is; a posture that has
    it elsewhere is not the one.
    """
    lost = np.clip((DOUBTED - trust) / (DOUBTED - LOST), 0.0, 1.0)
    known = seen.visible.any(axis=0)
    calm = bridged(seen.positions[:, known], ahead=ahead)
    calm = steadied(calm, CALM * seen.frame_rate, ahead=ahead)
    away = np.zeros(trust.shape)
    away[:, known] = np.linalg.norm(rebuilt.positions[:, known] - calm, axis=-1)
    near = 1.0 / (1.0 + (away / FAR) ** 4)
    held = np.clip((trust - WRONG) / (DOUBTFUL - WRONG), 0.0, 1.0)
    return np.where(seen.visible, lost * (1.0 - held + held * near), lost)


def _blended(seen: Tracks, rebuilt: Tracks, lost: Array) -> Tracks:
    """Return joints where they were seen, and where they were lost as postures have them."""
    share = np.where(seen.visible, lost, 1.0)[..., None]
    places = np.where(seen.visible[..., None], seen.positions, 0.0)
    return seen.with_positions(share * rebuilt.positions + (1.0 - share) * places)


def _signs(settings: ReconstructSettings) -> ReliabilitySettings:
    if settings.method in PUBLISHED:
        return ReliabilitySettings(method=ReliabilityMethod.PUBLISHED, causal=settings.causal)
    return ReliabilitySettings(causal=settings.causal, inferred=settings.inferred)


def _synthesis(settings: ReconstructSettings) -> PostureSettings:
    published = settings.method in PUBLISHED
    return PostureSettings(
        method=PostureMethod.PUBLISHED if published else PostureMethod.PROBABLE,
        causal=settings.causal,
        n_neighbours=settings.n_neighbours,
    )


def _correction(settings: ReconstructSettings, known: bool) -> CorrectionSettings:
    """Return how to correct; what is not known of a sensor cannot be taken out."""
    method = CorrectionMethod.CAUSAL if settings.causal else CorrectionMethod.WHOLE_TAKE
    if settings.method in PUBLISHED:
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
    return load_residual_prior(SHIPPED)
