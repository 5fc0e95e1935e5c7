"""Reconstruct clean poses: a pose library for missing joints, then residual correction."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from ..motion import JointRecording, Sensor
from ..progress import Progress, unwatched, within
from ..settings import Choice, Settings, setting
from .complete_take import complete_take
from .joint_rotations import Reconstruction
from .pose_completion import (
    PostureSettings,
    reconstruct_postures,
)
from .pose_library import PostureLibrary
from .published import (
    ThreeTermSettings,
    reconstruct_published_postures,
    reconstruct_published_residuals,
)
from .reliability import (
    Reliability,
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

SHIPPED_PRIOR = Path(__file__).parent / "residual_correction" / "residuals.npz"


class ReconstructMethod(Choice):
    """Method that reconstructs poses."""

    BOTH = "both", "Rebuild missing joints from clean poses, then correct sensor errors"
    """Library poses for missing joints, then the residual prior for all joints."""
    POSTURES = "postures", "Only rebuild missing joints from clean poses", "Poses Only"
    """Library poses only."""
    RESIDUALS = (
        "residuals",
        "Only correct sensor errors; gaps are interpolated smoothly",
        "Sensor Errors Only",
    )
    """The residual prior only; gaps are interpolated smoothly."""
    PUBLISHED_POSTURES = (
        "shum",
        "Rebuild missing joints as published by Shum et al. (2013)",
        "Shum et al. 2013",
    )
    """[SHJT13]: its reliability, and its stochastic search, frame by frame."""
    PUBLISHED_RESIDUALS = (
        "zhou",
        "Correct sensor errors as published by Zhou et al. (2014)",
        "Zhou et al. 2014",
    )
    """[ZH14]: the same reliability, and its three energy terms, frame by frame."""


PUBLISHED_METHODS = (
    ReconstructMethod.PUBLISHED_POSTURES,
    ReconstructMethod.PUBLISHED_RESIDUALS,
)


@dataclass(frozen=True, kw_only=True)
class ReconstructSettings(Settings):
    """Settings of `reconstruct`."""

    method: ReconstructMethod = setting(
        ReconstructMethod.BOTH,
        "Choose what to rebuild, and how",
        research=True,
    )
    smoothing: float = setting(
        0.05, "Remove jitter shorter than about this; higher is smoother but blurs motion",
        unit="s", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    n_neighbors: int = setting(
        30, "Number of clean poses that each rebuilt pose is made of; more gives more variety",
        minimum=2, maximum=200, label="Neighbors", former="n_neighbours", research=True,
    )  # fmt: skip
    inferred: float = setting(
        0.5, "Weight of joints that the sensor only guessed; 0 rebuilds them all",
        minimum=0.0, maximum=1.0, label="Inferred Weight",
    )  # fmt: skip
    causal: bool = setting(
        False, "Use only earlier frames, as in a live system; less smooth", research=True
    )
    shift: bool = setting(
        True, "Correct the constant joint offsets of a known sensor; off keeps its mean joint"
        " positions",
        label="Sensor Offset",
    )  # fmt: skip


DEFAULT_SETTINGS = ReconstructSettings()


def reconstruct(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    settings: ReconstructSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Reconstruct clean poses from the joints of a depth camera's tracker.

    The function corrects short left-right swaps (`fix_left_right_swaps`) and measures the
    reliability of each joint. It completes unreliable joints from library poses that match the
    reliable ones (`reconstruct_postures`). It subtracts the sensor's typical errors in such
    poses (`correct_postures`), and fits a skeleton of constant bone lengths. In causal mode
    each frame depends on the actor's body and on earlier frames only. Left-right swaps then
    stay, since only later frames reveal them.

    Parameters
    ----------
    recording : JointRecording
        15 to 32 joints of a body, among them the hips; NaN where not tracked.
    postures : PostureLibrary, optional
        The shipped library by default.
    prior : ResidualPrior, optional
        The shipped prior by default, which was learned from a Kinect v2. Recordings of other
        sensors are then only smoothed.
    settings : ReconstructSettings
    progress : Progress

    Returns
    -------
    Reconstruction

    Raises
    ------
    InvalidMotionError
        The joint names do not describe a body, or almost no joint was observed.
    SolveCancelled
        Raised by `progress`.
    """
    is_known_sensor = prior is not None or recording.sensor is Sensor.KINECT_V2
    if settings.method in PUBLISHED_METHODS:
        return _as_published(recording, postures, prior, settings, is_known_sensor, progress)
    if not settings.causal:
        recording = fix_left_right_swaps(recording)
    reliability = measure_reliability(
        recording,
        settings=ReliabilitySettings(causal=settings.causal, inferred=settings.inferred),
        progress=within(progress, 0.0, 0.1),
    )
    progress = within(progress, 0.1, 1.0)
    if settings.method is ReconstructMethod.POSTURES:
        return reconstruct_postures(
            recording,
            postures,
            settings=posture_settings(settings),
            reliability=reliability,
            progress=progress,
        )
    prior = prior or shipped_residual_prior()
    correction = correction_settings(settings, is_known_sensor)
    if settings.method is ReconstructMethod.RESIDUALS:
        return correct_postures(
            recording, prior, reliability=reliability, settings=correction, progress=progress
        )
    return _complete_and_correct(
        recording, postures, prior, reliability, settings, correction, progress
    )


def _as_published(
    recording: JointRecording,
    postures: PostureLibrary | None,
    prior: ResidualPrior | None,
    settings: ReconstructSettings,
    is_known_sensor: bool,
    progress: Progress,
) -> Reconstruction:
    """Reconstruct as one of the papers does."""
    if settings.method is ReconstructMethod.PUBLISHED_POSTURES:
        return reconstruct_published_postures(
            recording, postures, settings=posture_settings(settings), progress=progress
        )
    terms = ThreeTermSettings(
        causal=settings.causal,
        shift=settings.shift and is_known_sensor,
        change=is_known_sensor,
    )
    return reconstruct_published_residuals(
        recording, prior or shipped_residual_prior(), settings=terms, progress=progress
    )


def _complete_and_correct(
    recording: JointRecording,
    postures: PostureLibrary | None,
    prior: ResidualPrior,
    reliability: Reliability,
    settings: ReconstructSettings,
    correction: CorrectionSettings,
    progress: Progress,
) -> Reconstruction:
    """Complete unreliable joints from library poses, then subtract the sensor's errors."""
    completed = complete_take(
        recording,
        postures,
        reliability.combined,
        posture_settings(settings),
        within(progress, 0.0, 2.0 / 3.0),
    )
    corrected = correct_postures(
        completed.recording,
        prior,
        reliability=replace(reliability, combined=completed.reliability),
        twists=completed.rebuilt.twists,
        settings=correction,
        progress=within(progress, 2.0 / 3.0, 1.0),
    )
    confidence = np.minimum(corrected.confidence, completed.confidence)
    return Reconstruction(
        corrected.tracks, reliability, confidence,
        f"{completed.rebuilt.method}; {corrected.method}", completed.rebuilt.twists,
        corrected.shift,
    )  # fmt: skip


def posture_settings(settings: ReconstructSettings) -> PostureSettings:
    """Return the settings of the completion."""
    return PostureSettings(causal=settings.causal, n_neighbors=settings.n_neighbors)


def correction_settings(
    settings: ReconstructSettings, is_known_sensor: bool
) -> CorrectionSettings:
    """Return the settings of the correction; errors of an unknown sensor are not subtracted."""
    method = CorrectionMethod.CAUSAL if settings.causal else CorrectionMethod.WHOLE_TAKE
    defaults = CorrectionSettings()
    return CorrectionSettings(
        method=method,
        smoothing=settings.smoothing,
        shift=settings.shift and is_known_sensor,
        change=defaults.change if is_known_sensor else 0.0,
    )


@cache
def shipped_residual_prior() -> ResidualPrior:
    """Return the shipped prior: Kinect v2 against optical markers (UI-PRMD, ODC-PDDL)."""
    return load_residual_prior(SHIPPED_PRIOR)
