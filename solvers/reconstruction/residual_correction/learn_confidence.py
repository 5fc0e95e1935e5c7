"""How far a residual prior may be believed of people whom it has never seen."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import N_JOINTS, posture_positions
from ...progress import Progress, unwatched, within
from ..reliability import measure_reliability, posture_reliability
from .confidence import IDENTITY_CALIBRATION, Calibration
from .correct_postures import CorrectionSettings, predict_positions
from .learn_residual_prior import (
    MEDIAN_SQUARED_LENGTH,
    ResidualPriorSettings,
    learn_residual_prior,
)
from .prior import ResidualPrior

Array = NDArray[np.float64]
Pair = tuple[JointRecording, Tracks]

DEFAULT_SETTINGS = ResidualPriorSettings()
MIN_FRAMES = 20
"""Frames in which a joint of an actor must be known to tell anything."""
MIN_ACTORS = 3
MIN_POINTS = 3
"""Joints of actors, told and found, through which a line is laid."""
MIN_ERROR_M = 1e-4
"""Metres. Medians of errors below this tell nothing more."""


def calibrate_confidence(
    prior: ResidualPrior,
    pairs: Sequence[Pair],
    actors: Sequence[str],
    *,
    settings: ResidualPriorSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> ResidualPrior:
    """Return the prior with a confidence that holds for new actors.

    Each actor is left out in turn: what the others teach is tried on him. By how much he errs
    more or less than was told, joint by joint, is the uncertainty of somebody new. The prior
    itself stays.

    Parameters
    ----------
    prior : ResidualPrior
        Learned from all of these.
    pairs, actors, settings
        As `learn_residual_prior` has them; actors must be told.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There are fewer than three actors.
    """
    people = sorted(set(actors))
    if len(people) < MIN_ACTORS:
        raise InvalidMotionError(
            f"Confidence is measured by leaving actors out, and needs {MIN_ACTORS}; there"
            f" are {len(people)}."
        )
    found = []
    for place, actor in enumerate(people):
        part = within(progress, place / len(people), (place + 1) / len(people))
        others = [row for row, name in enumerate(actors) if name != actor]
        taught = learn_residual_prior(
            [pairs[row] for row in others],
            actors=[actors[row] for row in others],
            settings=settings,
            progress=part,
        )
        own = [pair for pair, name in zip(pairs, actors, strict=True) if name == actor]
        found.append(predicted_and_measured(taught, own))
    return with_calibration(prior, found)


def with_calibration(prior: ResidualPrior, found: Sequence[Array]) -> ResidualPrior:
    """Return the prior with what `told_and_found` says of actors who were left out."""
    whole, beside = np.concatenate(found, axis=1)
    lines = fit_calibration(whole, keep_level=True), fit_calibration(beside, keep_level=False)
    return replace(prior, calibration=np.array(lines))


def predicted_and_measured(prior: ResidualPrior, pairs: Sequence[Pair]) -> Array:
    """Return what was told of one actor's errors, and what was found.

    Parameters
    ----------
    prior : ResidualPrior
        That never saw him.
    pairs : sequence of (JointRecording, Tracks)
        All of his takes.

    Returns
    -------
    shape (2, 20, 2)
        Logarithms of variances, told and found (from the median, as errors have heavy tails);
        first with the constant offset, then beside it.
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
    """Return told variances and squared errors of a take, (n_frames, 20), twice.

    First with the constant offset, then beside it. NaN: not known.
    """
    weights = posture_reliability(recording, measure_reliability(recording).combined)
    found = []
    for shift in (True, False):
        settings = CorrectionSettings(shift=shift)
        places, _, variances = predict_positions(recording, prior, weights, settings)
        off = truth - places
        if not shift:
            known = np.isfinite(off).any(axis=(0, 2))
            off[:, known] -= np.nanmean(off[:, known], axis=0)
        found.append((variances, (off**2).sum(axis=-1)))
    return found


def _log_variances(told: Array, squares: Array) -> Array:
    """Return logarithms of what is told and found of each joint, (20, 2); NaN: nothing."""
    rows = np.full((N_JOINTS, 2), np.nan)
    for joint in range(N_JOINTS):
        known = np.isfinite(squares[:, joint]) & np.isfinite(told[:, joint])
        if known.sum() >= MIN_FRAMES:
            median = max(float(np.median(squares[known, joint])), MIN_ERROR_M**2)
            rows[joint] = np.median(np.log(told[known, joint])), np.log(median)
    rows[:, 1] -= np.log(MEDIAN_SQUARED_LENGTH)
    return rows


def fit_calibration(points: Array, *, keep_level: bool) -> Calibration:
    """Fit a line to what was told and found of actors who were left out, and the spread.

    Parameters
    ----------
    points : shape (n_points, 2)
    keep_level : bool
        Whether the mean stays as told. With the constant offset it was told honestly
        (`honest`), and actors differ so much in it that with a handful of them one who is left
        out moves the mean of the others to the other side: most would be told of those who err
        most. Beside the offset nobody told it before.
    """
    known = points[np.isfinite(points).all(axis=1)]
    if len(known) < MIN_POINTS:
        return IDENTITY_CALIBRATION
    level, mean = known.mean(axis=0)
    told, found = known[:, 0] - level, known[:, 1] - mean
    size = float(told @ told)
    slope = float(np.clip(told @ found / size, 0.0, 1.0)) if size > 0.0 else 1.0
    shift = 0.0 if keep_level else float(mean - level)
    rest = known[:, 1] - level - shift - slope * told
    return Calibration(shift, slope, float(np.sqrt((rest**2).mean())))
