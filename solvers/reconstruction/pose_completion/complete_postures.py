"""Postures of a library that follow what was seen, through whatever was not."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ...motion.humanoid import HIPS, Normalised, bone_changes
from ...progress import Progress, within
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
from ..published import search_sequentially
from .constrain_lengths import constrain_lengths
from .cross_validation import SynthesisErrors, cross_validate_limbs
from .probable_posture import probable_postures
from .residual_smoother import (
    Estimates,
    filter_residuals,
    measurement_deviation,
    smooth_residuals,
)
from .settings import PostureMethod, PostureSettings

Array = NDArray[np.float64]

RAMP_S = 0.2
"""Seconds before and after a joint is lost in which it is already trusted less, so that it is
synthesised on both sides of the loss alike."""
REUSED_RELIABILITY = 0.3
"""Trust in what one round synthesised and is sure of, in the next."""
HALF_CONFIDENCE_M = 0.05
"""Metres. Deviation at which that trust, or confidence, is half of what it can be."""
MODEL_ERROR_M = 0.03
"""Metres. Error of a posture that its neighbours agree upon."""
BLOCK_FRAMES = 256
"""Frames whose spaces are in memory at once."""
CORRECTION_FRAMES = 150
CORRECTION_NEIGHBORS = 3
CORRECTION_ROUNDS = 2


class CompletedPostures(NamedTuple):
    """Postures, shape (n_frames, 20, 3), how sure each joint is, and how limbs are twisted."""

    postures: Array
    confidence: Array
    twists: LimbTwists | None
    """None where the library tells none."""


@dataclass(frozen=True, eq=False)
class _ObservedTake:
    """What is known of a take: joints relative to where the hips seem to be, and trust."""

    postures: Array
    trust: Array
    frame_rate: float
    lengths: Array


def complete_postures(
    seen: Normalised,
    trust: Array,
    frame_rate: float,
    lengths: Array,
    library: PostureLibrary,
    settings: PostureSettings,
    progress: Progress,
) -> CompletedPostures:
    """Reconstruct the postures of a take.

    Parameters
    ----------
    seen : Normalised
    trust : shape (n_frames, 20)
        0 where a joint was not seen.
    frame_rate : float, hertz
    lengths : shape (20,), metres
    library : PostureLibrary
    settings : PostureSettings
    progress : Progress
    """
    take = _ObservedTake(seen.postures, trust, frame_rate, lengths)
    if settings.method is PostureMethod.PUBLISHED:
        return _search_as_published(take, library, settings, progress)
    body = _fit_library_to_actor(take, library, settings)
    index = index_postures(body, library.groups)
    errors = _measure_errors(take, body, index, settings)
    take = replace(take, postures=take.postures - errors.offset)
    rounds = 1 if settings.causal else settings.rounds
    shift = np.zeros((len(trust), 1, 3))
    asked, given = take.postures, _ramp_reliability(take, settings)
    for number in range(rounds):
        part = within(progress, number / rounds, (number + 1) / rounds)
        made, twists = _synthesize(
            replace(take, postures=asked, trust=given), body, index, settings, part
        )
        more = _hips_offset(take.postures - shift - made.values, trust, frame_rate, settings)
        shift = shift + more
        course = _add_residuals(made, take.postures - shift, take, errors.size, settings)
        if number + 1 < rounds:
            lost = (trust < REUSED_RELIABILITY)[..., None]
            asked = np.where(lost, course.values, take.postures - shift)
            again = REUSED_RELIABILITY / (1.0 + (course.spread / HALF_CONFIDENCE_M) ** 2)
            given = np.maximum(given, again)
    share = course.spread / errors.size
    unsure = np.hypot(settings.noise, share * np.hypot(made.spread, MODEL_ERROR_M))
    sure = 1.0 / (1.0 + (unsure / HALF_CONFIDENCE_M) ** 2)
    postures = constrain_lengths(course.values + errors.offset, lengths, trust, sure)
    return CompletedPostures(postures + shift, sure, twists)


def _search_as_published(
    take: _ObservedTake, library: PostureLibrary, settings: PostureSettings, progress: Progress
) -> CompletedPostures:
    """Search each frame's posture after that of the frame before, and do nothing else."""
    body = replace(
        build_body_postures(library.directions, library.changes, take.lengths),
        twists=library.twists,
    )
    plain = replace(settings, causal=True, pace=0.0, smoothing=0.0)
    index = index_postures(body, library.groups)
    made, twists = _synthesize(take, body, index, plain, progress)
    unsure = np.hypot(made.spread, MODEL_ERROR_M)
    sure = 1.0 / (1.0 + (unsure / HALF_CONFIDENCE_M) ** 2)
    return CompletedPostures(made.values, sure, twists and replace(twists, alone=True))


def _fit_library_to_actor(
    take: _ObservedTake, library: PostureLibrary, settings: PostureSettings
) -> BodyPostures:
    """Bring the library to the actor's size, and to the tracker's idea of a body."""
    directions, changes, lengths = library.directions, library.changes, take.lengths
    body = build_body_postures(directions, changes, lengths)
    frames = np.linspace(0, len(take.trust) - 1, CORRECTION_FRAMES).astype(int)
    frames = np.unique(frames)
    speeds = _speeds(take, settings)[frames]
    some = PostureQuery(take.postures[frames], speeds, take.trust[frames], settings.pace)
    for _ in range(CORRECTION_ROUNDS):
        index = index_postures(body, library.groups)
        places, _ = nearest_postures(index, some, CORRECTION_NEIGHBORS)
        each = places.shape[1]
        turns = bone_axis_corrections(
            np.repeat(some.postures, each, axis=0),
            np.repeat(some.trust, each, axis=0) / each,
            directions[places.reshape(-1)].astype(np.float64),
            lengths,
        )
        body = build_body_postures(directions, changes, lengths, turns)
    return replace(body, twists=library.twists)


def _speeds(take: _ObservedTake, settings: PostureSettings) -> Array:
    """Return how bones turn, which takes the frames to both sides to know: NaN if causal."""
    speeds = bone_changes(take.postures, take.frame_rate)
    return np.full_like(speeds, np.nan) if settings.causal else speeds


def _measure_errors(
    take: _ObservedTake, body: BodyPostures, index: PostureIndex, settings: PostureSettings
) -> SynthesisErrors:
    """Return what to expect of limbs that are not seen, by leaving them out."""
    speeds = _speeds(take, settings)

    def synthesise(frames: NDArray[np.intp], trust: Array) -> Array:
        query = PostureQuery(take.postures[frames], speeds[frames], trust, settings.pace)
        places, _ = nearest_postures(index, query, settings.n_neighbours)
        spaces = local_pca(body.positions[places].astype(np.float64), settings.n_dimensions)
        asked = EnergyTargets(take.postures[frames], trust, spaces.neighbours, take.lengths)
        return probable_postures(spaces, asked)[0]

    return cross_validate_limbs(take.postures, take.trust, synthesise)


def _ramp_reliability(take: _ObservedTake, settings: PostureSettings) -> Array:
    """Let trust fall and rise gradually about a loss; not before it in causal mode."""
    trust = take.trust
    reach = round(RAMP_S * take.frame_rate)
    least = trust
    for way in range(1, min(reach, len(trust) - 1) + 1):
        share = way / (reach + 1)
        near = np.ones_like(trust)
        near[way:] = trust[:-way]
        if not settings.causal:
            near[:-way] = np.minimum(near[:-way], trust[way:])
        least = np.minimum(least, near + (1.0 - near) * share)
    return least


def _synthesize(
    take: _ObservedTake,
    body: BodyPostures,
    index: PostureIndex,
    settings: PostureSettings,
    progress: Progress,
) -> tuple[Estimates, LimbTwists | None]:
    """Choose a posture for each frame, and the twist of its limbs.

    The spread of the course is the deviation of each joint by its space.
    """
    speeds = _speeds(take, settings)
    query = PostureQuery(take.postures, speeds, take.trust, settings.pace)
    places, _ = nearest_postures(
        index, query, settings.n_neighbours, progress=within(progress, 0.0, 0.4)
    )
    values, spread = np.empty_like(take.postures), np.empty_like(take.trust)
    twists = np.zeros((len(values), N_TWISTED_LIMBS), np.complex128)
    last = None
    for start in range(0, len(values), BLOCK_FRAMES):
        part = slice(start, min(start + BLOCK_FRAMES, len(values)))
        spaces = local_pca(body.positions[places[part]], settings.n_dimensions)
        asked = EnergyTargets(
            take.postures[part], take.trust[part], spaces.neighbours, take.lengths
        )
        probable, spread[part] = probable_postures(spaces, asked)
        values[part] = _choose_postures(spaces, asked, probable, settings, last)
        if body.twists is not None:
            twists[part] = mean_twists(
                body.twists[places[part]], values[part], spaces.neighbours, take.trust[part]
            )
        last = values[max(part.stop - 2, 0) : part.stop]
        progress(0.4 + 0.6 * part.stop / len(values), "Synthesising postures")
    if settings.smoothing and not settings.causal:
        width = settings.smoothing * take.frame_rate
        values = gaussian_filter1d(values, width, axis=0, mode="nearest")
    return Estimates(values, spread), None if body.twists is None else LimbTwists(twists)


def _choose_postures(
    spaces: PostureSpaces,
    asked: EnergyTargets,
    probable: Array,
    settings: PostureSettings,
    last: Array | None,
) -> Array:
    if settings.method is PostureMethod.PUBLISHED:
        return search_sequentially(spaces, asked, settings.seed, last)[0]
    return probable


def _hips_offset(
    off: Array, trust: Array, frame_rate: float, settings: PostureSettings
) -> Array:
    """Return where the hips are instead of where they seem to be, shape (n_frames, 1, 3).

    They are where joints that are trusted ask for, as far as the hips themselves are not.
    """
    weight = np.where(np.isfinite(off).all(axis=-1), trust, 0.0)
    weight[:, HIPS] = 0.0
    total = weight.sum(axis=1)[:, None]
    move = np.einsum("fi,fik->fk", weight, np.nan_to_num(off)) / (1.0 + total)
    move *= 1.0 - np.where(np.isfinite(off[:, HIPS, :1]), trust[:, [HIPS]], 0.0)
    if settings.smoothing and not settings.causal:
        move = gaussian_filter1d(move, settings.smoothing * frame_rate, axis=0, mode="nearest")
    return np.asarray(move[:, None])


def _add_residuals(
    made: Estimates, seen: Array, take: _ObservedTake, size: Array, settings: PostureSettings
) -> Estimates:
    """Lead synthesised postures through what was seen."""
    dt, deviation = 1.0 / take.frame_rate, measurement_deviation(take.trust, settings.noise)
    if settings.causal:
        course = filter_residuals(made.values, seen, deviation, dt, size, settings.memory)
    else:
        course = smooth_residuals(seen - made.values, deviation, dt, size, settings.memory)
    return Estimates(made.values + course.values, course.spread)
