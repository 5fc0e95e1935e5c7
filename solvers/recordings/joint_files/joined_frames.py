"""Join what a file of JSON holds of each person, or in each row, to the frames of a take."""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from math import isnan
from pathlib import Path
from typing import NamedTuple

from ...errors import InvalidFileError
from .body_json import BodiesFrame, BodyJoints
from .json_people import POINT_KEYS

MAX_MISSING_FRAMES = 100_000
"""Missing numbers, frames, that a file may have. It bounds the memory of damaged files."""


NAME_OF_PERSON = re.compile(
    r"(?i)\D*|\D*(person|people|body|actor|subject|track|player|human|user|skeleton|id)[\W_]*\d+"
)
"""Key of a member that is no frame: it has no number, or that of a person."""


class NumberedFrame(NamedTuple):
    """One element of a list, or what else a file holds of a frame."""

    number: float
    """The number of the frame that it states; NaN if it states none."""
    frame: BodiesFrame


class JoinedFrames(NamedTuple):
    """Frames of a take."""

    frames: list[BodiesFrame]
    identities: dict[str, str]
    """What the members of the file call each person in the frames."""


def joined_frames(by_key: Mapping[str, list[NumberedFrame]], path: Path | str) -> JoinedFrames:
    """Return the frames of all people of a file.

    Members with frames each are people, unless they are joints by another name of the same
    person (`POINT_KEYS`): then the longest is taken. Of members with one frame each, those are
    the frames. Rows of the same frame, with a person each, become one; frames that are left out
    by their number are added without people.

    Raises InvalidFileError if very many frames are left out.
    """
    found = {key: each for key, each in by_key.items() if any(row.frame.bodies for row in each)}
    longest = max(found, key=lambda key: _n_seen(found[key]), default="")
    if len(found.get(longest, ())) > 1:
        people = {key: rows for key, rows in found.items() if len(rows) > 1}
        is_one = longest in POINT_KEYS or len(people) == 1
        return _of_one(found[longest], path) if is_one else _of_several(people, path)
    if all(map(NAME_OF_PERSON.fullmatch, found)):
        return _of_several(found, path)
    return _of_one([row for rows in found.values() for row in rows], path)


def _of_one(rows: list[NumberedFrame], path: Path | str) -> JoinedFrames:
    """Return the frames of members that state who is in them."""
    identities = {who: who for row in rows for who in row.frame.bodies}
    return _by_stamp(rows, identities, path)


def _of_several(people: Mapping[str, list[NumberedFrame]], path: Path | str) -> JoinedFrames:
    """Return the frames of members with the frames of a person each."""
    identities: dict[str, str] = {}
    joined = []
    for key, rows in people.items():
        is_alone = len({who for row in rows for who in row.frame.bodies}) == 1
        for index, (number, frame) in enumerate(rows):
            names = {who: key if is_alone else f"{key} {who}" for who in frame.bodies}
            identities |= {name: who for who, name in names.items()}
            bodies = {names[who]: joints for who, joints in frame.bodies.items()}
            is_unstated = isnan(number) and isnan(frame.time)
            joined.append(
                NumberedFrame(index if is_unstated else number, frame._replace(bodies=bodies))
            )
    return _by_stamp(joined, identities, path)


def missing_before(numbers: Sequence[float], start: float, path: Path | str) -> list[int]:
    """Return how many frames from a start are left out before each of the numbers, in order.

    Raises InvalidFileError if they are very many.
    """
    step = min((after - before for before, after in pairwise(numbers)), default=1.0)
    missing = [
        round((after - before) / step) - 1
        for before, after in pairwise((start - step, *numbers))
    ]
    if sum(missing) > MAX_MISSING_FRAMES:
        raise InvalidFileError(
            f"{path} lacks {sum(missing)} frames between {start:.0f} and"
            f" {numbers[-1]:.0f}. Number the frames without large gaps, and export it again."
        )
    return missing


def _n_seen(rows: Iterable[NumberedFrame]) -> int:
    return sum(bool(row.frame.bodies) for row in rows)


def _by_stamp(
    rows: list[NumberedFrame], identities: dict[str, str], path: Path | str
) -> JoinedFrames:
    """Return rows by their number or time, those with the same as one frame.

    They are left as they are if some state neither, or if more of them state the same than
    there are frames: no one records more people than frames.
    """
    for stamps in ([row.number for row in rows], [row.frame.time for row in rows]):
        groups: dict[float, list[BodiesFrame]] = {}
        for stamp, row in zip(stamps, rows, strict=True):
            if row.frame.bodies or not isnan(stamp):
                groups.setdefault(stamp, []).append(row.frame)
        largest = max(map(len, groups.values()), default=1)
        if len(groups) > largest and not any(map(isnan, groups)):
            break
    else:
        return JoinedFrames([row.frame for row in rows], identities)
    ordered = sorted(groups)
    frames = [_one_frame(groups[stamp], identities) for stamp in ordered]
    if any(not isnan(frame.time) for frame in frames):
        return JoinedFrames(frames, identities)
    with_gaps = []
    for n_missing, frame in zip(missing_before(ordered, ordered[0], path), frames, strict=True):
        with_gaps += [frame._replace(bodies={})] * n_missing
        with_gaps.append(frame)
    return JoinedFrames(with_gaps, identities)


def _one_frame(rows: list[BodiesFrame], identities: dict[str, str]) -> BodiesFrame:
    """Return rows of a frame as one; people of the same name get numbers and identities."""
    if len(rows) == 1:
        return rows[0]
    bodies: dict[str, BodyJoints] = {}
    for row in rows:
        for who, joints in row.bodies.items():
            names = (who, *(f"{who} {count}" for count in range(2, len(rows) + 1)))
            name = next(name for name in names if name not in bodies)
            identities.setdefault(name, identities[who])
            bodies[name] = joints
    return rows[0]._replace(bodies=bodies)
