"""Put the members of a JSON file in frames: those keyed by number, by joint or by person."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain, count, groupby, islice
from pathlib import Path
from typing import Any

from ...errors import InvalidFileError
from ..containers import JsonMember, shown
from ..point_bodies import has_layout
from .body_json import name_of_body
from .joined_frames import missing_before
from .json_people import (
    IDENTITY_KEYS,
    NUMBERS_KEYS,
    PEOPLE_KEYS,
    POINT_KEYS,
    RATE_KEYS,
    START_KEYS,
    as_frame,
    have_identities,
    is_no_position,
    is_number,
    is_position,
    listed_numbers,
    listed_times,
    people_of_frame,
)
from .json_points import MIN_JOINTS

FRAME_KEY = re.compile(r"(?i)\s*(?:frame|f|t)?[\s_\-]*(\d+(?:\.\d+)?)\s*")
"""Key of a frame: its number, or its time in seconds."""
NAMES = ("name", "Name")
TIME = "time"
MAX_DEPTH = 6
"""Levels of members in which frames are looked for. It guards the depth of the recursion."""


class Take(dict[float, Any]):
    """Frames by their number or time."""

    rate: float | None = None
    """Frames per second; None where that is not stated next to the frames."""
    is_timed: bool = False
    """Whether times are stated next to the frames."""


def json_by_frame(members: Iterable[JsonMember], path: Path | str) -> Iterator[JsonMember]:
    """Yield the members of a file, those that are keyed otherwise as a list of frames.

    A file may be keyed by frame, as in `{"0": {"Hips": [x, y, z]}}`, by joint, as in
    `{"Hips": [[x, y, z], ...]}`, or by person, with one of these or a list of frames for each
    (`_take_of`), at the top or below one key. The key of what is yielded is the person's.

    Raises
    ------
    InvalidFileError
        Joints have different numbers of frames, people have different frame rates, or frames
        are left out for very long.
    """
    positions: dict[str, list[Any]] = {}
    numbered: dict[str, Any] = {}
    groups: list[tuple[str, dict[str, Take]]] = []
    yielded = set()
    for key, group in groupby(members, lambda member: member.key):
        first, rest = _with_nulls(group)
        value = first[-1].value
        if key and value is not None and is_position(value):
            yield from _without_positions(chain(first, rest), positions)
            continue
        if FRAME_KEY.fullmatch(key) and (isinstance(value, Mapping) or _has_people(value)):
            more = [member.value for member in rest]
            numbered[key] = [*(member.value for member in first), *more] if more else value
            continue
        first += islice(rest, max(len(_take_of(value, path)), 1))
        second = next(rest, None)
        if second is None and (found := _takes_of(first, path)):
            groups.append((key, found))
            continue
        yielded.add(key)
        yield from first
        if second is not None:
            yield second
        yield from rest
    groups.append(("", _people_of(numbered, path) or {"": _numbered(numbered)}))
    yield from _by_number("", _keyed(positions, path), 0.0, path)
    takes = _with_own_names(groups, yielded)
    yield from _rate_of(takes.values(), path)
    start = min((number for take in takes.values() for number in take), default=0.0)
    for name, take in takes.items():
        yield from _by_number(name, take, start, path)


def _with_own_names(
    groups: Iterable[tuple[str, dict[str, Take]]], others: Collection[str]
) -> dict[str, Take]:
    """Return the takes of all groups; names that are there already follow that of the group."""
    takes: dict[str, Take] = {}
    for key, found in groups:
        for name, take in found.items():
            names = chain((name, f"{key} {name}"), (f"{name} {k}" for k in count(2)))
            takes[next(each for each in names if each not in takes and each not in others)] = (
                take
            )
    return takes


def _rate_of(takes: Collection[Take], path: Path | str) -> Iterator[JsonMember]:
    """Yield the rate that is stated next to frames, if there is one.

    Raises InvalidFileError if people have different rates, or only some of them have times.
    """
    rates = sorted({take.rate for take in takes if take.rate is not None})
    if len(rates) > 1 or len({take.is_timed for take in takes if take}) > 1:
        raise InvalidFileError(
            f"{path} has people at different frame rates, or with and without times. Export it"
            " with one frame rate for all."
        )
    yield from (JsonMember(RATE_KEYS[0], rate, 1.0) for rate in rates)


def _without_positions(
    members: Iterable[JsonMember], positions: dict[str, list[Any]]
) -> Iterator[JsonMember]:
    """Add the positions of joints to those by their key, and yield all else."""
    for member in members:
        if is_position(member.value):
            positions.setdefault(member.key, []).append(member.value)
        else:
            yield member


def _with_nulls(group: Iterator[JsonMember]) -> tuple[list[JsonMember], Iterator[JsonMember]]:
    """Return the members up to the first one that is not null or empty, and all others."""
    first = []
    for member in group:
        first.append(member)
        if member.value not in (None, [], {}):
            break
    return first, group


def _takes_of(members: list[JsonMember], path: Path | str) -> dict[str, Take]:
    """Return the take of each person in a member, or in the elements of a list."""
    key, value = members[0].key, members[0].value
    if len(members) > 1 or not key:
        names = [
            name_of_body(each.value, (*NAMES, *IDENTITY_KEYS), count)
            if isinstance(each.value, Mapping)
            else str(count)
            for count, each in enumerate(members)
        ]
        values = {name: each.value for name, each in zip(names, members, strict=True)}
        is_named = len(values) == len(members)
        numbered = {str(count): each.value for count, each in enumerate(members)}
        found = _people_of(numbered, path)
        return {names[int(k)] if is_named else k: take for k, take in found.items()}
    if not isinstance(value, Mapping):
        return {}
    people = _people_of(value, path)
    if len(people) > 1:
        return _with_rate(people, value)
    take = Take() if key in PEOPLE_KEYS and not people else _take_of(value, path)
    return {key: take} if take else {}


def _people_of(values: Mapping[str, Any], path: Path | str) -> dict[str, Take]:
    """Return the take of each person among values; none if these are frames or joints.

    Of numbered ones, more are frames: no one records more people than frames.
    """
    kept = {key: value for key, value in values.items() if not is_no_position(key)}
    found = {key: take for key, value in kept.items() if (take := _take_of(value, path))}
    is_numbered = all(map(FRAME_KEY.fullmatch, values))
    n_frames = max(map(len, found.values()), default=0)
    if not found.keys().isdisjoint(POINT_KEYS) or (is_numbered and len(values) >= n_frames):
        return {}
    return found


def _with_rate(takes: dict[str, Take], value: Mapping[str, Any]) -> dict[str, Take]:
    """Return takes with the rate that a value states next to them."""
    stated = (float(value[key]) for key in RATE_KEYS if is_number(value.get(key)))
    rate = next(stated, None)
    for take in takes.values():
        take.rate = rate if take.rate is None else take.rate
    return takes


def _take_of(value: Any, path: Path | str, depth: int = MAX_DEPTH) -> Take:
    """Return the frames of a value; empty if it is a frame, or something else.

    It is a list of frames, is keyed by their numbers or by joint, or has one such member.
    """
    if not depth:
        return Take()
    if isinstance(value, list):
        frames = [each for each in value if each is not None]
        is_take = len(frames) > 1 and _has_people(frames[0]) and not have_identities(frames)
        return Take((float(k), each) for k, each in enumerate(value if is_take else ()))
    if not isinstance(value, Mapping):
        return Take()
    if keyed := _keyed(value, path):
        return _stamped(keyed, value)
    inner = {key: value[key] for key in POINT_KEYS if key in value}
    others = {*PEOPLE_KEYS, *filter(is_no_position, value)}
    inner = inner or {key: each for key, each in value.items() if key not in others}
    takes = [take for each in inner.values() if (take := _take_of(each, path, depth - 1))]
    return _stamped(takes[0], value) if len(takes) == 1 else Take()


def _keyed(values: Mapping[str, Any], path: Path | str) -> Take:
    """Return the frames of what is keyed by number or by joint; empty for all else."""
    is_numbered = len(values) > 1 and all(map(FRAME_KEY.fullmatch, values))
    n_joints = sum(_path(each) is not None for each in values.values())
    by_joint = _by_joint(values, path) if n_joints >= MIN_JOINTS else Take()
    if is_numbered and not (has_layout(n_joints) and not has_layout(len(by_joint))):
        return _numbered(values) if any(map(_has_people, values.values())) else Take()
    return by_joint


def _stamped(take: Take, value: Mapping[str, Any]) -> Take:
    """Return a take with the numbers, the times and the rate that a value states next to it."""
    numbers = listed_numbers(value, NUMBERS_KEYS, len(take))
    start = next((value[key] for key in START_KEYS if is_number(value.get(key))), 0)
    if not numbers and min(take) == 0.0 and float(start).is_integer():
        numbers = [float(start) + number for number in take]
    frames = [*take.values()]
    key = listed_times(value, len(take))
    if key:
        frames = [
            {key: time, **as_frame(frame)}
            for time, frame in zip(value[key], frames, strict=True)
        ]
    is_unique = len({*numbers}) == len(take)
    stamped = Take(zip(numbers if is_unique else take, frames, strict=True))
    stamped.rate, stamped.is_timed = take.rate, take.is_timed or bool(key)
    return _with_rate({"": stamped}, value)[""]


def _has_people(frame: Any) -> bool:
    return any(True for _ in people_of_frame(frame))


def _path(value: Any) -> list[Any] | None:
    """Return the positions of a joint in all frames; None for other values."""
    if isinstance(value, Mapping) and all(isinstance(value.get(axis), list) for axis in "xyz"):
        axes = [value[axis] for axis in "xyz"]
        return [list(position) for position in zip(*axes, strict=False)]
    if not isinstance(value, list) or is_position(value) or not all(map(is_position, value)):
        return None
    return value if any(value) else None


def _by_joint(values: Mapping[str, Any], path: Path | str) -> Take:
    """Return the frames of what is keyed by joint.

    Joints with numbers instead of names become lists of points.
    """
    paths = {key: found for key, value in values.items() if (found := _path(value))}
    longest = max(map(len, paths.values()), default=0)
    paths = {key: found for key, found in paths.items() if len(found) > 1 or longest == 1}
    if len(paths) < MIN_JOINTS:
        return Take()
    lengths = sorted({len(found) for found in paths.values()})
    if len(lengths) > 1:
        short, full = (next(k for k, v in paths.items() if len(v) == n)
                       for n in (lengths[0], lengths[-1]))  # fmt: skip
        raise InvalidFileError(
            f"{path} has {lengths[0]} frames of {shown(short)}, but {lengths[-1]} of"
            f" {shown(full)}. Export it again, with null where a joint is missing."
        )
    is_numbered = len(values) > 1 and all(map(FRAME_KEY.fullmatch, values))
    frames = [
        {name: positions[frame] for name, positions in paths.items()}
        for frame in range(longest)
    ]
    return Take((float(k), [*f.values()] if is_numbered else f) for k, f in enumerate(frames))


def _numbered(values: Mapping[str, Any]) -> Take:
    """Return values by the numbers in their keys."""
    found = {name: FRAME_KEY.fullmatch(name) for name in values}
    return Take((float(match[1]), values[name]) for name, match in found.items() if match)


def _by_number(key: str, take: Take, start: float, path: Path | str) -> Iterator[JsonMember]:
    """Yield the frames of a take in order, None for those that are left out from a start."""
    ordered = sorted(take)
    if any(not number.is_integer() for number in ordered):
        for number in ordered:
            value = take[number]
            timed = {TIME: number, **value} if isinstance(value, Mapping) else value
            yield JsonMember(key, timed, 1.0)
        return
    for n_missing, number in zip(missing_before(ordered, start, path), ordered, strict=True):
        for _ in range(n_missing):
            yield JsonMember(key, None, 1.0)
        yield JsonMember(key, take[number], 1.0)
