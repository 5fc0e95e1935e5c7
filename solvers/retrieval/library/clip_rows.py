"""Read and write the clips of a library as rows of its database."""

import json
import sqlite3
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import count
from typing import Any

import numpy as np

from ...errors import InvalidMotionError
from ...json_text import parse_json
from ...motion.skeletons import check_frame_rate
from ..index import CLIP_RATE_HZ, ClipEntry, DescribedClip, Origin
from ..postures import ClipPostures, half_precision
from .database_errors import report_damage
from .values import MAX_BYTES, check_number, check_printable, check_text, read_row_numbers

FreeName = Callable[[ClipEntry, Collection[str]], str]
"""Function that returns an unused name for a clip."""
MAX_FRAMES = 10**9
"""Frames of a clip at most: a day at 10 kHz."""
ENTRY_COLUMNS = "name, tags, path, item, size, modified, n_frames, frame_rate"


def number_name(entry: ClipEntry, used_names: Collection[str]) -> str:
    """Return the name of a clip with the first unused number: "walk (2)"."""
    names = (f"{entry.name} ({number})" for number in count(2))
    return next(name for name in names if name not in used_names)


def write_clips(
    database: sqlite3.Connection, clips: Sequence[DescribedClip], free_name: FreeName
) -> dict[int, str]:
    """Add clips within a transaction; return their numbers and names.

    A clip from a file replaces the previous clip from that file and keeps its name; a new clip
    gets another name if its own exists. A clip without a file replaces the one of its name.
    """
    used_names = {name for (name,) in database.execute("SELECT name FROM clips")}
    written = {}
    for clip in clips:
        entry = clip.entry
        names = _names_of_origin(database, entry.origin)
        if names:
            entry = replace(entry, name=names[0])
        elif entry.origin is not None and entry.name in used_names:
            entry = replace(entry, name=free_name(entry, used_names))
        _remove(database, [*names, entry.name])
        written[_write_clip(database, entry, clip.postures)] = entry.name
        used_names.add(entry.name)
    return written


def remove_clips(database: sqlite3.Connection, numbers: Iterable[int]) -> list[str]:
    """Remove the existing clips of these numbers, and return their names."""
    names = []
    for number in numbers:
        row = database.execute("DELETE FROM clips WHERE number = ? RETURNING name", (number,))
        names += [name for (name,) in row.fetchall()]
    return names


def _names_of_origin(database: sqlite3.Connection, origin: Origin | None) -> list[str]:
    if origin is None:
        return []
    rows = database.execute(
        "SELECT name FROM clips WHERE path = ? AND item = ? ORDER BY number",
        (origin.path, origin.item),
    )
    return [name for (name,) in rows]


def _remove(database: sqlite3.Connection, names: Iterable[str]) -> None:
    database.executemany("DELETE FROM clips WHERE name = ?", [(name,) for name in names])


def _write_clip(database: sqlite3.Connection, entry: ClipEntry, postures: ClipPostures) -> int:
    origin = entry.origin or Origin("")
    done = database.execute(
        f"INSERT INTO clips ({ENTRY_COLUMNS}, positions, course)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            entry.name, json.dumps(entry.tags), origin.path or None, origin.item, origin.size,
            origin.modified, entry.n_frames, entry.frame_rate,
            half_precision(postures.positions).tobytes(),
            half_precision(postures.root_velocity).tobytes(),
        ),
    )  # fmt: skip
    return int(done.lastrowid or 0)


def stored_postures(postures: ClipPostures) -> ClipPostures:
    """Return postures as they are read again, so that each index of a clip is the same."""
    return ClipPostures(
        half_precision(postures.positions).astype(np.float64),
        half_precision(postures.root_velocity).astype(np.float64),
        CLIP_RATE_HZ,
    )


def clip_numbers(database: sqlite3.Connection) -> list[int]:
    """Return the numbers of all clips, oldest first."""
    with report_damage():
        return read_row_numbers(database, "clips")


def read_entries(
    database: sqlite3.Connection, known: Mapping[int, ClipEntry]
) -> dict[int, ClipEntry]:
    """Return the metadata of each clip by its number; skip the `known` ones.

    Numbers only increase, and the metadata of a number never changes.
    """
    numbers = clip_numbers(database)
    rows = database.execute(
        f"SELECT number, {ENTRY_COLUMNS} FROM clips WHERE number > ?", (max(known, default=0),)
    )
    with report_damage():
        new = {number: _entry(row) for number, *row in rows}
    return {number: known.get(number) or new[number] for number in numbers}


@lru_cache(maxsize=1024)
def _tags(stored: str) -> tuple[str, ...]:
    tags = parse_json(stored)
    if not isinstance(tags, list):
        raise ValueError("Tags are a list.")
    return tuple(check_printable(tag) for tag in tags)


def _entry(row: Sequence[Any]) -> ClipEntry:
    name, tags, path, item, size, modified, n_frames, frame_rate = row
    check_frame_rate(frame_rate)
    return ClipEntry(
        check_printable(name),
        _tags(check_text(tags)),
        None if path is None else stored_origin(path, item, size, modified),
        check_number(n_frames, 1, MAX_FRAMES),
        float(frame_rate),
    )


def stored_origin(path: Any, item: Any, size: Any, modified: Any) -> Origin:
    """Return the origin from a row; raise ValueError for an invalid one."""
    return Origin(
        check_text(path),
        check_text(item),
        check_number(size, 0, MAX_BYTES),
        check_number(modified, -MAX_BYTES, MAX_BYTES),
    )


def read_postures(database: sqlite3.Connection, number: int, n_frames: int = 0) -> ClipPostures:
    """Return the postures of a clip, at 20 Hz.

    Fewer frames than `n_frames`, the last indexed frame, mean that the file is damaged.

    Raises
    ------
    InvalidMotionError
        Another process has just removed the clip.
    """
    row = database.execute(
        "SELECT positions, course FROM clips WHERE number = ?", (number,)
    ).fetchone()
    if row is None:
        raise InvalidMotionError(
            "Another program has just removed a clip from the library. Try again."
        )
    with report_damage():
        positions, root_velocity = (
            np.frombuffer(stored, "<f2").astype(np.float64) for stored in row
        )
        positions, root_velocity = positions.reshape(-1, 20, 3), root_velocity.reshape(-1, 4)
        positions[np.isnan(positions)] = np.nan  # replaces signaling NaN
        if len(positions) != len(root_velocity):
            raise ValueError("Positions and velocities have different lengths.")
        if np.isinf(positions).any() or not np.isfinite(root_velocity).all():
            raise ValueError("A position or velocity is infinite.")
        if len(positions) < n_frames:
            raise ValueError("The index points beyond the end of the clip.")
        return ClipPostures(positions, root_velocity, CLIP_RATE_HZ)
