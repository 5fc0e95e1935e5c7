"""Find the frames of one take in a value of JSON: listed, or keyed by number or by joint."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ....errors import InvalidFileError
from ...containers import shown
from ...conventions import FRAME_KEY
from ...point_bodies import has_layout, key_of_root
from .people import (
    PEOPLE_KEYS,
    POINT_KEYS,
    as_frame,
    have_identities,
    is_no_position,
    is_position,
    people_of_frame,
)
from .points import MIN_JOINTS
from .stamps import (
    NUMBERS_KEYS,
    RATE_KEYS,
    START_KEYS,
    is_number,
    listed_numbers,
    listed_times,
    stated_rates,
)

MAX_DEPTH = 6
"""Levels of members in which frames are looked for. It guards the depth of the recursion."""


class Take(dict[float, Any]):
    """Frames by their number or time."""

    rate: float | None = None
    """Frames per second; None where that is not stated next to the frames."""
    is_timed: bool = False
    """Whether times are stated next to the frames."""


def take_of(value: Any, path: Path | str, depth: int = MAX_DEPTH) -> Take:
    """Return the frames of a value; empty if it is a frame, or something else.

    It is a list of frames, is keyed by their numbers or by joint, or has one such member.
    """
    if not depth:
        return Take()
    if isinstance(value, list):
        frames = [each for each in value if each is not None]
        is_take = len(frames) > 1 and has_people(frames[0]) and not have_identities(frames)
        return Take((float(k), each) for k, each in enumerate(value if is_take else ()))
    if not isinstance(value, Mapping):
        return Take()
    if keyed := keyed_take(value, path):
        return _stamped(keyed, value)
    inner = {key: value[key] for key in POINT_KEYS if key in value}
    others = {*PEOPLE_KEYS, *filter(is_no_position, value)}
    inner = inner or {key: each for key, each in value.items() if key not in others}
    takes = [take for each in inner.values() if (take := take_of(each, path, depth - 1))]
    return _stamped(takes[0], value) if len(takes) == 1 else Take()


def keyed_take(values: Mapping[str, Any], path: Path | str) -> Take:
    """Return the frames of what is keyed by number or by joint; empty for all else."""
    is_numbered = len(values) > 1 and all(map(FRAME_KEY.fullmatch, values))
    n_joints = sum(_path(each) is not None for each in values.values())
    by_joint = _by_joint(values, path) if n_joints >= MIN_JOINTS else Take()
    if is_numbered and not (has_layout(n_joints) and not has_layout(len(by_joint))):
        return numbered_take(values) if any(map(has_people, values.values())) else Take()
    return by_joint


def numbered_take(values: Mapping[str, Any]) -> Take:
    """Return values by the numbers in their keys."""
    found = {name: FRAME_KEY.fullmatch(name) for name in values}
    return Take((float(match[1]), values[name]) for name, match in found.items() if match)


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


def _path(value: Any) -> list[Any] | None:
    """Return the positions of a joint in all frames; None for other values."""
    if isinstance(value, Mapping) and all(isinstance(value.get(axis), list) for axis in "xyz"):
        axes = [value[axis] for axis in "xyz"]
        return [list(position) for position in zip(*axes, strict=False)]
    if not isinstance(value, list) or is_position(value) or not all(map(is_position, value)):
        return None
    return value if any(value) else None


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
    root = key_of_root(value)
    if root and _path(value[root]) and len(value[root]) == len(take):
        frames = [
            {root: position, **as_frame(frame)}
            for position, frame in zip(value[root], frames, strict=True)
        ]
    is_unique = len({*numbers}) == len(take)
    stamped = Take(zip(numbers if is_unique else take, frames, strict=True))
    stamped.rate, stamped.is_timed = take.rate, take.is_timed or bool(key)
    return with_rate({"": stamped}, value)[""]


def with_rate(takes: dict[str, Take], value: Mapping[str, Any]) -> dict[str, Take]:
    """Return takes with the rate that a value states next to them."""
    own = {key: value[key] for key in RATE_KEYS if key in value}
    stated = min(stated_rates(own), default=None)
    rate = None if stated is None else stated.rate
    for take in takes.values():
        take.rate = rate if take.rate is None else take.rate
    return takes


def has_people(frame: Any) -> bool:
    """Return whether a frame has the joints of a person."""
    return any(True for _ in people_of_frame(frame))
