"""Join what a file of JSON holds of each person, or in each row, to the frames of a take."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, groupby, islice, pairwise
from math import isnan
from pathlib import Path
from typing import Any, NamedTuple

from ....errors import InvalidFileError
from ...containers import JsonMember
from ...conventions import MAX_PEOPLE, step_between
from ...point_bodies import is_other_array, rank_of_array, time_name
from .bodies import BodiesFrame, BodyJoints
from .people import PART, PEOPLE_KEYS, POINT_KEYS, has_word, is_no_position
from .stamps import NUMBER_KEYS

MAX_MISSING_FRAMES = 100_000
"""Missing numbers, frames, that a file may have. It bounds the memory of damaged files."""
WITHOUT_IDENTITY = frozenset(("0", "untracked 0"))
"""What people who are alone in a row are called if it does not say who they are."""
NAME_OF_PERSON = re.compile(
    r"(?i)\D*|\D*(person|people|body|actor|subject|track|player|human|user|skeleton|id)[\W_]*\d+"
)
"""Key of a member that is not a frame: it has no number, or that of a person."""
WORDS_OF_DATA = frozenset((
    "frames", "data", "pose", "poses", "tpose", "apose", "rest", "calibration", "reference",
    "raw", "original", "unfiltered", "filtered", "smooth", "smoothed", "clean", "cleaned",
    "interpolated", "predicted", "prediction", "predictions", "gt", "truth", "target",
    "world", "camera", "image", "local", "global", "keypoints", "joints", "positions",
    "points", "landmarks", "markers",
))  # fmt: skip
"""Words in the keys of data of one person, which a file may hold in several versions."""


class NumberedFrame(NamedTuple):
    """One element of a list, or what else a file holds of a frame."""

    number: float
    """The number of the frame that it states; NaN if it states none."""
    frame: BodiesFrame


def without_header(members: Iterable[JsonMember]) -> Iterator[JsonMember]:
    """Yield members without a header: a first value that has nothing in common with the second.

    A header has only texts and numbers, and neither a time nor the number of a frame.
    """
    rest = iter(members)
    begin = [*islice(rest, 2)]
    values = [member.value for member in begin]
    if len(begin) == 2 and begin[0].key == begin[1].key and _is_header(*values):
        begin = begin[1:]
    yield from chain(begin, rest)


def _is_header(first: Any, second: Any) -> bool:
    if not isinstance(first, Mapping) or not isinstance(second, Mapping) or not first:
        return False
    is_timed = any(key in NUMBER_KEYS or time_name(key) is not None for key in first)
    is_flat = all(isinstance(value, str | int | float) for value in first.values())
    return is_flat and not is_timed and first.keys().isdisjoint(second)


def frozen_clocks(stamps: Iterable[Mapping[str, tuple[float, Any]]]) -> set[str]:
    """Return the keys of times that are the same in all of several frames."""
    times: dict[str, set[float]] = {}
    frames = [*stamps]
    for each in frames:
        for key, (time, _) in each.items():
            times.setdefault(key, set()).add(time)
    return {key for key, found in times.items() if len(found) == 1 and len(frames) > 1}


def joined_frames(
    by_key: Mapping[str, list[NumberedFrame]], path: Path | str
) -> list[BodiesFrame]:
    """Return the frames of all people of a file.

    Members with frames each are people, unless they are called as data of one person
    (`WORDS_OF_DATA`): then the longest is taken, of those the best (`rank_of_array`). Those
    called as other quantities, such as rotations, are left out next to others. Of members with
    one frame each, those are the frames, or people. People of one frame may have a row each
    (`_by_stamp`); frames that are left out by their number are added without people.

    Raises InvalidFileError if very many frames are left out.
    """
    found = {
        key: _one_of_people(rows) if key.lower() in PEOPLE_KEYS else rows
        for key, rows in by_key.items()
        if any(row.frame.bodies for row in rows)
    }
    bodies = {key: rows for key, rows in found.items() if not has_word(key, PART.fullmatch)}
    found = bodies or found
    positions = {key: rows for key, rows in found.items() if not _is_quantity(key)}
    found = positions or found
    longest = min(
        found, key=lambda key: (-_n_observed(found[key]), rank_of_array(key)), default=""
    )
    if len(found.get(longest, ())) > 1:
        people = {
            key: rows for key, rows in found.items() if len(rows) > 1 and not _is_data(key)
        }
        if longest not in people or len(people) == 1:
            return _of_one(found[longest], path)
        return _of_several(people, path)
    n_numbered = sum(any(map(str.isdigit, key)) for key in found)
    if n_numbered <= MAX_PEOPLE and all(map(NAME_OF_PERSON.fullmatch, found)):
        return _of_several(found, path)
    return _of_one([row for rows in found.values() for row in rows], path)


def _is_quantity(key: str) -> bool:
    return is_no_position(key) or is_other_array(key)


def _is_data(key: str) -> bool:
    return key in POINT_KEYS or has_word(key, WORDS_OF_DATA.__contains__)


def _one_of_people(rows: list[NumberedFrame]) -> list[NumberedFrame]:
    """Return rows below a key for people as one frame, if each is a person without a time."""
    observed = [row for row in rows if row.frame.bodies]
    if len(observed) > MAX_PEOPLE or not all(
        len(row.frame.bodies) == 1 and isnan(row.number) and isnan(row.frame.time)
        for row in observed
    ):
        return rows
    return [observed[0]._replace(frame=_one_frame([row.frame for row in observed]))]


def _of_one(rows: list[NumberedFrame], path: Path | str) -> list[BodiesFrame]:
    """Return the frames of members that state who is in them."""
    return _by_stamp(rows, path) or [row.frame for row in rows]


def _of_several(
    people: Mapping[str, list[NumberedFrame]], path: Path | str
) -> list[BodiesFrame]:
    """Return the frames of members with the frames of a person each.

    Those that cannot be joined by what they state are joined by their place in the lists.
    """
    stated, placed = [], []
    for key, rows in people.items():
        is_alone = len({who for row in rows for who in row.frame.bodies}) == 1
        for index, row in enumerate(rows):
            names = {who: key if is_alone else f"{key} {who}" for who in row.frame.bodies}
            bodies = {names[who]: joints for who, joints in row.frame.bodies.items()}
            frame = row.frame._replace(bodies=bodies)
            stated.append(NumberedFrame(row.number, frame))
            placed.append(NumberedFrame(index, frame))
    return _by_stamp(stated, path) or _by_stamp(placed, path) or []


def missing_before(numbers: Sequence[float], start: float, path: Path | str) -> list[int]:
    """Return how many frames from a start are left out before each of the numbers, in order.

    None are between numbers without a common step, such as those of other frames, rounded.

    Raises InvalidFileError if they are very many.
    """
    if not numbers:
        return []
    step = step_between(numbers)
    mean = step or (numbers[-1] - numbers[0]) / (len(numbers) - 1)
    missing = [round((numbers[0] - start) / mean)]
    for before, after in pairwise(numbers):
        missing.append(round((after - before) / step) - 1 if step else 0)
    if sum(missing) > MAX_MISSING_FRAMES:
        raise InvalidFileError(
            f"{path} lacks {sum(missing):.10g} frames between {start:.10g} and"
            f" {numbers[-1]:.10g}. Number the frames without large gaps, and export it again."
        )
    return missing


def _n_observed(rows: Iterable[NumberedFrame]) -> int:
    return sum(bool(row.frame.bodies) for row in rows)


def _by_stamp(rows: list[NumberedFrame], path: Path | str) -> list[BodiesFrame] | None:
    """Return rows by their number or time, those with the same as one frame.

    None if some state neither, or if rows with the same share a person: these are frames of
    their own, whose numbers restart or whose times are rounded. Rows without identities are
    people of a frame if they are listed with their number (`_are_listed`).
    """
    numbers = _groups(rows, [row.number for row in rows])
    if _are_frames(numbers) or _are_listed(numbers, rows):
        ordered = sorted(numbers)
        is_joined = any(len(numbers[number]) > 1 for number in ordered)
        if is_joined or step_between(ordered):
            frames = [_one_frame(numbers[number]) for number in ordered]
            return _with_gaps(frames, ordered, path)
    times = _groups(rows, [row.frame.time for row in rows])
    if _are_frames(times) and any(len(group) > 1 for group in times.values()):
        return [_one_frame(times[t]) for t in sorted(times)]
    return None


def _groups(rows: list[NumberedFrame], stamps: list[float]) -> dict[float, list[BodiesFrame]]:
    """Return rows by their number or time, without empty ones that state none."""
    groups: dict[float, list[BodiesFrame]] = {}
    for stamp, row in zip(stamps, rows, strict=True):
        if row.frame.bodies or not isnan(stamp):
            groups.setdefault(stamp, []).append(row.frame)
    return groups


def _are_frames(groups: Mapping[float, list[BodiesFrame]]) -> bool:
    """Return whether all rows state when they are, and none with the same share a person."""
    return (
        bool(groups)
        and not any(map(isnan, groups))
        and all(
            len({who for row in group for who in row.bodies})
            == sum(len(row.bodies) for row in group)
            for group in groups.values()
        )
    )


def _are_listed(groups: Mapping[float, list[BodiesFrame]], rows: list[NumberedFrame]) -> bool:
    """Return whether people without identities have a row each, next to those of their frame.

    There are as many in all frames, and fewer people than frames.
    """
    sizes = {len(group) for group in groups.values()}
    runs = sum(1 for _ in groupby(row.number for row in rows))
    return (
        len(sizes) == 1
        and max(sizes) <= MAX_PEOPLE
        and max(sizes) < len(groups) == runs
        and not any(map(isnan, groups))
        and all(row.frame.bodies.keys() <= WITHOUT_IDENTITY for row in rows)
    )


def _with_gaps(
    frames: list[BodiesFrame], numbers: list[float], path: Path | str
) -> list[BodiesFrame]:
    """Return frames with those that are left out by their number, which have no people.

    Frames with times have these instead.
    """
    if any(not isnan(frame.time) for frame in frames):
        return frames
    found = []
    for n_missing, frame in zip(missing_before(numbers, numbers[0], path), frames, strict=True):
        found += [frame._replace(bodies={})] * n_missing
        found.append(frame)
    return found


def _one_frame(rows: list[BodiesFrame]) -> BodiesFrame:
    """Return rows of a frame as one; people of the same name get numbers."""
    if len(rows) == 1:
        return rows[0]
    bodies: dict[str, BodyJoints] = {}
    for row in rows:
        for who, joints in row.bodies.items():
            names = (who, *(f"{who} {count}" for count in range(2, len(rows) + 1)))
            name = next(name for name in names if name not in bodies)
            bodies[name] = joints
    return rows[0]._replace(bodies=bodies)
