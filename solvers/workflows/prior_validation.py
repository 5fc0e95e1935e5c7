"""Validate on held-out frames whether an example prior fills the gaps of a take well."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Flags
from ..denoising import FilterBases, denoise
from ..motion import Motion
from ..progress import Progress, within
from ..rotations import angle_between
from ..signals import find_runs

MIN_GAP_S = 0.3
"""Minimum duration of a gap to validate, seconds; shorter ones are interpolated well. It bounds
the run time, see `test_no_validation_runs_without_a_long_gap_or_observed_samples`."""
MIN_HIDDEN_S = 0.2
"""Minimum duration of a held-out segment, seconds. It guards trials against gaps that a
straight line fills as well."""
MAX_HIDDEN_FRACTION = 0.6
"""Maximum fraction of an observed segment to hold out; the rest is the context. It guards short
takes, which would have no context."""
MAX_TRIALS = 2
"""Maximum number of segments to hold out. It bounds the run time: each is filled twice."""
CONTEXT_S = 4.0
"""Seconds of the take before and after the held-out segment of a trial. It bounds the run
time."""


@dataclass(frozen=True, eq=False)
class _Trial:
    """A window of a take with a held-out segment."""

    masked: Motion
    truth: Motion
    hidden_mask: Flags
    """Held-out samples, shape (n_frames, n_joints)."""


def prior_fills_gaps(recording: Motion, bases: FilterBases, progress: Progress) -> bool:
    """Return whether examples fill the longest gap of a take as well as the take itself does.

    The joints of that gap are held out where they are observed, for the same duration if
    possible, and filled with and without examples. The result is True without a long gap, and
    where the joints are never observed for long enough: `denoise` weights examples by all
    observed samples.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    trials = list(_trials(recording))
    errors = np.zeros(2)
    for number, trial in enumerate(trials):
        for variant, examples in enumerate((bases, None)):
            start = (2 * number + variant) / (2 * len(trials))
            step = within(progress, start, start + 0.5 / len(trials))
            errors[variant] += _error(trial, examples, step)
    return bool(errors[0] <= errors[1])


def _error(trial: _Trial, bases: FilterBases | None, progress: Progress) -> float:
    filled = denoise(trial.masked, bases, progress=progress).recording
    assert isinstance(filled, Motion)
    return float(
        angle_between(filled.rotations, trial.truth.rotations)[trial.hidden_mask].mean()
    )


def _trials(recording: Motion) -> Iterator[_Trial]:
    joints, length = _longest_gap(~recording.observed, MIN_GAP_S * recording.frame_rate)
    if not length:
        return
    observed = recording.observed[:, joints].all(axis=1)
    runs = sorted(find_runs(observed), key=lambda run: run[0] - run[1])
    context = round(CONTEXT_S * recording.frame_rate)
    for start, stop in runs[:MAX_TRIALS]:
        n_hidden = min(length, int(MAX_HIDDEN_FRACTION * (stop - start)))
        if n_hidden < MIN_HIDDEN_S * recording.frame_rate:
            continue
        first = start + (stop - start - n_hidden) // 2
        hidden_mask = np.zeros(recording.observed.shape, dtype=np.bool_)
        hidden_mask[first : first + n_hidden, joints] = True
        window = slice(max(first - context, 0), first + n_hidden + context)
        rotations = np.where(hidden_mask[..., None], np.nan, recording.rotations)
        masked = recording.with_poses(rotations).slice(window.start, window.stop)
        yield _Trial(masked, recording.slice(window.start, window.stop), hidden_mask[window])


def _longest_gap(missing: Flags, min_length: float) -> tuple[NDArray[np.intp], int]:
    """Return the joints of the longest gap and its length in frames; 0 if it is too short."""
    longest, middle = 0, 0
    for joint in np.flatnonzero(missing.any(axis=0) & ~missing.all(axis=0)):
        for start, stop in find_runs(missing[:, joint]):
            if stop - start > longest:
                longest, middle = stop - start, (start + stop) // 2
    if longest < min_length:
        return np.zeros(0, dtype=np.intp), 0
    return np.flatnonzero(missing[middle] & ~missing.all(axis=0)), longest
