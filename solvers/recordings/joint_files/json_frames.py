"""Put the members of a JSON file in frames: those keyed by their number, or by joint."""

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, groupby, pairwise
from pathlib import Path
from typing import Any

from ...errors import InvalidFileError
from ..containers import JsonMember, shown
from ..point_bodies import has_layout
from .json_people import MIN_JOINTS, is_place

FRAME_KEY = re.compile(r"(?i)\s*(?:frame|f|t)?[\s_\-]*(\d+(?:\.\d+)?)\s*")
"""Key of a frame: its number, or its time in seconds."""
MAX_MISSING_FRAMES = 100_000
"""Missing numbers, frames, that a file may have. It bounds the memory of damaged files."""
TIME = "time"


def json_by_frame(members: Iterable[JsonMember], path: Path | str) -> Iterator[JsonMember]:
    """Yield the members of a file, those that are keyed otherwise as a list of frames.

    A file may be keyed by frame, as in `{"0": {"Hips": [x, y, z]}}`, or by joint, as in
    `{"Hips": [[x, y, z], ...]}`, at the top or below one key.

    Raises
    ------
    InvalidFileError
        Joints have different numbers of frames.
    """
    places: dict[str, list[Any]] = {}
    numbered: dict[str, Any] = {}
    for key, group in groupby(members, lambda member: member.key):
        first, rest = _with_nulls(group)
        value = first[-1].value
        if key and value is not None and is_place(value):
            for member in chain(first, rest):
                if is_place(member.value):
                    places.setdefault(key, []).append(member.value)
                else:
                    yield member
            continue
        if FRAME_KEY.fullmatch(key) and isinstance(value, Mapping):
            people = [member.value for member in rest]
            numbered[key] = [value, *people] if people else value
            continue
        second = next(rest, None)
        is_alone = len(first) == 1 and second is None
        if is_alone and isinstance(value, Mapping) and _is_keyed(value, bool(key)):
            yield from _regrouped(first[0], path)
            continue
        yield from first
        if second is not None:
            yield second
        yield from rest
    yield from _by_number("", numbered, 1.0, path)
    yield from _regrouped(JsonMember("", places, 1.0), path)


def _with_nulls(group: Iterator[JsonMember]) -> tuple[list[JsonMember], Iterator[JsonMember]]:
    """Return the members up to the first one that is not null, and all others."""
    first = []
    for member in group:
        first.append(member)
        if member.value is not None:
            break
    return first, group


def _is_keyed(values: Mapping[str, Any], may_be_numbered: bool) -> bool:
    """Return whether a mapping has a frame for each number, or a path for each joint.

    The numbers in an element of a list are those of people.
    """
    if len(values) > 1 and all(FRAME_KEY.fullmatch(key) for key in values):
        return may_be_numbered and all(
            isinstance(value, Mapping | list) for value in values.values()
        )
    return sum(_path(value) is not None for value in values.values()) >= MIN_JOINTS


def _path(value: Any) -> list[Any] | None:
    """Return the places of a joint in all frames; None for other values."""
    if isinstance(value, Mapping) and all(isinstance(value.get(axis), list) for axis in "xyz"):
        axes = [value[axis] for axis in "xyz"]
        return [list(place) for place in zip(*axes, strict=False)]
    if not isinstance(value, list) or is_place(value) or not all(map(is_place, value)):
        return None
    return value if any(value) else None


def _regrouped(member: JsonMember, path: Path | str) -> Iterator[JsonMember]:
    """Yield the frames of what is keyed by number or by joint."""
    values = member.value
    paths = {key: found for key, value in values.items() if (found := _path(value))}
    longest = max(map(len, paths.values()), default=0)
    paths = {key: found for key, found in paths.items() if len(found) > 1 or longest == 1}
    lengths = sorted({len(found) for found in paths.values()})
    is_numbered = len(values) > 1 and all(FRAME_KEY.fullmatch(key) for key in values)
    if is_numbered and not (has_layout(len(paths)) and not has_layout(lengths[-1])):
        yield from _by_number(member.key, values, member.done, path)
    elif len(paths) >= MIN_JOINTS:
        if len(lengths) > 1:
            short, full = (next(k for k, v in paths.items() if len(v) == n)
                           for n in (lengths[0], lengths[-1]))  # fmt: skip
            raise InvalidFileError(
                f"{path} has {lengths[0]} frames of {shown(short)}, but {lengths[-1]} of"
                f" {shown(full)}. Export it again, with null where a joint is missing."
            )
        for frame in range(lengths[-1]):
            joints = {name: places[frame] for name, places in paths.items()}
            value = [*joints.values()] if is_numbered else joints
            yield JsonMember(member.key, value, member.done)


def _by_number(
    key: str, values: Mapping[str, Any], done: float, path: Path | str
) -> Iterator[JsonMember]:
    """Yield values in the order of the numbers in their keys, None for missing numbers."""
    found = {name: FRAME_KEY.fullmatch(name) for name in values}
    numbers = {float(match[1]): values[name] for name, match in found.items() if match}
    ordered = sorted(numbers)
    if any(not number.is_integer() for number in ordered):
        for number in ordered:
            value = numbers[number]
            timed = {TIME: number, **value} if isinstance(value, Mapping) else value
            yield JsonMember(key, timed, done)
        return
    step = min((after - before for before, after in pairwise(ordered)), default=1.0)
    missing = [round((after - before) / step) - 1 for before, after in pairwise(ordered)]
    if sum(missing) > MAX_MISSING_FRAMES:
        raise InvalidFileError(
            f"{path} lacks {sum(missing)} frames between {ordered[0]:.0f} and"
            f" {ordered[-1]:.0f}. Number the frames without large gaps, and export it again."
        )
    for n_missing, number in zip([0, *missing], ordered, strict=False):
        for _ in range(n_missing):
            yield JsonMember(key, None, done)
        yield JsonMember(key, numbers[number], done)
