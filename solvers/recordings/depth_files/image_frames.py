"""Assign the images of a folder to frames, by the numbers in names or by time stamps."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..conventions import ConstantRate
from .images import NO_IMAGE

MAX_LENGTH_RATIO = 4
"""Number of frames per image from which numbers in names do not count frames. It guards folders
of images from several takes (`test_distant_numbers_are_no_gap`)."""
MAX_TIME_OFFSET_S = 0.02
"""Maximum offset in seconds of color from depth. By definition of the scripts of the TUM data
set."""


class Frames(NamedTuple):
    """Index of the image of each frame, -1 for none, and the frame rate in hertz."""

    images: NDArray[np.intp]
    frame_rate: float


def sort_naturally(names: Sequence[str]) -> list[str]:
    """Sort names with 9 before 10."""
    return sorted(
        names,
        key=lambda name: [
            (0, int(part), "") if part.isdecimal() else (1, 0, part)
            for part in re.split(r"(\d+)", name)
            if part
        ],
    )


def frames_by_number(names: Sequence[str], frame_rate: float) -> Frames:
    """Assign images to frames by the numbers in their names.

    Numbers may start anywhere and have equal steps; a skipped number is a frame without an
    image. Images with other names are consecutive frames.
    """
    stems = [Path(name).stem for name in names]
    indices = np.arange(len(names))
    matches = [re.search(r"(\d{1,9})$", stem) for stem in stems]
    prefixes = {
        stem[: match.start()] for stem, match in zip(stems, matches, strict=True) if match
    }
    if len(names) < 3 or None in matches or len(prefixes) > 1 or "." in "".join(stems):
        return Frames(indices, frame_rate)
    numbers = np.array([int(match[1]) for match in matches if match])
    steps = np.diff(numbers)
    step = int(np.median(steps))
    positions = (numbers - numbers[0]) // max(step, 1)
    regular = step > 0 and not (steps % max(step, 1)).any() and (steps > 0).all()
    if not regular or positions[-1] >= MAX_LENGTH_RATIO * len(names):
        return Frames(indices, frame_rate)
    images = np.full(positions[-1] + 1, NO_IMAGE)
    images[positions] = indices
    return Frames(images, frame_rate)


def frames_by_time(path: Path, times: NDArray[np.float64]) -> Frames:
    """Assign to each frame of a constant rate the nearest image, up to half a frame away.

    `times`, in seconds, has the shape (n_images,).

    Raises InvalidFileError if the time stamps are invalid.
    """
    resampler = ConstantRate(path, times)
    return Frames(resampler.nearest(), resampler.frame_rate)


def match_times(times: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the index of the nearest other time, in seconds, for each of (n,); -1 for none."""
    if not len(others):
        return np.full(len(times), NO_IMAGE)
    order = np.argsort(others)
    after = np.clip(np.searchsorted(others[order], times), 1, max(len(others) - 1, 1))
    pair = order[np.stack([after - 1, np.minimum(after, len(others) - 1)])]
    distance = np.abs(others[pair] - times)
    nearest = np.take_along_axis(pair, distance.argmin(axis=0)[np.newaxis], axis=0)[0]
    return np.asarray(np.where(distance.min(axis=0) <= MAX_TIME_OFFSET_S, nearest, NO_IMAGE))
