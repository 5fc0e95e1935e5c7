"""Judge the unit of times from their steps."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...progress import Progress, Remark

MAX_STEP_S = 1.0
"""Median step between frames, seconds, above which times without a unit are milliseconds. It
guards slow recordings in seconds; milliseconds of 1000 Hz are mistaken for them."""


class TimeUnit(NamedTuple):
    """A unit of times that do not state it."""

    max_step: float
    """Typical step between frames in this unit, above which it is the next one."""
    second: float
    """Seconds per unit."""
    remark: Remark


TIME_UNITS = (
    TimeUnit(
        2e3,
        1e-3,
        Remark("Times have no unit; by their steps they are interpreted as milliseconds"),
    ),
    TimeUnit(
        1e5,
        1e-6,
        Remark("Times have no unit; by their steps they are interpreted as microseconds"),
    ),
    TimeUnit(
        2e6,
        1e-7,
        Remark("Times have no unit; by their steps they are interpreted as ticks of 100 ns"),
    ),
    TimeUnit(
        np.inf,
        1e-9,
        Remark("Times have no unit; by their steps they are interpreted as nanoseconds"),
    ),
)
"""Units of clocks, with their seconds. Chosen by hand: the largest steps are 2 s in
milliseconds, 10 Hz in microseconds and 5 Hz in ticks of Windows, in which 30 Hz is 333333."""


def second_of_times(times: Array, progress: Progress) -> float:
    """Return the seconds per unit of times whose unit the file does not state.

    Parameters
    ----------
    times : shape (n_frames,); NaN where missing
    progress : Progress
        Is given a message where they are no seconds.
    """
    steps = np.diff(np.unique(times[np.isfinite(times)]))
    if not len(steps) or np.median(steps) <= MAX_STEP_S:
        return 1.0
    unit = next(each for each in TIME_UNITS if np.median(steps) <= each.max_step)
    progress(0.8, unit.remark)
    return unit.second
