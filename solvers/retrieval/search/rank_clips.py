"""Rank clips by codeword histograms, then time warping, then neighbors."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Integers, Single
from ..index import (
    HISTOGRAM_SCALE,
    N_AXES,
    N_CUBES,
    SearchIndex,
    Segments,
    frame_distances,
    pairwise_warping_costs,
    rerank_by_neighbors,
    warping_costs,
    weight_mean_posture,
)
from ..postures import N_PARTS
from .find_settings import FindSettings

CLIPS_PER_NEIGHBOR = 20
"""Clips per neighbor in re-ranking: in a small library the nearest clips are not similar. Half
and twice are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class Ranking:
    """Clips ranked by similarity to a query.

    Attributes
    ----------
    clips : int64, shape (n,)
        Clip numbers, best first.
    frames : int32, shape (n, 2)
        Most similar segment of each clip, at 20 Hz.
    distances : shape (n,)
        0 for the same motion, about 1.5 for unrelated motions.
    """

    clips: Integers
    frames: NDArray[np.int32]
    distances: Single


@dataclass(frozen=True, eq=False)
class Candidates:
    """Clips of an index by the similarity of their histograms to those of a query.

    Attributes
    ----------
    clips : int64, shape (n,)
        Clip numbers, most similar first. Clips that cannot be among the results are left out.
    frames : int32, shape (n, 2)
        Most similar segment of each clip, at 20 Hz.
    distances : shape (n,)
    segments : int64, shape (n,)
        Row of each segment in its index.
    summaries : shape (n_warped, 16, 5, 8), meters
        Of the first segments: those that are compared over time.
    n_clips, n_segments : int
        Numbers of clips and of segments in the index.
    """

    clips: Integers
    frames: NDArray[np.int32]
    distances: Single
    segments: Integers
    summaries: Single
    n_clips: int
    n_segments: int


def rank_clips(
    query: Segments,
    weights: NDArray[np.float64],
    index: SearchIndex,
    settings: FindSettings,
    ignore: Collection[int] = (),
) -> Ranking:
    """Rank the clips of the index by similarity to the first segment of a query.

    Return at least `settings.n_matches` clips, if there are as many, or all. Weights are of
    the parts of the body, (5,).
    """
    candidates = collect_candidates(query, weights, index, settings, ignore)
    warped = candidates.segments[: len(candidates.summaries)]
    return rank_candidates(
        query, weights, candidates, settings, lambda: index.pairwise_distances(warped)
    )


def collect_candidates(
    query: Segments,
    weights: NDArray[np.float64],
    index: SearchIndex,
    settings: FindSettings,
    ignore: Collection[int] = (),
) -> Candidates:
    """Return the clips of the index that may be similar to the first segment of a query."""
    query_histogram = weight_histograms(query.histograms[:1], weights)[0]
    distances, segments = index.best_segments(1.0 - index.similarities(query_histogram), ignore)
    n_kept = max(settings.n_matches, settings.n_warped) if settings.n_matches else len(segments)
    kept = _smallest_indices(distances, n_kept)
    rows = segments[kept]
    return Candidates(
        index.clips[rows],
        index.frames[rows],
        distances[kept],
        rows,
        index.steps(rows[: settings.n_warped]),
        len(segments),
        index.n_segments,
    )


def merge_candidates(parts: Sequence[Candidates], settings: FindSettings) -> Candidates:
    """Return the candidates of several indexes with one vocabulary as those of one index.

    The number of a clip becomes its position among all clips of the parts.
    """
    distances = np.concatenate([part.distances for part in parts])
    order = np.argsort(distances, kind="stable")
    sizes = [len(part.clips) for part in parts]
    starts = np.cumsum([0, *(len(part.summaries) for part in parts)])
    rows = np.concatenate([
        start + np.arange(size) for start, size in zip(starts[:-1], sizes, strict=True)
    ])  # fmt: skip
    summaries = np.concatenate([part.summaries for part in parts])
    return Candidates(
        order,
        np.concatenate([part.frames for part in parts])[order],
        distances[order],
        np.concatenate([part.segments for part in parts])[order],
        summaries[rows[order[: settings.n_warped]]],
        sum(part.n_clips for part in parts),
        sum(part.n_segments for part in parts),
    )


def rank_candidates(
    query: Segments,
    weights: NDArray[np.float64],
    candidates: Candidates,
    settings: FindSettings,
    default_pairwise: Callable[[], Single | None],
) -> Ranking:
    """Rank candidates by time warping and their neighbors.

    Parameters
    ----------
    query : Segments
    weights : shape (5,)
    candidates : Candidates
    settings : FindSettings
    default_pairwise : callable
        Returns the distances between the compared segments with equal part weights, or None
        where those of the query serve.
    """
    n_warped = len(candidates.summaries)
    summary = query.summaries[:1].astype(np.float32)
    query_sequence = weight_summaries(weight_mean_posture(summary, settings.stance), weights)
    sequences = weight_summaries(
        weight_mean_posture(candidates.summaries, settings.stance), weights
    )
    costs = warping_costs(frame_distances(query_sequence, sequences))[0]
    scale = np.float32(2.0 / (1.0 + settings.warping))
    combined = scale * (candidates.distances[:n_warped] + np.float32(settings.warping) * costs)
    n_neighbors = min(settings.n_neighbors, candidates.n_clips // CLIPS_PER_NEIGHBOR)
    if 0 < n_neighbors < n_warped:
        pairwise = default_pairwise() if settings.compares_all_parts else None
        pairwise = pairwise_warping_costs(sequences) if pairwise is None else pairwise
        combined = rerank_by_neighbors(combined, pairwise, n_neighbors)
    order = np.argsort(combined, kind="stable")
    worst = np.float32(settings.warping) * costs.max(initial=0.0)
    rest = scale * (candidates.distances[n_warped:] + worst)
    order = np.concatenate([order, np.arange(n_warped, len(candidates.clips))])
    return Ranking(
        candidates.clips[order],
        candidates.frames[order],
        np.concatenate([combined, rest])[order],
    )


def weight_histograms(histograms: NDArray[np.uint8], weights: NDArray[np.float64]) -> Single:
    """Return histograms, (n, ...), as vectors with weighted parts, (n, n_bins).

    The product with the histogram of a segment is 1 for equal histograms, 0 for disjoint ones.
    """
    weighted = histograms.reshape(len(histograms), N_PARTS, -1).astype(np.float32)
    weighted *= weights.astype(np.float32)[:, None] / np.float32(
        HISTOGRAM_SCALE**2 * N_PARTS * N_CUBES
    )
    return weighted.reshape(len(histograms), -1)


def weight_summaries(summaries: Single, weights: NDArray[np.float64]) -> Single:
    """Return summaries, (n, 16, 5, 8), as vectors with weighted parts, (n, 16, 40)."""
    scaled = summaries * np.sqrt(weights).astype(np.float32)[:, None]
    return scaled.reshape(*scaled.shape[:2], N_PARTS * N_AXES)


def _smallest_indices(values: Single, n: int) -> Integers:
    """Return the indices of the smallest values in ascending order, first ones first."""
    if n >= len(values):
        return np.argsort(values, kind="stable")
    if not n:
        return np.zeros(0, dtype=np.intp)
    limit = np.partition(values, n - 1)[n - 1]
    below, equal = np.flatnonzero(values < limit), np.flatnonzero(values == limit)
    indices = np.sort(np.concatenate([below, equal[: n - len(below)]]))
    return indices[np.argsort(values[indices], kind="stable")]
