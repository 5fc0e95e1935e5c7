"""Find times among named values, and estimate their unit from names and steps."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import lru_cache
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Array
from ...progress import Progress, Remark

MAX_STEP_S = 1.0
"""Median step between frames, seconds, above which times without a unit are milliseconds. It
guards slow recordings in seconds; milliseconds of 1000 Hz are mistaken for them."""


SECONDS = {
    "s": 1.0, "sec": 1.0, "second": 1.0, "sek": 1.0, "sekunden": 1.0,
    "ms": 1e-3, "msec": 1e-3, "milli": 1e-3, "millisecond": 1e-3, "millisekunden": 1e-3,
    "us": 1e-6, "\u00b5s": 1e-6, "\u03bcs": 1e-6, "usec": 1e-6, "micro": 1e-6,
    "microsecond": 1e-6,
    "ns": 1e-9, "nsec": 1e-9, "nano": 1e-9, "nanosecond": 1e-9,
}  # fmt: skip
"""Seconds per unit, by its name without the plural s. By definition of the units."""
WORD_OF_TIME = re.compile(
    r"(?i)(?:(?:unix|utc|system|capture|sensor|device|recording|relative)[\s_\-]*)?"
    r"(?:time[\s_\-]*stamps?|times?|zeit(?:stempel)?|temps|tiempo|tempo|時間|时间|時刻|elapsed"
    r"|offset(?=.)|pts(?=.)|ts?)"
    r"(?:[\s_\-]*(?:in\s)?[\s_\-]*[(\[]?\s*(?P<unit>[a-z\u00b5\u03bc]+)\s*[)\]]?)?"
)
MIN_UNIT_LETTERS = 3
"""Letters of a unit that names times by itself. It guards names of other values."""


class TimeName(NamedTuple):
    """What the name of times states."""

    second: float | None
    """Seconds per unit; None if it is not stated."""


@lru_cache(maxsize=4096)
def time_name(name: str) -> TimeName | None:
    """Return what a name such as `timestamp_us` or `Time (s)` states; None if not of times."""
    match = WORD_OF_TIME.fullmatch(name.strip())
    if match is None:
        alone = SECONDS.get(_singular(name)) if len(name) >= MIN_UNIT_LETTERS else None
        return None if alone is None else TimeName(alone)
    if match["unit"] is None:
        return TimeName(None)
    second = SECONDS.get(_singular(match["unit"]))
    return None if second is None else TimeName(second)


def _singular(unit: str) -> str:
    lower = unit.strip().lower()
    return lower if lower in SECONDS else lower.removesuffix("s")


def read_time(value: Any, second: float | None) -> tuple[float, float | None]:
    """Return a time and its seconds per unit; NaN for what is no time.

    A text may be a number, a date with a time of day as in ISO 8601, or a time of day.

    Parameters
    ----------
    value : number, str, or anything else
    second : as the name of the value states it
    """
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            return _seconds_of_date(value.strip(), second)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return np.nan, second
    try:
        time = float(value)
    except OverflowError:
        return np.nan, second
    return (time if isfinite(time) else np.nan), second


def _seconds_of_date(text: str, second: float | None) -> tuple[float, float | None]:
    """Return the seconds of a date, or of a time of day; NaN and `second` for other texts."""
    for text_of_date in (text, f"1970-01-01T{text}"):
        try:
            moment = datetime.fromisoformat(text_of_date)
        except ValueError:
            continue
        moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
        return moment.timestamp(), 1.0
    return np.nan, second


def column_of_times(titles: Sequence[str]) -> int | None:
    """Return the column of times, those with a unit first; None without one."""
    names = {column: name for column, title in enumerate(titles) if (name := time_name(title))}
    return min(names, key=lambda column: names[column].second is None, default=None)


class TimeCells:
    """Converts the cells of a column of times to numbers, those of dates too."""

    def __init__(self, name: TimeName) -> None:
        self.second = name.second
        """Seconds per unit, known after the last cell; None if nothing states it."""

    def __call__(self, cell: bytes) -> bytes:
        """Return the number of a cell; blank for what is no time."""
        time, self.second = read_time(cell.decode("latin-1").replace(",", "."), self.second)
        return repr(time).encode() if isfinite(time) else b""


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
