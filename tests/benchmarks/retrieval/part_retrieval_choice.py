"""Which settings of pyramid matching are best on the training classes alone."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from solvers.motion import Tracks
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.published.dictionary import DictionarySettings
from solvers.retrieval.published.pyramid_matching import PyramidSettings

from ..shared.tables import table
from .pyramid_methods import BODY, PARTS, PyramidLibrary, Pyramids
from .retrieval_clips import training_library
from .retrieval_damage import DAMAGES
from .retrieval_protocol import Method, Query, answer, mean_precision, queries

KINDS = ("clean", "joints missing", "missing at random", "0.7x speed")
QUERY_STEP = 2
"""Clips from one query to the next."""
START = Pyramids(
    DictionarySettings(n_atoms=32, n_nonzeros=3),
    PyramidSettings(gap=0.1, normalize_cubes=True),
    frame_rate=30.0,
)
TRIED: tuple[dict[str, tuple[Any, ...]], ...] = (
    {"parts": (BODY, PARTS), "n_atoms": (16, 32, 64), "n_nonzeros": (1, 2, 3, 5)},
    {"gap": (0.033, 0.067, 0.1, 0.15), "n_levels": (1, 2, 3, 4)},
    {"normalize_cubes": (False, True), "cosine": (False, True), "centered": (False, True)},
    {"filled": (False, True), "n_atoms": (24, 32, 48)},
)
"""Settings that are chosen together; one set after the other, with the best of those before."""


class PostureQueries:
    """Damaged queries, described once."""

    def __init__(self) -> None:
        clips = training_library()
        self.tracks = [clip.tracks for clip in clips]
        self.query_sets: list[tuple[Tracks, list[Query]]] = []
        for name in KINDS:
            found = list(queries(clips, clips[::QUERY_STEP], DAMAGES[name], other_actors=True))
            self.query_sets.append((name, found))
        self.postures: dict[int, ClipPostures] = {}

    def score(self, method: Method) -> list[float]:
        """Return MAP of each kind of damage, with all clips of the actor left out."""
        prepared = method.prepare(self.tracks)
        cached = _CachedLibrary(prepared, self.postures)
        clips = training_library()
        return [mean_precision(answer(cached, clips, found)) for _, found in self.query_sets]


class _CachedLibrary:
    """The prepared library, with postures of queries cached from one method to the next."""

    def __init__(self, prepared: PyramidLibrary, postures: dict[int, ClipPostures]) -> None:
        self._prepared, self._postures = prepared, postures
        self.distances = prepared.distances

    def describe(self, tracks: Tracks) -> Any:
        method = self._prepared.method
        if id(tracks) not in self._postures:
            self._postures[id(tracks)] = clip_postures(tracks, method.frame_rate)
        return self._prepared.described(self._postures[id(tracks)])


def choose() -> tuple[Pyramids, str]:
    """Return the best settings, and a table of the best few of each step."""
    scorer, best = PostureQueries(), START
    tables = []
    for tried in TRIED:
        rows = []
        for method in _variants(best, tried):
            scores = scorer.score(method)
            rows.append((float(np.mean(scores)), scores, method))
            print(
                f"{rows[-1][0]:.4f}",
                *(f"{one:.3f}" for one in scores),
                _description(method),
                flush=True,
            )
        rows.sort(key=lambda row: -row[0])
        best = rows[0][2]
        tables.append(_table(rows[:5]))
    return best, "\n\n".join(tables)


def _variants(start: Pyramids, tried: dict[str, Sequence[Any]]) -> Iterator[Pyramids]:
    for values in product(*tried.values()):
        method = start
        for name, value in zip(tried, values, strict=True):
            method = changed(method, name, value)
        yield method


def changed(method: Pyramids, name: str, value: Any) -> Pyramids:
    """Return the method with one setting changed, of whichever part it is."""
    for part in ("dictionary", "pyramid"):
        settings = getattr(method, part)
        if hasattr(settings, name):
            return replace(method, **{part: replace(settings, **{name: value})})
    return replace(method, **{name: value})


def _description(method: Pyramids) -> str:
    atoms, pyramid = method.dictionary, method.pyramid
    return (
        f"{'parts, ' if method.parts == PARTS else ''}"
        f"{atoms.n_atoms} atoms, {atoms.n_nonzeros} non-zeros"
        f"{', centered' if atoms.centered else ''}, gap {pyramid.gap:.3f} s,"
        f" {pyramid.n_levels} levels{', cubes' if pyramid.normalize_cubes else ''}"
        f"{', cosine' if method.cosine else ''}{', filled' if method.filled else ''}"
    )


def _table(rows: Sequence[tuple[float, list[float], Pyramids]]) -> str:
    cells = {
        _description(method): [f"{mean:.3f}", *(f"{one:.3f}" for one in scores)]
        for mean, scores, method in rows
    }
    return table(["settings", "mean MAP", *KINDS], cells)
