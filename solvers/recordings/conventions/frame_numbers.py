"""The numbers of frames: their step, and what it means for the rate."""

import re
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ...progress import Progress, Remark
from .time_stamps import DEFAULT_FRAME_RATE

IMAGE = r"\.(?:jpe?g|png)"
FRAME_KEY = re.compile(
    rf"(?i)\s*(?:(?:frame|f|t)?[\s_\-]*|.{{0,200}}\D(?=\d+{IMAGE}\s*$))"
    rf"(\d+(?:\.\d+)?)(?:{IMAGE})?\s*"
)
"""Key of a frame: its number, its time in seconds, or the file of its image."""
MAX_PEOPLE = 16
"""Number of people without names or identities in a frame, above which they are frames. It
guards frames that are called `body_0000` and so on; a stream has as many people."""
MAX_FRAME_STEP = 8.0
"""Typical step between whole numbers from which they are milliseconds. By definition of the
unit: a frame of 125 Hz lasts as long; files with every eighth frame are rare."""
MAX_FRAME_NUMBER = 1e8
"""Number of a frame from which it is a time of a clock. It guards seconds since 1970, 1.7e9;
frames of 240 Hz reach it after five days."""
MAX_ROUNDING = 1e-6
"""Difference of a ratio of numbers to a whole one. It bounds the rounding of numbers with
fractions."""
MS_PER_S = 1000.0
"""Milliseconds per second, by definition."""
MAX_MS_ROUNDING = 1.0
"""Milliseconds by which whole numbers of them miss a second, or large ones the duration of a
frame. By definition: rounding of one."""
MAX_UNSTATED_STEP = 4.0
"""Step between numbers without a stated rate, up to which they count frames. By definition of
the unit: 5 ms is a frame of 200 Hz."""


def step_between(numbers: Sequence[float]) -> float:
    """Return the smallest step between numbers in order; 0 if others are no multiples of it."""
    steps = [after - before for before, after in pairwise(numbers)]
    step = min(steps, default=1.0)
    errors = [abs(each / step - float(np.rint(each / step))) for each in steps]
    return step if all(error < MAX_ROUNDING for error in errors) else 0.0


def are_frame_numbers(numbers: Sequence[float]) -> bool:
    """Return whether numbers in order count frames; otherwise they are times in some unit.

    They are whole ones, each a multiple of the smallest step away from the next, and mostly few
    apart. Milliseconds have larger steps, which differ by rounding.
    """
    known = np.unique(numbers)
    if not np.isfinite(known).all() or (known % 1.0).any():
        return False
    if len(known) < 2:
        return True
    is_small = np.median(np.diff(known)) < MAX_FRAME_STEP and known[-1] < MAX_FRAME_NUMBER
    return bool(is_small) and step_between(known.tolist()) > 0.0


def rate_of_numbers(
    numbers: Sequence[float], rate: float | None, progress: Progress
) -> float | None:
    """Return the rate of frames if a file has only each second, third or so of them.

    Numbers are those of the video. Those that are a frame's duration apart are times, and its
    rate remains, as it does if all frames are there.

    Parameters
    ----------
    numbers : sequence of float
        Of the frames, in order.
    rate : float, Hz, or None
        None: it is not stated, and numbers in steps are those of the default rate.
    progress : Progress
    """
    step = step_between(numbers)
    if step <= 1.0 or (rate is None and not _is_plain_step(step, numbers)):
        return rate
    if rate is None:
        rate = DEFAULT_FRAME_RATE
        progress(0.8, Remark(f"The file has no times; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    if _is_duration(step, rate):
        return rate
    progress(
        0.8,
        Remark(f"Frames are numbered in steps of {step:g}; their rate is {rate / step:g} Hz"),
    )
    return rate / step


def _is_plain_step(step: float, numbers: Sequence[float]) -> bool:
    """Return whether numbers without a rate can be no times."""
    return step <= MAX_UNSTATED_STEP and are_frame_numbers(numbers)


def _is_duration(step: float, rate: float) -> bool:
    """Return whether a step is the duration of a frame in milliseconds or a smaller unit."""
    is_exact = abs(step * rate - MS_PER_S) <= MAX_MS_ROUNDING
    is_rounded = abs(step - MS_PER_S / rate) <= MAX_MS_ROUNDING
    return is_exact or step >= MS_PER_S or (step > MAX_FRAME_STEP and is_rounded)
