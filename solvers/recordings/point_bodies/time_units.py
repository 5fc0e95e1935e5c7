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
from ..containers import decode_text, is_missing

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
    r"(?i)(?:(?:unix|utc|system|capture|sensor|device|recording|relative|world|game|video|media)[\s_\-]*)?"
    r"(?:(?:time[\s_\-]*)?stamps?|times?|zeit(?:stempel)?|temps|tiempo|tempo|時間|时间|時刻|elapsed"
    r"|offset(?=.)|pts(?=.)|ts?)"
    r"(?:[\s_\-]*(?:in\s)?[\s_\-]*[(\[]?\s*(?P<unit>[a-z\u00b5\u03bc]+)\s*[)\]]?)?"
)
TIME_WITH_UNIT = re.compile(
    r"(?P<number>-?\d{1,20}(?:\.\d{0,20})?)"
    r"(?:/(?P<divisor>\d{1,9}(?:\.\d{0,9})?)|\s*(?P<unit>[a-z\u00b5\u03bc]{1,12}))"
)
"""A time with its unit, or a fraction of a second."""
TIMECODE = re.compile(r"\d:\d+:\d+[:;]\d")
"""Hours, minutes, seconds and the number of a frame, whose rate is not stated."""
DAY_S = 86400.0
"""Seconds of a day. By definition of the units."""
CLOCK_UNITS = frozenset({"hour", "minute", "min", "h"})
"""Titles, without the plural s, next to which seconds are those of a clock."""
MAX_LINES_BELOW = 10
"""Lines of words, such as of means, that may follow the frames. It guards damaged times."""
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
    """Return a time and its seconds per unit; NaN for what is not a time.

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
            return _seconds_of_text(value.strip(), second)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return np.nan, second
    try:
        time = float(value)
    except OverflowError:
        return np.nan, second
    return (time if isfinite(time) else np.nan), second


def _seconds_of_text(text: str, second: float | None) -> tuple[float, float | None]:
    """Return the seconds of a time such as `40 ms`, `1/25` or a date, as `read_time` does."""
    match = TIME_WITH_UNIT.fullmatch(text)
    if match is None:
        return _seconds_of_date(text, second)
    unit = SECONDS.get(_singular(match["unit"] or "s"))
    divisor = float(match["divisor"] or 1.0)
    if unit is None or not divisor:
        return np.nan, second
    return float(match["number"]) * unit / divisor, 1.0


def _seconds_of_date(text: str, second: float | None) -> tuple[float, float | None]:
    """Return the seconds of a date, or of a time of day; NaN and `second` for other texts."""
    if TIMECODE.search(text):
        return np.nan, second
    for text_of_date in (text, f"1970-01-01T{text}"):
        try:
            moment = datetime.fromisoformat(text_of_date)
        except ValueError:
            continue
        moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
        return moment.timestamp(), 1.0
    return np.nan, second


def column_of_times(titles: Sequence[str], cells: Sequence[Sequence[str]] = ()) -> int | None:
    """Return the column of times; None without one.

    Those that increase from frame to frame come first, then those that say more than a unit,
    and of these, those that state it. Units are not times next to an hour, or another unit.

    Parameters
    ----------
    titles : sequence of str
    cells : sequence of sequences of str
        Cells of some frames in order, if they are known.
    """
    names = {column: name for column, title in enumerate(titles) if (name := time_name(title))}
    units = {column for column in names if _singular(titles[column]) in SECONDS}
    is_clock = any(_singular(title) in CLOCK_UNITS for title in titles)
    if len(units) > 1 or is_clock:
        names = {column: name for column, name in names.items() if column not in units}
    return min(
        names,
        key=lambda column: (
            not is_increasing(column, cells),
            column in units,
            names[column].second is None,
        ),
        default=None,
    )


def is_increasing(column: int, cells: Sequence[Sequence[str]]) -> bool:
    """Return whether times never decrease, and increase in most frames."""
    times = np.array([read_time(row[column], None)[0] for row in cells if column < len(row)])
    steps = np.diff(times[np.isfinite(times)])
    return len(steps) > 0 and bool((steps >= 0.0).all() and np.mean(steps > 0.0) > 0.5)


def completed_times(times: Array, progress: Progress) -> Array | None:
    """Return times without gaps; None if fewer than two are known.

    Between known times they are interpolated, and the median step continues at the ends.

    Parameters
    ----------
    times : shape (n_frames,), seconds
    progress : Progress
        Is given a message if times are missing.
    """
    frames, known = np.arange(len(times)), np.flatnonzero(np.isfinite(times))
    if len(known) < 2:
        return None
    n_missing = len(times) - len(known)
    if not n_missing:
        return times
    progress(
        0.8, Remark(f"Frames without a time: {n_missing}; theirs follow from the other frames")
    )
    step = np.median(np.diff(times[known]) / np.diff(known))
    outside = np.minimum(frames - known[0], 0) + np.maximum(frames - known[-1], 0)
    return np.asarray(np.interp(frames, known, times[known]) + step * outside)


def over_midnight(seconds: Array) -> Array:
    """Return times of day, in seconds, that continue where a day ends.

    Parameters
    ----------
    seconds : shape (n_lines,), the first time first, less than half a day
        Other times are returned as they are.
    """
    known = seconds[np.isfinite(seconds)]
    if not len(known) or known.min() < 0.0 or known.max() >= DAY_S:
        return seconds
    return np.where(seconds < known[0] - DAY_S / 2.0, seconds + DAY_S, seconds)


class TimeCells:
    """Converts the cells of a column of times to numbers, those of dates too."""

    def __init__(self, name: TimeName) -> None:
        self.second = name.second
        """Seconds per unit, known after the last cell; None if nothing states it."""
        self._has_times = False
        self._n_blank = 0  # since the last time, before the first word
        self._words: list[bytes] = []

    def n_frames(self, times: Array) -> int:
        """Return the number of lines before those with words for times, such as `mean`.

        Parameters
        ----------
        times : shape (n_lines,), as read from all cells
        """
        if not self._words:
            return len(times)
        return int(np.flatnonzero(np.isfinite(times))[-1]) + 1 + self._n_blank

    def __call__(self, cell: bytes) -> bytes:
        """Return the number of a cell, blank if it has none.

        What is not a time is returned as it is, to be refused. So is a word where another time
        follows it, for the line of that time.
        """
        text = decode_text(cell).strip()
        if is_missing(cell):
            self._n_blank += not self._words
            return b""
        time, self.second = read_time(text.replace(",", "."), self.second)
        if isfinite(time) and not self._words:
            self._has_times, self._n_blank = True, 0
            return repr(time).encode()
        unreadable = cell.strip().replace(b" ", b"__")
        if isfinite(time):
            return self._words[0]
        self._words.append(unreadable)
        is_word = text.lstrip("#/ ")[:1].isalpha()
        is_below = is_word and self._has_times and len(self._words) <= MAX_LINES_BELOW
        return b"" if is_below else unreadable


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
"""Units of clocks, with their seconds by definition. The largest steps are chosen by hand: 2 s
in milliseconds, 10 Hz in microseconds and 5 Hz in ticks of Windows, in which 30 Hz is
333333."""


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
