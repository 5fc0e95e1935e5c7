"""Clip libraries as SQLite databases: one file, changed in whole transactions.

SQLite locks the file while it is written, so that two Blenders can index at once, maps it into
memory, and leaves it whole when a process dies. Nothing in it is ever executed.
"""

import json
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InvalidFileError, MocapAssistError
from .clip import ClipEntry, Origin
from .clip_postures import ClipPostures
from .index_block import IndexBlock, block_arrays, block_from_arrays
from .spans import RATE
from .vocabulary import Vocabulary, vocabulary_arrays, vocabulary_from_arrays

APPLICATION = 0x4D434C42
"""Marks our files among SQLite's ("MCLB")."""
VERSION = 1
PATIENCE = 120.0
"""Seconds to wait for another process that is writing."""
MAPPED = 1 << 40
"""Bytes of a file that may be mapped into memory; SQLite takes what it can."""
TABLES = """
CREATE TABLE vocabulary (number INTEGER PRIMARY KEY, name TEXT, value BLOB);
CREATE TABLE clips (
    number INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT UNIQUE NOT NULL, tags TEXT NOT NULL,
    path TEXT, item TEXT, size INTEGER, modified INTEGER,
    n_frames INTEGER NOT NULL, frame_rate REAL NOT NULL,
    positions BLOB NOT NULL, course BLOB NOT NULL
);
CREATE INDEX origins ON clips (path, item);
CREATE TABLE blocks (
    number INTEGER PRIMARY KEY AUTOINCREMENT, clips BLOB, frames BLOB, histograms BLOB,
    summaries BLOB, starts BLOB, spans BLOB, weights BLOB
);
"""
BLOCK_COLUMNS = ("clips", "frames", "histograms", "summaries", "starts", "spans", "weights")
ENTRY_COLUMNS = "name, tags, path, item, size, modified, n_frames, frame_rate"


def create_database() -> sqlite3.Connection:
    """Return an empty library in memory."""
    database = sqlite3.connect(":memory:", isolation_level=None, check_same_thread=False)
    _lay_out(database)
    return database


def begin_file(path: Path) -> None:
    """Lay out an empty library in a file that is not there, or empty.

    Where another process does so at the same time, one of them does it.

    Raises
    ------
    InvalidFileError
        The folder is missing or may not be written to.
    """
    with told_in_words(path):
        database = sqlite3.connect(path, timeout=PATIENCE, isolation_level=None)
        try:
            with transaction(database):
                if not database.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                    _lay_out(database)
        finally:
            database.close()


def open_database(path: Path) -> sqlite3.Connection:
    """Open the library in a file.

    Raises
    ------
    InvalidFileError
        There is no such file, it is no library, or one of a newer version.
    """
    if not path.is_file():
        raise InvalidFileError(f"There is no clip library {path}.")
    with told_in_words(path):
        database = sqlite3.connect(
            path, timeout=PATIENCE, isolation_level=None, check_same_thread=False
        )
        try:
            _check(database, path)
            database.execute(f"PRAGMA mmap_size = {MAPPED}")
        except BaseException:
            database.close()
            raise
    return database


@contextmanager
def told_in_words(path: Path | None) -> Iterator[None]:
    """Raise what goes wrong with a file as an InvalidFileError."""
    name = "The clip library in memory" if path is None else f"The clip library {path}"
    try:
        yield
    except sqlite3.OperationalError as error:
        if "locked" in str(error):
            raise InvalidFileError(
                f"{name} is being written by another program; try again when it is done."
            ) from None
        raise InvalidFileError(f"{name} cannot be used: {error}.") from None
    except (sqlite3.DatabaseError, ValueError, KeyError, TypeError) as error:
        if isinstance(error, MocapAssistError):
            raise
        raise InvalidFileError(f"{name} is no clip library, or is damaged.") from None


@contextmanager
def transaction(database: sqlite3.Connection) -> Iterator[None]:
    """Change all that is changed within, or nothing; others wait."""
    database.execute("BEGIN IMMEDIATE")
    try:
        yield
    except BaseException:
        database.execute("ROLLBACK")
        raise
    database.execute("COMMIT")


@contextmanager
def one_state(database: sqlite3.Connection) -> Iterator[None]:
    """Read all that is read within as it was at one moment."""
    if database.in_transaction:
        yield
        return
    database.execute("BEGIN")
    try:
        yield
    finally:
        database.execute("ROLLBACK")


def _lay_out(database: sqlite3.Connection) -> None:
    for statement in TABLES.split(";"):
        database.execute(statement)
    database.execute(f"PRAGMA application_id = {APPLICATION}")
    database.execute(f"PRAGMA user_version = {VERSION}")


def _check(database: sqlite3.Connection, path: Path) -> None:
    application = database.execute("PRAGMA application_id").fetchone()[0]
    version = database.execute("PRAGMA user_version").fetchone()[0]
    if application != APPLICATION:
        raise InvalidFileError(f"{path} is no clip library.")
    if version > VERSION:
        raise InvalidFileError(
            f"The clip library {path} was written by a newer version of Mocap Assist"
            f" (format {version}; this version reads up to {VERSION}). Update the add-on."
        )


def vocabulary_number(database: sqlite3.Connection) -> int:
    """Return what grows with each new vocabulary."""
    return database.execute("SELECT max(number) FROM vocabulary").fetchone()[0] or 0


def read_vocabulary(database: sqlite3.Connection) -> Vocabulary | None:
    """Return what the index is told in; None in a library that never had a clip."""
    rows = database.execute("SELECT name, value FROM vocabulary").fetchall()
    return vocabulary_from_arrays(dict(rows)) if rows else None


def write_vocabulary(database: sqlite3.Connection, vocabulary: Vocabulary) -> None:
    """Replace what the index is told in."""
    number = vocabulary_number(database)
    database.execute("DELETE FROM vocabulary")
    for place, (name, value) in enumerate(vocabulary_arrays(vocabulary).items(), number + 1):
        database.execute("INSERT INTO vocabulary VALUES (?, ?, ?)", (place, name, value))


def block_numbers(database: sqlite3.Connection) -> list[int]:
    """Return the numbers of all blocks of the index, oldest first."""
    return [number for (number,) in database.execute("SELECT number FROM blocks ORDER BY 1")]


def read_block(database: sqlite3.Connection, number: int, n_words: int) -> IndexBlock:
    """Return a block of the index."""
    row = database.execute(
        f"SELECT {', '.join(BLOCK_COLUMNS)} FROM blocks WHERE number = ?", (number,)
    ).fetchone()
    return block_from_arrays(dict(zip(BLOCK_COLUMNS, row, strict=True)), n_words)


def write_block(database: sqlite3.Connection, block: IndexBlock) -> None:
    """Add a block to the index."""
    stored = block_arrays(block)
    marks = ", ".join("?" * len(BLOCK_COLUMNS))
    database.execute(
        f"INSERT INTO blocks ({', '.join(BLOCK_COLUMNS)}) VALUES ({marks})",
        [stored[name] for name in BLOCK_COLUMNS],
    )


def write_clip(database: sqlite3.Connection, entry: ClipEntry, postures: ClipPostures) -> int:
    """Add a clip, in place of one of the same name, and return its number."""
    origin = entry.origin or Origin("")
    database.execute("DELETE FROM clips WHERE name = ?", (entry.name,))
    done = database.execute(
        f"INSERT INTO clips ({ENTRY_COLUMNS}, positions, course)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            entry.name, json.dumps(entry.tags), origin.path or None, origin.item, origin.size,
            origin.modified, entry.n_frames, entry.frame_rate,
            postures.positions.astype("<f2").tobytes(),
            postures.course.astype("<f2").tobytes(),
        ),
    )  # fmt: skip
    return int(done.lastrowid or 0)


def clip_numbers(database: sqlite3.Connection) -> list[int]:
    """Return the numbers of all clips, oldest first."""
    return [number for (number,) in database.execute("SELECT number FROM clips ORDER BY 1")]


def read_entries(
    database: sqlite3.Connection, known: Mapping[int, ClipEntry]
) -> dict[int, ClipEntry]:
    """Return what is told of each clip, by its number; what is known is not read again.

    Numbers grow, and what is told of one never changes.
    """
    there = sorted(number for (number,) in database.execute("SELECT number FROM clips"))
    rows = database.execute(
        f"SELECT number, {ENTRY_COLUMNS} FROM clips WHERE number > ?", (max(known, default=0),)
    )
    new = {number: _entry(row) for number, *row in rows}
    return {number: known.get(number) or new[number] for number in there}


@lru_cache(maxsize=1024)
def _tags(stored: str) -> tuple[str, ...]:
    return tuple(json.loads(stored))


def _entry(row: Sequence[Any]) -> ClipEntry:
    name, tags, path, item, size, modified, n_frames, frame_rate = row
    origin = None if path is None else Origin(path, item, size, modified)
    return ClipEntry(name, _tags(tags), origin, n_frames, frame_rate)


def read_postures(database: sqlite3.Connection, number: int) -> ClipPostures:
    """Return the postures of a clip, at 20 Hz."""
    positions, course = database.execute(
        "SELECT positions, course FROM clips WHERE number = ?", (number,)
    ).fetchone()
    return ClipPostures(
        np.frombuffer(positions, "<f2").reshape(-1, 20, 3).astype(np.float64),
        np.frombuffer(course, "<f2").reshape(-1, 4).astype(np.float64),
        RATE,
    )
