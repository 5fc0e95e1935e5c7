"""Complete poses from a pose library where joints are missing."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, row_blocks
from ...motion.humanoid import HIPS, rates_from_directions
from ...progress import Progress, within
from ...signals import smooth_gaussian
from ..joint_rotations import (
    N_TWISTED_LIMBS,
    BodyPostures,
    LimbTwists,
    bone_axis_corrections,
    build_body_postures,
    mean_twists,
)
from ..pose_library import (
    PostureIndex,
    PostureLibrary,
    PostureQuery,
    index_postures,
    nearest_postures,
)
from ..pose_space import EnergyTargets, PostureSpaces, local_pca
from ..reliability import REPLACED_RELIABILITY
from .constrain_lengths import constrain_lengths
from .cross_validation import SynthesisErrors, cross_validate_limbs
from .probable_posture import probable_postures
from .residual_smoother import (
    Estimates,
    ResidualFilter,
    measurement_deviation,
    smooth_residuals,
)
from .settings import PostureSettings

HALF_CONFIDENCE_M = 0.05
"""Standard deviation (m) at which the confidence of a joint is halved. Half and twice gain less
than 1 % (`make sensitivity`)."""
MODEL_ERROR_M = 0.03
"""Standard deviation (m) of a pose on which all neighbors agree. Half and twice are no better
(`make sensitivity`)."""
CORRECTION_FRAMES = 150
"""Frames of the take, evenly spaced, to which the bone axes of the library are fitted. It
bounds the run time."""
CORRECTION_ROUNDS = 2
"""Number of times that the nearest poses are looked up with the corrected axes. It bounds the
run time."""


class CompletedPostures(NamedTuple):
    """Poses, shape (n_frames, 20, 3), the confidence of each joint, and how they were found."""

    postures: Array
    confidence: Array
    deviation: Array
    """Expected error of each joint on each axis, (n_frames, 20), meters."""
    twists: LimbTwists | None
    """None if the library has no twists."""
    library: "FittedLibrary | None" = None
    """The library that the poses are from, if it was fitted to the actor once."""
    method: str = "most probable postures"


@dataclass(frozen=True, eq=False)
class ObservedTake:
    """Observations of a take.

    Attributes
    ----------
    postures : shape (n_frames, 20, 3), meters
        Relative to the observed hips.
    reliability : shape (n_frames, 20)
        0 where a joint is missing.
    frame_rate : float, hertz
    lengths : shape (20,), meters
    """

    postures: Array
    reliability: Array
    frame_rate: float
    lengths: Array


Completer = Callable[
    [ObservedTake, PostureLibrary, PostureSettings, Progress], CompletedPostures
]
"""Function that completes the poses of a take from a library."""
Chooser = Callable[[PostureSpaces, EnergyTargets, Array | None], Array]
"""Function from pose spaces, targets and the last two poses to poses."""


class FittedLibrary(NamedTuple):
    """A library fitted to one actor, and how far its poses are from the actor's."""

    body: BodyPostures
    postures: PostureIndex
    errors: SynthesisErrors


def fit_library(
    take: ObservedTake, library: PostureLibrary, settings: PostureSettings
) -> FittedLibrary:
    """Fit a library to the actor of a take."""
    body = _fit_library_to_actor(take, library, settings)
    index = index_postures(body, library.groups)
    return FittedLibrary(body, index, _measure_errors(take, body, index, settings))


def complete_postures(
    take: ObservedTake, library: PostureLibrary, settings: PostureSettings, progress: Progress
) -> CompletedPostures:
    """Complete the poses of a take with the most probable poses of a library."""
    return complete_from_fitted(
        take, fit_library(take, library, settings), settings, None, progress
    )


def complete_from_fitted(
    take: ObservedTake,
    library: FittedLibrary,
    settings: PostureSettings,
    past: ResidualFilter | None,
    progress: Progress,
) -> CompletedPostures:
    """Complete the poses of a take from a library that fits its actor.

    `past` holds what earlier frames showed, if `take` continues them; only for causal settings.
    """
    body, index, errors = library
    reliability, frame_rate, lengths = take.reliability, take.frame_rate, take.lengths
    take = replace(take, postures=take.postures - errors.offset)
    rounds = 1 if settings.causal else settings.rounds
    offset = np.zeros((len(reliability), 1, 3))
    targets, given = take.postures, reliability
    for number in range(rounds):
        part = within(progress, number / rounds, (number + 1) / rounds)
        chosen, twists = synthesize(
            replace(take, postures=targets, reliability=given), body, index, settings, part
        )
        residuals = take.postures - offset - chosen.values
        offset = offset + _hips_offset(residuals, reliability, frame_rate, settings)
        corrected = _add_residuals(
            chosen, take.postures - offset, take, errors.size, settings, past
        )
        if number + 1 < rounds:
            missing = (reliability < REPLACED_RELIABILITY)[..., None]
            targets = np.where(missing, corrected.values, take.postures - offset)
            reused = REPLACED_RELIABILITY / (1.0 + (corrected.spread / HALF_CONFIDENCE_M) ** 2)
            given = np.maximum(given, reused)
    spread_ratio = corrected.spread / errors.size
    spread = spread_ratio * np.hypot(chosen.spread, MODEL_ERROR_M)
    confidence = confidence_from_deviation(np.hypot(settings.noise, spread))
    postures = corrected.values + errors.offset
    postures = constrain_lengths(postures, lengths, reliability, confidence)
    return CompletedPostures(postures + offset, confidence, corrected.spread, twists, library)


def _fit_library_to_actor(
    take: ObservedTake, library: PostureLibrary, settings: PostureSettings
) -> BodyPostures:
    """Fit the library to the actor's size and to the tracker's definition of joints."""
    directions, changes, lengths = library.directions, library.changes, take.lengths
    body = build_body_postures(directions, changes, lengths)
    frames = np.linspace(0, len(take.reliability) - 1, CORRECTION_FRAMES).astype(int)
    frames = np.unique(frames)
    speeds = _speeds(take, settings)[frames]
    query_sample = PostureQuery(
        take.postures[frames], speeds, take.reliability[frames], settings.pace
    )
    for _ in range(CORRECTION_ROUNDS):
        index = index_postures(body, library.groups)
        nearest, _ = nearest_postures(index, query_sample, 1)
        corrections = bone_axis_corrections(
            query_sample.postures,
            query_sample.reliability,
            directions[nearest[:, 0]].astype(np.float64),
            lengths,
        )
        body = build_body_postures(directions, changes, lengths, corrections)
    return replace(body, twists=library.twists)


def _speeds(take: ObservedTake, settings: PostureSettings) -> Array:
    """Return the velocities of bones; NaN if causal, since they need later frames."""
    speeds = rates_from_directions(take.postures, take.frame_rate)
    return np.full_like(speeds, np.nan) if settings.causal else speeds


def _measure_errors(
    take: ObservedTake, body: BodyPostures, index: PostureIndex, settings: PostureSettings
) -> SynthesisErrors:
    """Estimate the errors of unobserved limbs by cross-validation."""
    speeds = _speeds(take, settings)

    def synthesize(frames: NDArray[np.intp], reliability: Array) -> Array:
        observed = take.postures[frames]
        query = PostureQuery(observed, speeds[frames], reliability, settings.pace)
        indices, _ = nearest_postures(index, query, settings.n_neighbors)
        spaces = local_pca(body.positions[indices].astype(np.float64), settings.n_dimensions)
        targets = EnergyTargets(observed, reliability, spaces.neighbors, take.lengths)
        return probable_postures(spaces, targets)[0]

    return cross_validate_limbs(take.postures, take.reliability, synthesize)


def synthesize(
    take: ObservedTake,
    body: BodyPostures,
    index: PostureIndex,
    settings: PostureSettings,
    progress: Progress,
    choose: Chooser | None = None,
) -> tuple[Estimates, LimbTwists | None]:
    """Choose a pose for each frame, the most probable one by default, and its limbs' twist.

    The spread of the result is the standard deviation of each joint in its pose space.
    """
    speeds = _speeds(take, settings)
    query = PostureQuery(take.postures, speeds, take.reliability, settings.pace)
    indices, _ = nearest_postures(
        index, query, settings.n_neighbors, progress=within(progress, 0.0, 0.4)
    )
    values, spread = np.empty_like(take.postures), np.empty_like(take.reliability)
    twists = np.zeros((len(values), N_TWISTED_LIMBS), np.complex128)
    last = None
    for part in row_blocks(len(values), settings.n_neighbors * values[0].size):
        spaces = local_pca(body.positions[indices[part]], settings.n_dimensions)
        reliability, near = take.reliability[part], spaces.neighbors
        targets = EnergyTargets(take.postures[part], reliability, near, take.lengths)
        probable, spread[part] = probable_postures(spaces, targets)
        values[part] = choose(spaces, targets, last) if choose else probable
        if body.twists is not None:
            similar = body.twists[indices[part]]
            twists[part] = mean_twists(similar, values[part], near, reliability)
        last = values[max(part.stop - 2, 0) : part.stop]
        progress(0.4 + 0.6 * part.stop / len(values), "Synthesizing poses")
    if settings.smoothing and not settings.causal:
        width = settings.smoothing * take.frame_rate
        values = smooth_gaussian(values, width)
    return Estimates(values, spread), None if body.twists is None else LimbTwists(twists)


def confidence_from_deviation(deviation: Array) -> Array:
    """Return the confidence, same shape, from standard deviations of joints, meters."""
    return np.asarray(1.0 / (1.0 + (deviation / HALF_CONFIDENCE_M) ** 2))


def _hips_offset(
    residuals: Array, reliability: Array, frame_rate: float, settings: PostureSettings
) -> Array:
    """Return the offset of the hips from their observed position, shape (n_frames, 1, 3).

    Reliable joints determine the offset, as far as the hips themselves are unreliable.
    """
    weight = np.where(np.isfinite(residuals).all(axis=-1), reliability, 0.0)
    weight[:, HIPS] = 0.0
    total = weight.sum(axis=1)[:, None]
    displacement = np.einsum("fi,fik->fk", weight, np.nan_to_num(residuals)) / (1.0 + total)
    is_observed = np.isfinite(residuals[:, HIPS, :1])
    displacement *= 1.0 - np.where(is_observed, reliability[:, [HIPS]], 0.0)
    if settings.smoothing and not settings.causal:
        displacement = smooth_gaussian(displacement, settings.smoothing * frame_rate)
    return np.asarray(displacement[:, None])


def _add_residuals(
    chosen: Estimates,
    observed: Array,
    take: ObservedTake,
    size: Array,
    settings: PostureSettings,
    past: ResidualFilter | None,
) -> Estimates:
    """Add smoothed residuals of the observations to synthesized poses."""
    dt = 1.0 / take.frame_rate
    deviation = measurement_deviation(take.reliability, settings.noise)
    if settings.causal:
        past = past or ResidualFilter(dt, size, settings.memory)
        corrected = past.update(chosen.values, observed, deviation)
    else:
        corrected = smooth_residuals(
            observed - chosen.values, deviation, dt, size, settings.memory
        )
    return Estimates(chosen.values + corrected.values, corrected.spread)
