"""Rank clips by codeword histograms, then time warping, then neighbors."""

from collections.abc import Collection
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
"""Clips per neighbor in re-ranking: in a small library the nearest clips are not similar.
Chosen by hand: x0.5 costs 0.8 %, x2 costs nothing."""


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


def rank_clips(
    query: Segments,
    weights: NDArray[np.float64],
    index: SearchIndex,
    settings: FindSettings,
    ignore: Collection[int] = (),
) -> Ranking:
    """Rank the clips of the index by similarity to the first segment of a query.

    Return `settings.n_matches` clips, or all.
    """
    query_histogram = weight_histograms(query.histograms[:1], weights)[0]
    histogram_distances, segments = index.best_segments(
        1.0 - index.similarities(query_histogram), ignore
    )
    candidates = _smallest_indices(histogram_distances, settings.n_warped)
    summary = query.summaries[:1].astype(np.float32)
    query_sequence = weight_summaries(weight_mean_posture(summary, settings.stance), weights)
    sequences = weight_summaries(
        weight_mean_posture(index.steps(segments[candidates]), settings.stance), weights
    )
    costs = warping_costs(frame_distances(query_sequence, sequences))[0]
    scale = np.float32(2.0 / (1.0 + settings.warping))
    combined = scale * (histogram_distances[candidates] + np.float32(settings.warping) * costs)
    n_neighbors = min(settings.n_neighbors, len(segments) // CLIPS_PER_NEIGHBOR)
    if 0 < n_neighbors < len(candidates):
        pairwise = (
            index.pairwise_distances(segments[candidates])
            if settings.compares_all_parts
            else None
        )
        pairwise = pairwise_warping_costs(sequences) if pairwise is None else pairwise
        combined = rerank_by_neighbors(combined, pairwise, n_neighbors)
    order = np.argsort(combined, kind="stable")
    ranked, distances = candidates[order], combined[order]
    if not 0 < settings.n_matches <= len(ranked):
        worst = np.float32(settings.warping) * costs.max(initial=0.0)
        is_rest = np.ones(len(segments), dtype=np.bool_)
        is_rest[candidates] = False
        rest = np.flatnonzero(is_rest)
        rest = rest[np.argsort(histogram_distances[rest], kind="stable")]
        ranked = np.concatenate([ranked, rest])
        distances = np.concatenate([distances, scale * (histogram_distances[rest] + worst)])
    segments = segments[ranked]
    return Ranking(index.clips[segments], index.frames[segments], distances)


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
    """Return the indices of the smallest values in ascending order."""
    if n >= len(values):
        return np.argsort(values, kind="stable")
    indices = np.sort(np.argpartition(values, n)[:n])
    return indices[np.argsort(values[indices], kind="stable")]
