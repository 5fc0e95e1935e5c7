"""Correct labels of swapped or misidentified markers."""

from dataclasses import dataclass

from ..arrays import Array
from ..motion import Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .distances import Distances, learn_distances
from .mistaken_labels import find_mistaken_labels
from .pair_swaps import PairSwap, find_candidate_pairs, most_likely_swap

MAX_SWAPS = 500
"""Maximum number of swaps that one pass corrects. It bounds the run time of takes whose labels
are random."""
N_PASSES = 3
"""Maximum number of passes; the distances of each are learned from the labels that the pass
before corrected. Half and twice are no better (`make sensitivity`)."""


@dataclass(frozen=True, kw_only=True)
class UnswapSettings(Settings):
    """Evidence that a swap needs."""

    evidence: float = setting(
        8.0, "Evidence needed to change a label; higher changes fewer labels",
        minimum=1.0, maximum=100.0,
    )  # fmt: skip


@dataclass(frozen=True)
class Swap:
    """Corrected labels of two markers."""

    names: tuple[str, str]
    """The swapped markers; for a marker with the label of a missing one, the wrong and the
    correct label."""
    frames: range


@dataclass(frozen=True, eq=False)
class Unswapped:
    """A take with corrected labels."""

    tracks: Tracks
    swaps: tuple[Swap, ...]
    """In order of their first frames."""


def unswap_markers(
    tracks: Tracks,
    *,
    settings: UnswapSettings = UnswapSettings(),
    progress: Progress = unwatched,
) -> Unswapped:
    """Find markers with swapped labels, and correct them.

    A swap has two kinds of evidence. Both markers jump to each other's position instead of
    moving smoothly. During the swap, their distances to neighboring markers are those of the
    other label, so that markers that only pass each other are not changed. The distances are
    learned from the take, whose labels must be correct most of the time. A marker that
    reappears with the label of a missing one is found by its distances alone.

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
    progress(0.0, "Finding swapped markers")
    for number in range(N_PASSES):
        distances = learn_distances(positions)
        found = _find_changes(positions, distances, settings)
        for change in found:
            _swap_labels(positions, change)
            if confidence is not None:
                _swap_labels(confidence, change)
            names = (tracks.names[change.first], tracks.names[change.second])
            swaps.append(Swap(names, range(change.start, change.stop)))
        progress((number + 1) / N_PASSES, "Finding swapped markers")
        if not found:
            break
    progress(1.0, "Finding swapped markers")
    corrected = Tracks(tracks.names, positions, tracks.frame_rate, confidence)
    return Unswapped(corrected, tuple(sorted(swaps, key=lambda swap: swap.frames.start)))


def _find_changes(
    positions: Array, distances: Distances, settings: UnswapSettings
) -> list[PairSwap]:
    """Return the changes in order of evidence, each found after applying those before it."""
    positions = positions.copy()
    changes: list[PairSwap] = []
    open_swaps = {
        pair: most_likely_swap(positions, pair, distances)
        for pair in find_candidate_pairs(positions, distances)
    }
    while len(changes) < MAX_SWAPS:
        significant = [
            swap for swap in open_swaps.values() if swap and swap.gain >= settings.evidence
        ]
        if not significant:
            break
        best = max(significant, key=lambda swap: swap.gain)
        _swap_labels(positions, best)
        changes.append(best)
        for pair in open_swaps:
            if {best.first, best.second} & set(pair):
                open_swaps[pair] = most_likely_swap(positions, pair, distances)
    for change in find_mistaken_labels(positions, distances):
        _swap_labels(positions, change)
        changes.append(change)
    return changes


def _swap_labels(values: Array, change: PairSwap) -> None:
    """Swap the values of two markers in a range of frames, in place."""
    frames = slice(change.start, change.stop)
    values[frames, [change.first, change.second]] = values[
        frames, [change.second, change.first]
    ]
