"""Query with every clip, and score the ranking of its class.

A method prepares a library, describes a query, and returns the distance of each clip of the
library. The clip of the query is never ranked (leave one out), or no clip of its actor (leave
one actor out). Methods that use the complete library get the clips that they may use.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from time import process_time
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .retrieval_clips import LabeledClip
from .retrieval_damage import Damage

TOP = 20
RECALLS = np.linspace(0.0, 1.0, 21)


class Prepared(Protocol):
    """A library that answers queries."""

    def describe(self, tracks: Tracks) -> Any:
        """Return what of a recording is compared."""

    def distances(self, query: Any, allowed: Flags) -> Array:
        """Return how far each clip is from the query, shape (n_clips,).

        Only those of `allowed` clips are looked at, and only they may be used.
        """


class Method(Protocol):
    """A method to find similar clips."""

    def prepare(self, clips: Sequence[Tracks]) -> Prepared:
        """Learn what is needed, and describe the clips. Labels are not given."""


class Query(NamedTuple):
    """A clip to look for, and the clips of the library that may answer."""

    clip: LabeledClip
    tracks: Tracks
    allowed: Flags


@dataclass(frozen=True, eq=False)
class Answer:
    """How one query was answered."""

    label: str
    precision: float
    """Average precision; its mean over queries is MAP."""
    true_positives: float
    """TP@20 [ZH14, 3.6.2]: of the first 20, or as many as there are, the part of its class."""
    curve: Array
    """Precision from each of `RECALLS` on at best."""
    found: dict[str, float]
    """Fractions of classes among as many first matches as the class has clips."""
    describe_ms: float
    search_ms: float


def queries(
    library: Sequence[LabeledClip],
    requested: Sequence[LabeledClip],
    damage: Damage,
    other_actors: bool = False,
) -> Iterator[Query]:
    """Return a query for each clip that has a relevant one to be found.

    Damage is the same for each method: its seed is the index of the clip.
    """
    labels = np.array([clip.label for clip in library])
    actors = np.array([clip.actor for clip in library])
    names = np.array([clip.name for clip in library])
    for index, clip in enumerate(requested):
        allowed = actors != clip.actor if other_actors else names != clip.name
        if (labels[allowed] == clip.label).any():
            tracks = damage(clip.tracks, np.random.default_rng(index))
            yield Query(clip, tracks, allowed)


def answer(
    prepared: Prepared, library: Sequence[LabeledClip], requested: Iterable[Query]
) -> list[Answer]:
    """Ask all queries."""
    labels = np.array([clip.label for clip in library])
    return [_answer(prepared, labels, query) for query in requested]


def _answer(prepared: Prepared, labels: NDArray[np.str_], query: Query) -> Answer:
    started = process_time()
    described = prepared.describe(query.tracks)
    between = process_time()
    distances = prepared.distances(described, query.allowed)
    ended = process_time()
    indices = np.flatnonzero(query.allowed)
    ranked = labels[indices[np.argsort(distances[indices], kind="stable")]]
    right = ranked == query.clip.label
    n_right = int(right.sum())
    precision = np.cumsum(right) / np.arange(1, len(right) + 1)
    recall = np.cumsum(right) / n_right
    curve = np.array([precision[recall >= level - 1e-9].max() for level in RECALLS])
    top = min(TOP, n_right)
    names, counts = np.unique(ranked[:n_right], return_counts=True)
    return Answer(
        query.clip.label,
        float(precision[right].mean()),
        float(right[:top].mean()),
        curve,
        dict(zip(names.tolist(), (counts / n_right).tolist(), strict=True)),
        1e3 * (between - started),
        1e3 * (ended - between),
    )


def mean_precision(answers: Sequence[Answer]) -> float:
    """MAP: the mean over queries."""
    return float(np.mean([each.precision for each in answers]))


def mean_true_positives(answers: Sequence[Answer]) -> float:
    """TP@20: the mean over queries."""
    return float(np.mean([each.true_positives for each in answers]))
