"""Put the members of a JSON file in frames: those keyed by number, by joint or by person."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain, count, groupby, islice
from pathlib import Path
from typing import Any

from ....errors import InvalidFileError
from ...containers import JsonMember
from ...conventions import FRAME_KEY
from ...point_bodies import key_of_root
from .bodies import name_of_body
from .cameras import by_camera, with_cameras
from .joined_frames import missing_before
from .people import IDENTITY_KEYS, PEOPLE_KEYS, POINT_KEYS, is_no_position, is_position
from .stamps import RATE_KEYS
from .takes import Take, has_people, keyed_take, numbered_take, take_of, with_rate

NAMES = ("name", "Name")
TIME = "time"
ROOT = "path of the body"
"""Key of the member with the positions of the body in all frames, by their own key."""
NUMBERS = "numbers of the frames"
"""Key of the member with the numbers of all frames, in order."""


def json_by_frame(members: Iterable[JsonMember], path: Path | str) -> Iterator[JsonMember]:
    """Yield the members of a file, those that are keyed otherwise as a list of frames.

    A file may be keyed by frame, as in `{"0": {"Hips": [x, y, z]}}`, by joint, as in
    `{"Hips": [[x, y, z], ...]}`, or by person, with one of these or a list of frames for each
    (`take_of`), at the top or below one key. The key of what is yielded is the person's.

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
    for key, group in groupby(with_cameras(members, path), lambda member: member.key):
        first, rest = _with_nulls(group)
        value = first[-1].value
        if key and value is not None and is_position(value):
            yield from _without_positions(chain(first, rest), positions)
            continue
        if FRAME_KEY.fullmatch(key) and (isinstance(value, Mapping) or has_people(value)):
            more = [member.value for member in rest]
            numbered[key] = [*(member.value for member in first), *more] if more else value
            continue
        first += islice(rest, max(len(take_of(value, path)), 1))
        second = next(rest, None)
        if second is None and (found := _takes_of(first, path)):
            groups.append((key, found))
            continue
        yielded.add(key)
        yield from first
        if second is not None:
            yield second
        yield from rest
    for camera, frames in by_camera(numbered).items():
        groups.append(("", _people_of(frames, path) or {camera: numbered_take(frames)}))
    take = keyed_take(positions, path)
    groups.append(("", {"": take} if take else {}))
    yield from () if take else _path_of_body(positions)
    yield from _of_takes(_with_own_names(groups, yielded), path)


def _path_of_body(positions: Mapping[str, list[Any]]) -> Iterator[JsonMember]:
    """Yield where the body is in all frames, if that is among positions that are not joints."""
    if key := key_of_root(positions):
        yield JsonMember(ROOT, {key: positions[key]}, 1.0)


def _of_takes(takes: Mapping[str, Take], path: Path | str) -> Iterator[JsonMember]:
    """Yield the rate, the numbers and the frames of takes."""
    yield from _rate_of(takes.values(), path)
    numbers = sorted({*chain(*takes.values())})
    yield JsonMember(NUMBERS, numbers, 1.0)
    for name, take in takes.items():
        yield from _by_number(name, take, min(numbers, default=0.0), path)


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
        return with_rate(people, value)
    take = Take() if key in PEOPLE_KEYS and not people else take_of(value, path)
    return {key: take} if take else {}


def _people_of(values: Mapping[str, Any], path: Path | str) -> dict[str, Take]:
    """Return the take of each person among values; none if these are frames or joints.

    Of numbered ones, more are frames: no one records more people than frames.
    """
    kept = {key: value for key, value in values.items() if not is_no_position(key)}
    found = {key: take for key, value in kept.items() if (take := take_of(value, path))}
    is_numbered = all(map(FRAME_KEY.fullmatch, values))
    n_frames = max(map(len, found.values()), default=0)
    if not found.keys().isdisjoint(POINT_KEYS) or (is_numbered and len(values) >= n_frames):
        return {}
    return found


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
