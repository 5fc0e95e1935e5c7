"""Find the frames in which two markers have each other's labels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..signals import find_runs
from .distances import Distances
from .rigid_transform import MARKER_NOISE_M

MAX_JUMP_EVIDENCE = 10.0
"""Maximum evidence of one jump as a log-odds weight. Half and twice are no better
(`make sensitivity`)."""
FORBIDDEN_COST = 1e9
"""Cost, a weight, of a swap where a pair moves smoothly. It guards pairs that never swap: any
cost above the evidence of a whole take does."""
SWITCH_COST = 3.0
"""Cost of each start and end of a swap, the logarithm of a probability. Half and twice are no
better (`make sensitivity`)."""
FRAME_WEIGHT = 0.3
"""Weight of the distances in a frame, since consecutive frames are correlated. Half and twice
are no better (`make sensitivity`)."""
STEP_PERCENTILE = 90.0
"""Typical step of a pair: this percentile of its relative steps, times `STEP_FACTOR`, plus the
noise of a marker. A low percentile limits the influence of swaps in short takes. Chosen by
hand; `make sensitivity` varies it."""
STEP_FACTOR = 2.0
"""Factor of that percentile. It guards hands that pass each other quickly in a slow take
(`test_fast_pass_of_two_markers_and_back_is_no_swap`)."""
MIN_BAD_MISFIT, MIN_BAD_FRAMES = 3.0, 5
"""Misfit above which a label is bad, and minimum number of frames with two bad labels. It
guards swaps that start in a gap, which would stay (`test_swap_between_gaps_is_corrected`)."""


class PairSwap(NamedTuple):
    """An interval in which two markers are swapped."""

    gain: float
    """Log-likelihood gain of the swap."""
    first: int
    second: int
    start: int
    stop: int


def find_candidate_pairs(positions: Array, distances: Distances) -> list[tuple[int, int]]:
    """Return the pairs of markers that may be swapped.

    Either they seem to jump to each other's position; or both labels are bad at one time and
    one marker has gaps in which a swap may start. `positions` has the shape (n_frames,
    n_markers, 3), meters.
    """
    n_markers = positions.shape[1]
    is_bad = _bad_frames(positions, distances)
    gaps = ~np.isfinite(positions).all(axis=(0, 2))
    found = [
        (first, second)
        for first in range(n_markers - 1)
        for second in range(first + 1, n_markers)
        if (gaps[first] or gaps[second])
        and (is_bad[:, first] & is_bad[:, second]).sum() >= MIN_BAD_FRAMES
    ]
    for first in range(n_markers - 1):
        relative = positions[:, first + 1 :] - positions[:, [first]]
        step_unchanged, step_swapped, typical = _steps(relative)
        is_bad_marker = (step_unchanged > typical) & (step_swapped < 0.5 * step_unchanged)
        found += [
            (first, first + 1 + int(other))
            for other in np.flatnonzero(is_bad_marker.any(axis=0))
        ]
    return sorted(set(found))


def _bad_frames(positions: Array, distances: Distances) -> NDArray[np.bool_]:
    """Return where the label of each marker is bad, shape (n_frames, n_markers)."""
    is_bad_marker = np.zeros(positions.shape[:2], dtype=bool)
    for marker in range(positions.shape[1]):
        neighbors = distances.neighbors(marker)
        if len(neighbors):
            misfit = distances.misfit(marker, positions[:, marker], positions, neighbors)
            is_bad_marker[:, marker] = np.nan_to_num(misfit) > MIN_BAD_MISFIT
    return is_bad_marker


def _steps(relative: Array) -> tuple[Array, Array, Array]:
    """Return the relative steps of two markers with unchanged and with swapped labels.

    Parameters
    ----------
    relative : shape (n_frames, n_pairs, 3), meters
        From the first marker to the second.

    Returns
    -------
    step_unchanged, step_swapped, typical : shape (n_frames, n_pairs), meters
        Steps into each frame from the last one with both markers, NaN without one; and the
        typical step over this time.
    """
    valid = np.isfinite(relative).all(axis=-1)
    frames = np.arange(len(relative))[:, None]
    last = np.maximum.accumulate(np.where(valid, frames, -1), axis=0)
    before = np.concatenate([np.full((1, valid.shape[1]), -1), last[:-1]])
    gap = frames - before
    reached = valid & (before >= 0)
    start = np.take_along_axis(relative, np.maximum(before, 0)[..., None], axis=0)
    step_unchanged = np.where(reached, np.linalg.norm(relative - start, axis=-1), np.nan)
    step_swapped = np.where(reached, np.linalg.norm(relative + start, axis=-1), np.nan)
    single = np.where(gap == 1, step_unchanged, np.nan)
    has_steps = np.isfinite(single).any(axis=0)
    typical = np.full(valid.shape[1], np.inf)
    if has_steps.any():
        typical[has_steps] = STEP_FACTOR * np.nanpercentile(
            single[:, has_steps], STEP_PERCENTILE, axis=0
        )
        typical[has_steps] += MARKER_NOISE_M
    return step_unchanged, step_swapped, typical * gap


def most_likely_swap(
    positions: Array, pair: tuple[int, int], distances: Distances
) -> PairSwap | None:
    """Return the most likely swap of two markers; None if there is none.

    The most likely sequence of labels, by the Viterbi algorithm. A jump is evidence for a
    change if the pair would not jump with swapped labels; in each frame, the distances to
    neighbors are evidence for one of the two labels. `positions` has the shape (n_frames,
    n_markers, 3), meters.
    """
    first, second = pair
    relative = (positions[:, second] - positions[:, first])[:, None]
    step_unchanged, step_swapped, typical = (part[:, 0] for part in _steps(relative))
    stay, change = (
        np.nan_to_num(0.5 * (step / typical) ** 2) for step in (step_unchanged, step_swapped)
    )
    smooth = (
        (stay <= MAX_JUMP_EVIDENCE)
        & ~(step_swapped <= step_unchanged)
        & np.isfinite(step_swapped)
    )
    change = np.where(smooth, FORBIDDEN_COST, np.minimum(change, MAX_JUMP_EVIDENCE))
    stay = np.minimum(stay, MAX_JUMP_EVIDENCE)
    swapped = FRAME_WEIGHT * _evidence(positions, pair, distances)
    labels = _viterbi(stay, change + SWITCH_COST, swapped)
    best: PairSwap | None = None
    for start, stop in find_runs(labels > 0):
        if not np.isfinite(positions[start:stop, pair]).all(axis=-1).any():
            continue
        gain = -float(swapped[start:stop].sum())
        for edge in (start, stop):
            if 0 < edge < len(labels):
                gain += float(stay[edge] - change[edge] - SWITCH_COST)
        if best is None or gain > best.gain:
            best = PairSwap(gain, first, second, start, stop)
    return best


def _evidence(positions: Array, pair: tuple[int, int], distances: Distances) -> Array:
    """Return the additional misfit of swapped labels, shape (n_frames,).

    Negative where swapped labels fit better; 0 where unknown.
    """
    first, second = pair
    total = np.zeros(len(positions))
    for own, other in ((first, second), (second, first)):
        neighbors = distances.neighbors(own, (other,))
        as_is = distances.misfit(own, positions[:, own], positions, neighbors)
        changed = distances.misfit(own, positions[:, other], positions, neighbors)
        total += np.nan_to_num(changed - as_is)
    return total


def _viterbi(stay: Array, change: Array, swapped: Array) -> NDArray[np.intp]:
    """Return the label sequence of least cost, 1 where swapped, shape (n_frames,)."""
    n_frames = len(stay)
    came = np.zeros((n_frames, 2), dtype=np.intp)
    plain, other = 0.0, float(swapped[0])
    for frame in range(1, n_frames):
        keep, swap = stay[frame], change[frame]
        came[frame] = (plain + keep > other + swap, other + keep <= plain + swap)
        plain, other = (
            min(plain + keep, other + swap),
            min(other + keep, plain + swap) + swapped[frame],
        )
    labels = np.zeros(n_frames, dtype=np.intp)
    labels[-1] = int(other < plain)
    for frame in range(n_frames - 1, 0, -1):
        labels[frame - 1] = came[frame, labels[frame]]
    return labels
