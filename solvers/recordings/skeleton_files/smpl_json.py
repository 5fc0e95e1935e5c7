"""Read the parameters of SMPL bodies from JSON, as EasyMocap writes them."""

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion
from ...motion.humanoid import ADULT_STATURE_M
from ...progress import Progress, Remark, unwatched
from ..containers import JsonMember, describe_frame_files, json_content, json_frame_files
from ..conventions import FRAME_KEY, MAX_PEOPLE, Bodies, rate_of_numbers, step_between
from .smpl_bodies import (
    CONSTANT,
    N_BODY_POSE,
    N_NUMBERS,
    POSES,
    RATES,
    READ_ARRAYS,
    bodies_of_parameters,
    joined_frames,
    people_of_parameters,
    plain_name,
    rows_of_frames,
)

IDENTITIES = ("id", "track_id", "person_id")
BODY = (*POSES, "pose")
OF_SMPL = (*{*POSES} - {"poses", "body_pose"},)
"""Names that nothing else has."""
NEXT_TO_POSES = ("Rh", "Th", "betas", "shapes", "trans", "transl", "smpl_trans")
LIST = rb'(?i)"(?:%s)"\s*:\s*\['
OWN_NAME, POSE_NAME, OTHER_NAME = (
    re.compile(LIST % "|".join(names).replace("_", "_?").encode())
    for names in (OF_SMPL, ("poses", "pose"), NEXT_TO_POSES)
)
LONG_ROW = re.compile(
    rb'(?i)"poses"\s*:\s*(?:\[\s*){1,3}((?:\s*-?\d[^,\[\]]*,){62}[^\[\]]*)(?P<end>\]|\Z)'
)
"""A pose of 63 and more numbers, which may be longer than the first bytes of a file."""
IN_WORLD = re.compile(r"(?i)global|world")
"""Word in the key of poses that others repeat relative to the camera."""
NUMBERED = re.compile(r"\D*\d+")
"""Key of one of several people."""
MAX_DEPTH = 4
"""Levels of members in which a body is looked for. It guards the depth of the recursion."""
NUMBERS = ("frame", "frame_id", "frame_index", "frame_number")
"""Members with the number of a frame."""
MAX_SPREAD = 10
"""Frames per one of the file, up to which the others are missing. It bounds the memory."""
KNOWN_NAMES = frozenset((*READ_ARRAYS, *IDENTITIES, *NUMBERS))


def is_smpl_json(head: bytes) -> bool:
    """Return whether the first bytes are JSON with the poses of an SMPL body."""
    if head.lstrip()[:1] not in {b"[", b"{"}:
        return False
    is_pose = POSE_NAME.search(head) is not None and OTHER_NAME.search(head) is not None
    row = LONG_ROW.search(head)
    is_row = row is not None and (
        not row["end"] or row[1].count(b",") + 1 in N_NUMBERS | N_BODY_POSE
    )
    return is_pose or is_row or OWN_NAME.search(head) is not None


def is_frame_smpl_json(path: Path | str) -> bool:
    """Return whether a file holds the poses of one frame."""
    return _n_frames(_frames([json_content(path)], unwatched)) == 1


def open_smpl_json(
    path: Path | str,
    *,
    scale: float | None = None,
    height: float = ADULT_STATURE_M,
    on_floor: bool = True,
    progress: Progress = unwatched,
) -> Bodies[Motion]:
    """Open the parameters of SMPL bodies from JSON, by the names that `open_smpl` reads.

    A file has the arrays of a take, a list of its frames, or the people of one frame, each with
    an `id`. A file of one frame stands for all files of its take (`frame_files`); people who
    are in none of its people are missing there.

    Parameters
    ----------
    path, scale, height, on_floor : as of `open_smpl`
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, of one frame alone, or has no rotations of a body.
    InvalidSettingError
        Scale or height is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    frames = _frames([json_content(path)], progress)
    if _n_frames(frames) <= 1:
        frames = _frames(json_frame_files(path), progress)
        if len(frames) > 1:
            progress(0.8, Remark(describe_frame_files(len(frames))))
    if _n_frames(frames) <= 1:
        raise InvalidFileError(
            f"{path} holds the pose of one frame. Keep the files of all frames in one folder,"
            " with their numbers in their names."
        )
    people = dict[str, dict[str, Array]]()
    for name in dict.fromkeys(name for frame in frames for name in frame):
        split = people_of_parameters(joined_frames(path, name, frames))
        for number, each in enumerate(split, start=1):
            people[f"{name} {number}" if len(split) > 1 else name] = each
    return bodies_of_parameters(path, people, scale=scale, height=height, on_floor=on_floor)


_Frame = dict[str, dict[str, Array]]
"""Arrays by their names, of people by theirs; the frames are on the first axis."""


def _frames(members: Iterable[JsonMember], progress: Progress) -> list[_Frame]:
    """Return the frames of a take, which may be one with the arrays of all."""
    frames = []
    for member in members:
        rows, common = _rows(_with_plain_names(member.value), progress)
        for row in rows:
            people = _bodies(row, MAX_DEPTH)
            frames.append({name: {**common, **_arrays(body)} for name, body in people})
    return frames


def _with_plain_names(value: Any) -> Any:
    """Return members by the names that are known, however programs spell these."""
    if isinstance(value, Mapping):
        plain = {name: plain_name(name) for name in value}
        return {
            plain[name] if plain[name] in KNOWN_NAMES else name: _with_plain_names(each)
            for name, each in value.items()
        }
    if isinstance(value, list) and any(isinstance(each, Mapping) for each in value):
        return [_with_plain_names(each) for each in value]
    return value


def _rows(value: Any, progress: Progress) -> tuple[list[Any], dict[str, Array]]:
    """Return the frames that a value lists, otherwise itself, and what it states of all."""
    value = _as_list(value)
    if isinstance(value, list) and not any(map(_has_identity, value)):
        return _by_number(value, _numbers_of(value)), {}
    if isinstance(value, Mapping) and not _is_body(value):
        listed = [each for each in map(_as_list, value.values()) if _is_list_of_frames(each)]
        if len(listed) == 1:
            stated, numbers = _arrays(value), _numbers_of(listed[0])
            common = {name: stated[name] for name in stated if name in CONSTANT}
            for name in common.keys() & RATES:
                rate = float(common[name].flat[0])
                common[name] = np.array(rate_of_numbers(sorted(numbers), rate, progress))
            return _by_number(listed[0], numbers), common
    return [value], {}


def _as_list(value: Any) -> Any:
    """Return frames that are keyed by their numbers as a list; other values as they are.

    There are more of them than people.
    """
    if not isinstance(value, Mapping) or len(value) <= MAX_PEOPLE:
        return value
    keys = [FRAME_KEY.fullmatch(key) for key in value]
    if not all(keys):
        return value
    numbers = [float(key[1]) for key in keys if key]
    if not all(number.is_integer() for number in numbers):
        return [row for _, row in sorted(zip(numbers, value.values(), strict=True))]
    return [
        {**row, NUMBERS[0]: int(number)} if isinstance(row, Mapping) else row
        for number, row in zip(numbers, value.values(), strict=True)
    ]


def _numbers_of(rows: list[Any]) -> list[int]:
    """Return the numbers of frames; none if not each frame has its own."""
    stated = [
        [row[key] for key in NUMBERS if isinstance(row.get(key), int)]
        for row in rows
        if isinstance(row, Mapping)
    ]
    numbers = [each[-1] for each in stated if each]
    return numbers if len({*numbers}) == len(rows) else []


def _by_number(rows: list[Any], numbers: list[int]) -> list[Any]:
    """Return frames in the order of their numbers, null for missing ones, if all have one."""
    numbered = dict(zip(numbers, rows, strict=False))
    if not numbered:
        return rows
    ordered = sorted(numbered)
    step, length = round(step_between(ordered)), ordered[-1] - ordered[0]
    is_regular = step > 0 and length < MAX_SPREAD * step * len(rows)
    return [
        numbered.get(number)
        for number in (range(ordered[0], ordered[-1] + 1, step) if is_regular else ordered)
    ]


def _is_list_of_frames(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) > 1
        and not any(map(_has_identity, value))
        and any(True for each in value for _ in _bodies(each, MAX_DEPTH))
    )


def _has_identity(value: Any) -> bool:
    return isinstance(value, Mapping) and bool(_identity(value, ""))


def _bodies(value: Any, depth: int) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the names of bodies and their members, however deep these are."""
    if isinstance(value, Mapping) and _is_body(value):
        yield _identity(value, "1"), value
    elif depth and isinstance(value, Mapping):
        ordered = sorted(value, key=lambda key: IN_WORLD.search(key) is None)
        found = {key: [*_bodies(value[key], depth - 1)] for key in ordered}
        groups = [(key, bodies) for key, bodies in found.items() if bodies]
        if len(groups) > 1 and all(NUMBERED.fullmatch(key) for key, _ in groups):
            yield from ((key, body) for key, bodies in groups for _, body in bodies[:1])
        else:
            yield from groups[0][1] if groups else ()
    elif depth and isinstance(value, list):
        for count, inner in enumerate(value, start=1):
            for name, body in _bodies(inner, depth - 1):
                yield (name if _has_identity(body) else str(count)), body


def _is_body(value: Mapping[str, Any]) -> bool:
    return any(isinstance(value.get(name), list) for name in BODY)


def _identity(body: Mapping[str, Any], default: str) -> str:
    return str(next((body[key] for key in IDENTITIES if key in body), default))


def _arrays(body: Mapping[str, Any]) -> dict[str, Array]:
    """Return the arrays of numbers among members; a row of numbers is one frame or all."""
    arrays = dict[str, Array]()
    for name in READ_ARRAYS:
        try:
            array = np.array(body.get(name), dtype=np.float64)
        except (ValueError, TypeError, OverflowError):
            continue
        if array.size and (array.ndim or (name in CONSTANT and name in body)):
            arrays[name] = array
    return rows_of_frames(arrays)


def _n_frames(frames: list[_Frame]) -> int:
    """Return the number of frames: of the files, or of the arrays of the only one."""
    if len(frames) != 1:
        return len(frames)
    lengths = (
        len(array)
        for arrays in frames[0].values()
        for name, array in arrays.items()
        if name in BODY
    )
    return max(lengths, default=0)
