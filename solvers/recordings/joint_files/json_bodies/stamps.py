"""Find the times, numbers and rates that frames of JSON state."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from ...containers import NUMBER
from ...point_bodies import read_time, time_name
from .points import either_case, members

NUMBER_KEYS = either_case("frame", "frame_id", "frame_number", "frame_index", "frame_idx",
                          "frameId", "frameNumber", "frameIndex")  # fmt: skip
"""Members with the number of a frame."""
HEADER_KEYS = either_case("header", "meta", "metadata")
"""Members with the time of a frame, as in messages of ROS."""
SAMPLING_KEYS = either_case("sample_rate", "sampleRate", "sampling_rate", "frequency", "rate")
"""Members with the rate, or with another one, such as that of sound or of detected frames."""
RATE_KEYS = (*either_case("fps", "frame_rate", "framerate", "frameRate", "frames_per_second",
                          "framesPerSecond", "video_fps", "videoFps"), "FPS",
             *SAMPLING_KEYS)  # fmt: skip
MAX_SAMPLING_HZ = 2000.0
"""Maximum rate in hertz of members that are not called one of frames. It guards sound, whose
rates start at 8 kHz; cameras of motion capture end at 2 kHz."""
MIN_SAMPLING_HZ = 1.0
"""Rate in hertz of the same members, up to which it is a ratio, such as a speed of playback or
the fraction of frames with a person. By definition the largest fraction."""
NUMBERS_KEYS = either_case("frame_ids", "frameIds", "frame_numbers", "frame_indices")
"""Members with the numbers of all frames of a person."""
START_KEYS = either_case("start_frame", "startFrame")
"""Members with the number of the first frame of a person."""
SECOND_KEYS = ("sec", "secs", "seconds")
NANOSECOND_KEYS = ("nanosec", "nsec", "nsecs", "nanos", "nanoseconds")
"""Members with the rest of a time in ROS and Protocol Buffers, next to its whole seconds."""
MAX_NUMBER = 1e300
"""Maximum number or time of a frame, or rate in hertz. It guards the conversion of whole
numbers, which JSON does not limit."""

MAX_RATE_DEPTH = 3
"""Levels of members in which a rate is looked for. It guards the depth of the recursion."""


def time_of_frame(frame: Mapping[str, Any]) -> tuple[float, float | None]:
    """Return the time of a frame and its seconds per unit; NaN and None if it states none."""
    return next(iter(stamps_of_frame(frame).values()), (np.nan, None))


def stamps_of_frame(frame: Mapping[str, Any]) -> dict[str, tuple[float, float | None]]:
    """Return all times that a frame states, and their seconds per unit, by their keys.

    Whole seconds with nanoseconds next to them come first, without a key or below one, then
    names that state the unit, then others. Times in a header count if the frame has none.
    """
    headers = [each for each in members(frame, HEADER_KEYS) if isinstance(each, Mapping)]
    found = (_stamps_of_mapping(each) for each in (frame, *headers))
    return next(filter(None, found), {})


def _stamps_of_mapping(frame: Mapping[str, Any]) -> dict[str, tuple[float, float | None]]:
    names = {key: name for key in frame if (name := time_name(str(key))) is not None}
    split = {"": _joined_seconds(frame)} | {
        key: _joined_seconds(frame[key]) for key in names if isinstance(frame[key], Mapping)
    }
    stamps: dict[str, tuple[float, float | None]] = {
        key: (time, 1.0) for key, time in split.items() if np.isfinite(time)
    }
    for key in sorted(names, key=lambda key: names[key].second is None):
        time, second = read_time(frame[key], names[key].second)
        if np.isfinite(time):
            stamps[key] = time, second
    return stamps


def _joined_seconds(value: Mapping[str, Any]) -> float:
    """Return a time of whole seconds and nanoseconds; NaN if one of them is missing."""
    parts = (next(members(value, keys), None) for keys in (SECOND_KEYS, NANOSECOND_KEYS))
    seconds, rest = (read_time(part, None)[0] for part in parts)
    return seconds + 1e-9 * rest


def is_number(value: Any) -> bool:
    """Return whether a value is a finite number that fits in a float."""
    is_real = isinstance(value, int | float) and not isinstance(value, bool)
    return is_real and abs(value) < MAX_NUMBER


def _rate_of(value: Any) -> float:
    """Return a rate in hertz, which may be a text; 0 for other values."""
    if isinstance(value, str) and NUMBER.fullmatch(value.strip().encode()):
        value = float(value.replace(",", "."))
    return float(value) if is_number(value) else 0.0


class StatedRate(NamedTuple):
    """Rate that a file states, in hertz; the smallest one is the best."""

    is_sampling: bool
    """Whether its name is one of `SAMPLING_KEYS`."""
    depth: int
    """Levels of members above it."""
    order: int
    """Index of its name among `RATE_KEYS`."""
    rate: float


def stated_rates(value: Any, depth: int = 0) -> Iterator[StatedRate]:
    """Yield the rates that the members of what is not a frame state, such as `metadata`."""
    if not isinstance(value, Mapping) or depth >= MAX_RATE_DEPTH:
        return
    for order, key in enumerate(RATE_KEYS):
        rate = _rate_of(value.get(key))
        is_sampling = key in SAMPLING_KEYS
        least, most = (MIN_SAMPLING_HZ, MAX_SAMPLING_HZ) if is_sampling else (0.0, MAX_NUMBER)
        if least < rate <= most:
            yield StatedRate(is_sampling, depth, order, rate)
    for inner in value.values():
        yield from stated_rates(inner, depth + 1)


def listed_numbers(value: Mapping[str, Any], keys: Iterable[str], n_frames: int) -> list[float]:
    """Return the numbers in a member, if there is another one for each frame."""
    listed = next((value[key] for key in keys if key in value), None)
    if not isinstance(listed, list) or not all(map(is_number, listed)):
        return []
    numbers = [float(number) for number in listed]
    return numbers if len(numbers) == len({*numbers}) == n_frames else []


def listed_times(value: Mapping[str, Any], n_frames: int) -> str:
    """Return the key of the times of all frames; empty if they have none."""
    for key, listed in value.items():
        if isinstance(listed, list) and len(listed) == n_frames and time_name(str(key)):
            times = {read_time(each, None)[0] for each in listed}
            if len(times) == n_frames and np.isfinite([*times]).all():
                return key
    return ""
