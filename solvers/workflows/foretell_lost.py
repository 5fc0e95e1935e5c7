"""Whether examples foretell what is lost of a take: tried where it was seen."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..denoising import FilterBases, denoise
from ..motion import Motion
from ..progress import Progress, within
from ..rotations import angle_between

Flags = NDArray[np.bool_]

LONG = 0.3
"""Seconds of a gap from which on what fills it is more than a bridge."""
LEAST = 0.2
"""Seconds that are hidden at least."""
PART = 0.6
"""Of the time in which joints were seen that may be hidden: the rest tells how they are."""
MOST_TRIALS = 2
AROUND = 4.0
"""Seconds of the take before and after what is hidden that a trial looks at."""


@dataclass(frozen=True, eq=False)
class _Trial:
    """A part of a take in which more was hidden than is lost."""

    hidden: Motion
    truth: Motion
    lost: Flags
    """What was hidden and is known, shape (n_frames, n_joints)."""


def foretell_lost(recording: Motion, bases: FilterBases, progress: Progress) -> bool:
    """Tell whether examples fill the longest gap of a take as well as the take itself does.

    The same joints are hidden where they were seen, for as long if that can be, and filled
    with and without examples. Without a long gap, or where the lost joints are never seen for
    long enough to try, the answer is yes: `denoise` weighs examples by all that was seen.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    trials = list(_trials(recording))
    errors = np.zeros(2)
    for number, trial in enumerate(trials):
        for way, examples in enumerate((bases, None)):
            place = (2 * number + way) / (2 * len(trials))
            step = within(progress, place, place + 0.5 / len(trials))
            errors[way] += _error(trial, examples, step)
    return bool(errors[0] <= errors[1])


def _error(trial: _Trial, bases: FilterBases | None, progress: Progress) -> float:
    filled = denoise(trial.hidden, bases, progress=progress).recording
    assert isinstance(filled, Motion)
    return float(angle_between(filled.rotations, trial.truth.rotations)[trial.lost].mean())


def _trials(recording: Motion) -> Iterator[_Trial]:
    joints, length = _longest_gap(~recording.observed, LONG * recording.frame_rate)
    if not length:
        return
    seen = recording.observed[:, joints].all(axis=1)
    runs = sorted(_runs(seen), key=lambda run: run[0] - run[1])
    around = round(AROUND * recording.frame_rate)
    for start, stop in runs[:MOST_TRIALS]:
        n_hidden = min(length, int(PART * (stop - start)))
        if n_hidden < LEAST * recording.frame_rate:
            continue
        first = start + (stop - start - n_hidden) // 2
        lost = np.zeros(recording.observed.shape, dtype=np.bool_)
        lost[first : first + n_hidden, joints] = True
        part = slice(max(first - around, 0), first + n_hidden + around)
        rotations = np.where(lost[..., None], np.nan, recording.rotations)
        hidden = recording.with_poses(rotations).slice(part.start, part.stop)
        yield _Trial(hidden, recording.slice(part.start, part.stop), lost[part])


def _longest_gap(lost: Flags, at_least: float) -> tuple[NDArray[np.intp], int]:
    """Return the joints of the longest gap and its length; 0 if none is so long."""
    longest, middle = 0, 0
    for joint in np.flatnonzero(lost.any(axis=0) & ~lost.all(axis=0)):
        for start, stop in _runs(lost[:, joint]):
            if stop - start > longest:
                longest, middle = stop - start, (start + stop) // 2
    if longest < at_least:
        return np.zeros(0, dtype=np.intp), 0
    return np.flatnonzero(lost[middle] & ~lost.all(axis=0)), longest


def _runs(flags: Flags) -> list[tuple[int, int]]:
    """Return first frames and those after the last of where flags are set."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
