"""Which picture of a folder each frame has: by the numbers in names, or by time stamps."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..conventions import ConstantRate
from .images import NONE

MAX_LENGTH_RATIO = 4
"""How many times as many frames as pictures are believed of the numbers in names."""
MAX_TIME_OFFSET_S = 0.02
"""Seconds that colour may be off depth, as in the scripts of TUM's set."""


class Frames(NamedTuple):
    """Which picture each frame has, -1 for none, and how many frames come in a second."""

    pictures: NDArray[np.intp]
    frame_rate: float


def sort_naturally(names: Sequence[str]) -> list[str]:
    """Return names so that 9 comes before 10."""
    return sorted(
        names,
        key=lambda name: [
            (0, int(part), "") if part.isdecimal() else (1, 0, part)
            for part in re.split(r"(\d+)", name)
            if part
        ],
    )


def frames_by_number(names: Sequence[str], frame_rate: float) -> Frames:
    """Give each picture the frame that its name tells, where names are numbers.

    They may begin anywhere and go in equal steps; a number that was left out is a frame without
    a picture. Other names are frames one after the other.
    """
    stems = [Path(name).stem for name in names]
    each = np.arange(len(names))
    found = [re.search(r"(\d{1,9})$", stem) for stem in stems]
    parts = {stem[: match.start()] for stem, match in zip(stems, found, strict=True) if match}
    if len(names) < 3 or None in found or len(parts) > 1 or "." in "".join(stems):
        return Frames(each, frame_rate)
    numbers = np.array([int(match[1]) for match in found if match])
    steps = np.diff(numbers)
    step = int(np.median(steps))
    places = (numbers - numbers[0]) // max(step, 1)
    regular = step > 0 and not (steps % max(step, 1)).any() and (steps > 0).all()
    if not regular or places[-1] >= MAX_LENGTH_RATIO * len(names):
        return Frames(each, frame_rate)
    pictures = np.full(places[-1] + 1, NONE)
    pictures[places] = each
    return Frames(pictures, frame_rate)


def frames_by_time(path: Path, times: NDArray[np.float64]) -> Frames:
    """Give each moment of a constant rate the picture nearest to it, up to half a frame away.

    Raises InvalidFileError where the time stamps make no sense.
    """
    clock = ConstantRate(path, times)
    return Frames(clock.nearest(), clock.frame_rate)


def match_times(times: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return which of the others comes with each time, -1 for none."""
    if not len(others):
        return np.full(len(times), NONE)
    order = np.argsort(others)
    after = np.clip(np.searchsorted(others[order], times), 1, max(len(others) - 1, 1))
    pair = order[np.stack([after - 1, np.minimum(after, len(others) - 1)])]
    apart = np.abs(others[pair] - times)
    nearest = np.take_along_axis(pair, apart.argmin(axis=0)[np.newaxis], axis=0)[0]
    return np.asarray(np.where(apart.min(axis=0) <= MAX_TIME_OFFSET_S, nearest, NONE))
