"""Calibrate the confidence of a residual prior for actors outside its training set."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import N_JOINTS, posture_positions
from ...progress import Progress, unwatched, within
from ..reliability import measure_reliability, posture_reliability
from .confidence import IDENTITY_CALIBRATION, Calibration
from .correct_postures import CorrectionSettings, predict_postures
from .learn_residual_prior import (
    MEDIAN_SQUARED_LENGTH,
    ResidualPriorSettings,
    learn_residual_prior,
)
from .residual_prior import ResidualPrior

Pair = tuple[JointRecording, Tracks]

DEFAULT_SETTINGS = ResidualPriorSettings()
MIN_FRAMES = 20
"""Minimum number of frames with a known joint of an actor."""
MIN_ACTORS = 3
MIN_POINTS = 3
"""Minimum number of joints of actors for the fit of a line."""
MIN_ERROR_M = 1e-4
"""Minimum median error (m); smaller ones carry no information. It guards a logarithm in
training."""


def calibrate_confidence(
    prior: ResidualPrior,
    pairs: Sequence[Pair],
    actors: Sequence[str],
    *,
    settings: ResidualPriorSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> ResidualPrior:
    """Return the prior with a confidence calibrated for new actors.

    Each actor is left out in turn, and a prior learned from the others predicts his errors. The
    ratio of measured to predicted errors, joint by joint, gives the uncertainty for a new
    actor. The prior itself stays unchanged.

    Parameters
    ----------
    prior : ResidualPrior
        Learned from all pairs.
    pairs, actors, settings
        As in `learn_residual_prior`; actors are required.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There are fewer than three actors.
    """
    actor_names = sorted(set(actors))
    if len(actor_names) < MIN_ACTORS:
        raise InvalidMotionError(
            f"Confidence is measured by leaving actors out and needs {MIN_ACTORS}; there are"
            f" {len(actor_names)}."
        )
    measured = []
    for index, actor in enumerate(actor_names):
        part = within(progress, index / len(actor_names), (index + 1) / len(actor_names))
        others = [row for row, name in enumerate(actors) if name != actor]
        learned = learn_residual_prior(
            [pairs[row] for row in others],
            actors=[actors[row] for row in others],
            settings=settings,
            progress=part,
        )
        own = [pair for pair, name in zip(pairs, actors, strict=True) if name == actor]
        measured.append(predicted_and_measured(learned, own))
    return with_calibration(prior, measured)


def with_calibration(prior: ResidualPrior, measured: Sequence[Array]) -> ResidualPrior:
    """Return the prior, calibrated by the (2, 20, 2) `predicted_and_measured` of each actor."""
    with_offset, without_offset = np.concatenate(measured, axis=1)
    lines = (
        fit_calibration(with_offset, keep_level=True),
        fit_calibration(without_offset, keep_level=False),
    )
    return replace(prior, calibration=np.array(lines))


def predicted_and_measured(prior: ResidualPrior, pairs: Sequence[Pair]) -> Array:
    """Return the predicted and the measured errors of one actor.

    Parameters
    ----------
    prior : ResidualPrior
        Learned without this actor.
    pairs : sequence of (JointRecording, Tracks)
        All takes of this actor.

    Returns
    -------
    shape (2, 20, 2)
        Log variances, predicted and measured (from the median, as errors have heavy tails);
        first with the constant offset, then without it.
    """
    takes = [
        _take_variances(prior, recording, posture_positions(truth))
        for recording, truth in pairs
    ]
    return np.array([
        _log_variances(*(np.concatenate(each) for each in zip(*of_takes, strict=True)))
        for of_takes in zip(*takes, strict=True)
    ])


def _take_variances(
    prior: ResidualPrior, recording: JointRecording, truth: Array
) -> list[tuple[Array, Array]]:
    """Return predicted variances and squared errors of a take, (n_frames, 20), twice.

    First with the constant offset, then without it. NaN: unknown.
    """
    weights = posture_reliability(recording, measure_reliability(recording).combined)
    measured = []
    for shift in (True, False):
        settings = CorrectionSettings(shift=shift)
        corrected = predict_postures(recording, prior, weights, settings)
        off = truth - corrected.positions
        if not shift:
            known = np.isfinite(off).any(axis=(0, 2))
            off[:, known] -= np.nanmean(off[:, known], axis=0)
        measured.append((corrected.variances, (off**2).sum(axis=-1)))
    return measured


def _log_variances(predicted: Array, squares: Array) -> Array:
    """Return log variances, predicted and measured, per joint, (20, 2); NaN: unknown."""
    rows = np.full((N_JOINTS, 2), np.nan)
    for joint in range(N_JOINTS):
        known = np.isfinite(squares[:, joint]) & np.isfinite(predicted[:, joint])
        if known.sum() >= MIN_FRAMES:
            median = max(float(np.median(squares[known, joint])), MIN_ERROR_M**2)
            rows[joint] = np.median(np.log(predicted[known, joint])), np.log(median)
    rows[:, 1] -= np.log(MEDIAN_SQUARED_LENGTH)
    return rows


def fit_calibration(points: Array, *, keep_level: bool) -> Calibration:
    """Fit a line to predicted and measured variances of left-out actors, and its spread.

    Parameters
    ----------
    points : shape (n_points, 2)
    keep_level : bool
        Whether to keep the predicted mean. With the constant offset the mean is already
        unbiased (`match_median_error`). Actors differ so much in the offset that, with few of
        them, leaving one out shifts the mean of the others to the opposite side. Without the
        offset no earlier estimate exists.
    """
    known = points[np.isfinite(points).all(axis=1)]
    if len(known) < MIN_POINTS:
        return IDENTITY_CALIBRATION
    level, mean = known.mean(axis=0)
    predicted, measured = known[:, 0] - level, known[:, 1] - mean
    size = float(predicted @ predicted)
    slope = float(np.clip(predicted @ measured / size, 0.0, 1.0)) if size > 0.0 else 1.0
    shift = 0.0 if keep_level else float(mean - level)
    rest = known[:, 1] - level - shift - slope * predicted
    return Calibration(shift, slope, float(np.sqrt((rest**2).mean())))
