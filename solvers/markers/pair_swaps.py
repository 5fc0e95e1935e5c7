"""Find the frames in which two markers have each other's labels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .distances import Distances

Array = NDArray[np.float64]
SURE, NEVER = 10.0, 1e9
"""The most that one jump counts, and a change of labels where a pair moves smoothly."""
SWITCH = 3.0
"""What each beginning and end of a swap costs."""
FRAME = 0.3
"""How much a frame's distances count: neighbouring frames tell nearly the same."""
USUAL_STEP, TIMES, STEP_FLOOR = 90.0, 2.0, 0.004
"""Percentile of a pair's relative steps, as often as which, and metres added, is usual; so low
that swaps themselves hardly change it even in short takes."""
ODD, FEWEST_ODD = 3.0, 5
"""Surprise from which on a marker does not fit, and frames in which two do not."""
LONGEST_GAP = 0.25
"""Seconds: beyond, nothing is known of where a marker comes back."""


class PairSwap(NamedTuple):
    """A stretch in which two markers are swapped."""

    gain: float
    """How much likelier it is so than not."""
    first: int
    second: int
    start: int
    stop: int


def candidates(
    positions: Array, distances: Distances, frame_rate: float
) -> list[tuple[int, int]]:
    """Return the pairs that may be swapped somewhere.

    They seem to jump into each other's place; or both do not fit their labels at one time, and
    one has gaps in which they may have changed places.
    """
    n_markers = positions.shape[1]
    odd_together = _odd_runs(positions, distances)
    gaps = ~np.isfinite(positions).all(axis=(0, 2))
    found = [
        (first, second)
        for first in range(n_markers - 1)
        for second in range(first + 1, n_markers)
        if (gaps[first] or gaps[second])
        and (odd_together[:, first] & odd_together[:, second]).sum() >= FEWEST_ODD
    ]
    for first in range(n_markers - 1):
        relative = positions[:, first + 1 :] - positions[:, [first]]
        kept, turned, usual = _steps(relative, frame_rate)
        odd = (kept > usual) & (turned < 0.5 * kept)
        found += [(first, first + 1 + int(other)) for other in np.flatnonzero(odd.any(axis=0))]
    return sorted(set(found))


def _odd_runs(positions: Array, distances: Distances) -> NDArray[np.bool_]:
    """Return where each marker does not fit its label, shape (n_frames, n_markers)."""
    odd = np.zeros(positions.shape[:2], dtype=bool)
    for marker in range(positions.shape[1]):
        near = distances.neighbours(marker)
        if len(near):
            surprise = distances.surprise(marker, positions[:, marker], positions, near)
            odd[:, marker] = np.nan_to_num(surprise) > ODD
    return odd


def _steps(relative: Array, frame_rate: float) -> tuple[Array, Array, Array]:
    """Return how far the second marker moves against the first, if labels stay or change.

    Parameters
    ----------
    relative : shape (n_frames, n_pairs, 3), metres
        From the first marker to the second.

    Returns
    -------
    kept, turned, usual : shape (n_frames, n_pairs), metres
        Steps into each frame from the last one in which both are seen, NaN where there is
        none; and the step that is usual over so long a time.
    """
    known = np.isfinite(relative).all(axis=-1)
    frames = np.arange(len(relative))[:, None]
    last = np.maximum.accumulate(np.where(known, frames, -1), axis=0)
    before = np.concatenate([np.full((1, known.shape[1]), -1), last[:-1]])
    gap = frames - before
    reached = known & (before >= 0) & (gap <= max(1.0, LONGEST_GAP * frame_rate))
    start = np.take_along_axis(relative, np.maximum(before, 0)[..., None], axis=0)
    kept = np.where(reached, np.linalg.norm(relative - start, axis=-1), np.nan)
    turned = np.where(reached, np.linalg.norm(relative + start, axis=-1), np.nan)
    single = np.where(gap == 1, kept, np.nan)
    some = np.isfinite(single).any(axis=0)
    usual = np.full(known.shape[1], np.inf)
    if some.any():
        usual[some] = TIMES * np.nanpercentile(single[:, some], USUAL_STEP, axis=0)
        usual[some] += STEP_FLOOR
    return kept, turned, usual * gap


def most_likely_swap(
    positions: Array, pair: tuple[int, int], distances: Distances, frame_rate: float
) -> PairSwap | None:
    """Return the stretch in which two markers are most surely swapped; None if there is none.

    The most likely course of labels, kept or changed, by Viterbi's algorithm: a jump speaks for
    a change where the pair would otherwise not jump, and the distances to markers that move
    along speak, frame by frame, for one of the two labels.
    """
    first, second = pair
    relative = (positions[:, second] - positions[:, first])[:, None]
    kept, turned, usual = (part[:, 0] for part in _steps(relative, frame_rate))
    stay, change = (np.nan_to_num(0.5 * (step / usual) ** 2) for step in (kept, turned))
    smooth = (stay <= SURE) & ~(turned <= kept) & np.isfinite(turned)
    change = np.where(smooth, NEVER, np.minimum(change, SURE))
    stay = np.minimum(stay, SURE)
    swapped = FRAME * _evidence(positions, pair, distances)
    course = _viterbi(stay, change + SWITCH, swapped)
    best: PairSwap | None = None
    edges = np.flatnonzero(np.diff(np.concatenate([[0], course, [0]])))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        if not np.isfinite(positions[start:stop, pair]).all(axis=-1).any():
            continue
        gain = -float(swapped[start:stop].sum())
        for edge in (start, stop):
            if 0 < edge < len(course):
                gain += float(stay[edge] - change[edge] - SWITCH)
        if best is None or gain > best.gain:
            best = PairSwap(gain, first, second, int(start), int(stop))
    return best


def _evidence(positions: Array, pair: tuple[int, int], distances: Distances) -> Array:
    """Return how much odder each frame's distances are with labels changed, shape (n_frames,).

    Negative where they fit better changed; 0 where nothing is known.
    """
    first, second = pair
    total = np.zeros(len(positions))
    for own, other in ((first, second), (second, first)):
        near = distances.neighbours(own, (other,))
        as_is = distances.surprise(own, positions[:, own], positions, near)
        changed = distances.surprise(own, positions[:, other], positions, near)
        total += np.nan_to_num(changed - as_is)
    return total


def _viterbi(stay: Array, change: Array, swapped: Array) -> NDArray[np.intp]:
    """Return the cheapest course, 1 where swapped, shape (n_frames,)."""
    n_frames = len(stay)
    came = np.zeros((n_frames, 2), dtype=np.intp)
    plain, other = 0.0, float(swapped[0])
    for frame in range(1, n_frames):
        keep, turn = stay[frame], change[frame]
        came[frame] = (plain + keep > other + turn, other + keep <= plain + turn)
        plain, other = (
            min(plain + keep, other + turn),
            min(other + keep, plain + turn) + swapped[frame],
        )
    course = np.zeros(n_frames, dtype=np.intp)
    course[-1] = int(other < plain)
    for frame in range(n_frames - 1, 0, -1):
        course[frame - 1] = came[frame, course[frame]]
    return course
