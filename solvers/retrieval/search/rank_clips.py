"""The order of a library's clips for a query: words, then warping, then what is like each."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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

Single = NDArray[np.float32]
Numbers = NDArray[np.int64]

CLIPS_PER_NEIGHBOR = 20
"""Clips for each other clip that is asked as well: the eight nearest of nine are not alike."""


@dataclass(frozen=True, eq=False)
class Ranking:
    """Clips in the order of how like a query they are.

    Attributes
    ----------
    clips : int64, shape (n,)
        Their numbers, best first.
    frames : int32, shape (n, 2)
        Of each the span that is most like the query, at 20 Hz.
    distances : shape (n,)
        0 for the same motion; what has nothing in common is about 1.5 apart.
    """

    clips: Numbers
    frames: NDArray[np.int32]
    distances: Single


def rank_clips(
    query: Segments,
    weights: NDArray[np.float64],
    index: SearchIndex,
    settings: FindSettings,
    ignore: Collection[int] = (),
) -> Ranking:
    """Rank the clips of the index by the first span of a query.

    As many as are asked for, or all.
    """
    asked = weight_histograms(query.histograms[:1], weights)[0]
    apart, spans = index.best_spans(1.0 - index.common(asked), ignore)
    near = _smallest_indices(apart, settings.n_warped)
    asking = query.summaries[:1].astype(np.float32)
    course = weight_summaries(weight_mean_posture(asking, settings.stance), weights)
    courses = weight_summaries(
        weight_mean_posture(index.steps(spans[near]), settings.stance), weights
    )
    costs = warping_costs(frame_distances(course, courses))[0]
    share = np.float32(2.0 / (1.0 + settings.warping))
    likely = share * (apart[near] + np.float32(settings.warping) * costs)
    n_alike = min(settings.n_alike, len(spans) // CLIPS_PER_NEIGHBOR)
    if 0 < n_alike < len(near):
        among = index.between(spans[near]) if settings.asks_for_all else None
        among = pairwise_warping_costs(courses) if among is None else among
        likely = rerank_by_neighbors(likely, among, n_alike)
    order = np.argsort(likely, kind="stable")
    found, distances = near[order], likely[order]
    if not 0 < settings.n_matches <= len(found):
        worst = np.float32(settings.warping) * costs.max(initial=0.0)
        is_other = np.ones(len(spans), dtype=np.bool_)
        is_other[near] = False
        others = np.flatnonzero(is_other)
        others = others[np.argsort(apart[others], kind="stable")]
        found = np.concatenate([found, others])
        distances = np.concatenate([distances, share * (apart[others] + worst)])
    spans = spans[found]
    return Ranking(index.clips[spans], index.frames[spans], distances)


def weight_histograms(histograms: NDArray[np.uint8], weights: NDArray[np.float64]) -> Single:
    """Return histograms, (n, ...), as vectors with the parts weighted, (n, n_bins).

    Their product with those of a span is 1 for the same words, 0 for none in common.
    """
    parted = histograms.reshape(len(histograms), N_PARTS, -1).astype(np.float32)
    parted *= weights.astype(np.float32)[:, None] / np.float32(
        HISTOGRAM_SCALE**2 * N_PARTS * N_CUBES
    )
    return parted.reshape(len(histograms), -1)


def weight_summaries(summaries: Single, weights: NDArray[np.float64]) -> Single:
    """Return summaries, (n, 16, 5, 8), as vectors with the parts weighted, (n, 16, 40)."""
    scaled = summaries * np.sqrt(weights).astype(np.float32)[:, None]
    return scaled.reshape(*scaled.shape[:2], N_PARTS * N_AXES)


def _smallest_indices(values: Single, most: int) -> Numbers:
    """Return the places of so many of the least, in their order."""
    if most >= len(values):
        return np.argsort(values, kind="stable")
    places = np.sort(np.argpartition(values, most)[:most])
    return places[np.argsort(values[places], kind="stable")]
