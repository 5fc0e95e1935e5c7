"""Put right the labels of markers that were swapped or mistaken for others."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .distances import Distances, learn_distances
from .lost_labels import mistaken_runs
from .pair_swaps import PairSwap, candidates, most_likely_swap

Array = NDArray[np.float64]
MOST_SWAPS = 500
N_ROUNDS = 3


@dataclass(frozen=True, kw_only=True)
class UnswapSettings(Settings):
    """How sure a swap has to be."""

    evidence: float = setting(
        8.0, "Evidence needed to change a label; higher changes fewer labels",
        minimum=1.0, maximum=100.0,
    )  # fmt: skip


@dataclass(frozen=True)
class Swap:
    """Labels that were put right."""

    names: tuple[str, str]
    """The markers that had each other's labels; of one that was mistaken for another while that
    was lost, the label it had and the one it got."""
    frames: range


@dataclass(frozen=True, eq=False)
class Unswapped:
    """A take with its labels put right."""

    tracks: Tracks
    swaps: tuple[Swap, ...]
    """By their first frame."""


def unswap_markers(
    tracks: Tracks,
    *,
    settings: UnswapSettings = UnswapSettings(),
    progress: Progress = unwatched,
) -> Unswapped:
    """Find markers that exchange labels for a while, or to the end, and change them back.

    A swap shows twice. Both markers jump into each other's place, where they would else have
    gone on smoothly. And as long as it lasts, their distances to the markers that move along
    with them are those of the other label; so markers that only pass near each other are left
    alone. What is usual is learned from the take, whose labels must be right most of the time.
    A marker that comes back with the label of one that is lost meanwhile is found by its
    distances alone.

    Parameters
    ----------
    tracks : Tracks
    settings : UnswapSettings
    progress : Progress

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    positions = tracks.positions.copy()
    confidence = None if tracks.confidence is None else tracks.confidence.copy()
    swaps: list[Swap] = []
    progress(0.0, "Looking for swapped markers")
    for number in range(N_ROUNDS):
        distances = learn_distances(positions)
        found = _round(positions, distances, tracks.frame_rate, settings)
        for change in found:
            _exchange(positions, change)
            if confidence is not None:
                _exchange(confidence, change)
            names = (tracks.names[change.first], tracks.names[change.second])
            swaps.append(Swap(names, range(change.start, change.stop)))
        progress((number + 1) / N_ROUNDS, "Looking for swapped markers")
        if not found:
            break
    progress(1.0, "Looking for swapped markers")
    right = Tracks(tracks.names, positions, tracks.frame_rate, confidence)
    return Unswapped(right, tuple(sorted(swaps, key=lambda swap: swap.frames.start)))


def _round(
    positions: Array, distances: Distances, frame_rate: float, settings: UnswapSettings
) -> list[PairSwap]:
    """Return the changes to make, the surest first, each after those before it were made."""
    positions = positions.copy()
    made: list[PairSwap] = []
    open_swaps = {
        pair: most_likely_swap(positions, pair, distances, frame_rate)
        for pair in candidates(positions, distances, frame_rate)
    }
    while len(made) < MOST_SWAPS:
        sure = [one for one in open_swaps.values() if one and one.gain >= settings.evidence]
        if not sure:
            break
        best = max(sure, key=lambda one: one.gain)
        _exchange(positions, best)
        made.append(best)
        for pair in open_swaps:
            if {best.first, best.second} & set(pair):
                open_swaps[pair] = most_likely_swap(positions, pair, distances, frame_rate)
    for change in mistaken_runs(positions, distances):
        _exchange(positions, change)
        made.append(change)
    return made


def _exchange(values: Array, change: PairSwap) -> None:
    """Exchange two markers' values over a stretch, in place."""
    frames = slice(change.start, change.stop)
    values[frames, [change.first, change.second]] = values[
        frames, [change.second, change.first]
    ]
