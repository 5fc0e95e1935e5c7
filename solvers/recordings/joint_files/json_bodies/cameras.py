"""Tell the frames of several cameras, or people, apart by the numbers in their keys."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, groupby, islice
from math import isfinite
from pathlib import Path
from typing import Any

from ...containers import JsonMember
from ...conventions import FRAME_KEY, IMAGE
from ...point_bodies import read_time
from .takes import has_people, take_of

NUMBER = re.compile(r"\d+(?:\.\d+)?")
WORD_OF_FRAME = re.compile(r"(?i)(?<![a-z])(?:frame|image|img|f|t)[\s_\-]*$")
ENDING = re.compile(rf"(?i)(?:{IMAGE})?\s*$")
SIGNS = " /\\_-."


def with_cameras(members: Iterable[JsonMember], path: Path | str) -> Iterator[JsonMember]:
    """Yield members, those whose keys name a camera and a frame as one for each camera.

    Such a key is `frame_12_cam_0`; the value of what is yielded has frames by their numbers.
    """
    several: dict[str, JsonMember] = {}
    for key, group in groupby(members, lambda member: member.key):
        rest = iter(group)
        begin = [*islice(rest, 2)]
        if len(begin) == 1 and _may_be_of_camera(begin[0], path):
            several[key] = begin[0]
        else:
            yield from chain(begin, rest)
    cameras = by_camera({key: member.value for key, member in several.items()})
    if len(cameras) < 2:
        yield from several.values()
    else:
        yield from (JsonMember(camera, frames, 1.0) for camera, frames in cameras.items())


def _may_be_of_camera(member: JsonMember, path: Path | str) -> bool:
    """Return whether a member with several numbers in its key is a frame."""
    key, value = member.key, member.value
    is_numbered = len(NUMBER.findall(key)) > 1 and not FRAME_KEY.fullmatch(key)
    is_time = isfinite(read_time(key, None)[0])
    return is_numbered and not is_time and has_people(value) and not take_of(value, path)


def by_camera(numbered: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return frames by their numbers, for each camera or person that their keys name.

    The number of the frame is the one with the most values; the rest of the key is what it is a
    frame of. Of each there are more frames than cameras. Other keys are those of one, without
    a name; of pictures, the last number is that of the frame in any case.
    """
    keys = [FRAME_KEY.fullmatch(key) for key in numbered]
    if len({float(key[1]) for key in keys if key}) == len(keys):
        return {"": dict(numbered)}
    numbers = [[*NUMBER.finditer(key)] for key in numbered]
    if len({*map(len, numbers)}) > 1:
        numbers = [found[-1:] for found in numbers]
    columns = [*zip(*numbers, strict=True)]
    if not columns:
        return {"": dict(numbered)}
    n_values, at = max((len({found[0] for found in each}), k) for k, each in enumerate(columns))
    groups = _grouped(columns[at], numbered)
    if sum(map(len, groups.values())) == len(numbered) and len(groups) < n_values:
        return groups
    return _grouped(columns[-1], numbered) if all(keys) else {"": dict(numbered)}


def _grouped(
    numbers: Sequence[re.Match[str]], values: Mapping[str, Any]
) -> dict[str, dict[str, Any]]:
    """Return values by a number in their keys, for each rest of these."""
    groups: dict[str, dict[str, Any]] = {}
    for number, value in zip(numbers, values.values(), strict=True):
        groups.setdefault(_name(number), {})[number[0]] = value
    return groups


def _name(number: re.Match[str]) -> str:
    """Return a key without the number of the frame."""
    before = WORD_OF_FRAME.sub("", number.string[: number.start()]).rstrip(SIGNS)
    after = ENDING.sub("", number.string[number.end() :]).strip(SIGNS)
    return "_".join(filter(None, (before.lstrip(SIGNS), after)))
