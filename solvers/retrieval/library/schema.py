"""Create and check the tables of a library."""

import os
import sqlite3
import stat
from functools import cache
from pathlib import Path

from ...errors import InvalidFileError
from ...files import open_regular, unreadable_error

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
REFUSED = """CREATE TABLE IF NOT EXISTS refused (
    path TEXT PRIMARY KEY, size INTEGER, modified INTEGER, reader TEXT, sentence TEXT
)"""
"""Created on first use; older libraries lack it."""
MAX_NUMBER = 2**53
"""Of a clip or a block; a library that adds one each microsecond reaches it after 285 years."""
SIDE_FILES = ("-journal", "-wal", "-shm")
"""Suffixes of the files that SQLite reads next to a database."""
SUPER_JOURNAL = bytes.fromhex("d9d505f920a163d7")
"""Ends a journal that names another file, which SQLite deletes: part of a transaction over
several databases. A library never takes part in one."""

Part = tuple[str, str, str | None]
"""Kind, name and SQL of a table or an index."""


def create_tables(database: sqlite3.Connection) -> None:
    """Create the tables of an empty library."""
    for statement in TABLES.split(";"):
        database.execute(statement)


def check_schema(database: sqlite3.Connection) -> None:
    """Raise sqlite3.DatabaseError if the tables are not those of a library.

    Views and triggers are programs: SQLite runs them when a table is read or written. Numbers
    near the end of their range leave no room for more clips.
    """
    parts = database.execute("SELECT type, name, sql FROM sqlite_master LIMIT 20").fetchall()
    if sorted(parts, key=repr) not in _known_schemas():
        raise sqlite3.DatabaseError("the tables are not those of a library")
    for (number,) in database.execute("SELECT seq FROM sqlite_sequence"):
        if type(number) is not int or not 0 <= number <= MAX_NUMBER:
            raise sqlite3.DatabaseError("the numbers of its clips are used up")


@cache
def _known_schemas() -> tuple[list[Part], ...]:
    """Return the schemas of this and older versions."""
    database = sqlite3.connect(":memory:")
    create_tables(database)
    schemas = []
    for statement in ("", REFUSED):
        database.execute(statement)
        found = database.execute("SELECT type, name, sql FROM sqlite_master").fetchall()
        schemas.append(sorted(found, key=repr))
    database.close()
    return tuple(schemas)


def refuse_side_files(path: Path) -> None:
    """Raise InvalidFileError if SQLite would harm other files when it opens this one.

    SQLite deletes the file that is named at the end of a journal, and follows links.
    """
    for ending in SIDE_FILES:
        sibling = Path(os.path.realpath(path) + ending)
        try:
            harmful = not stat.S_ISREG(sibling.lstat().st_mode) or _names_a_file(sibling)
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError as error:
            raise unreadable_error(sibling, error) from None
        if harmful:
            raise InvalidFileError(
                f"{sibling} was not written by Mocap Assist, and opening {path.name} with it"
                " could harm other files; remove it first."
            )


def _names_a_file(journal: Path) -> bool:
    with open_regular(journal) as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - len(SUPER_JOURNAL), 0))
        return file.read() == SUPER_JOURNAL
