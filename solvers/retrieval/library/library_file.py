"""Store clip libraries as SQLite databases: one file, changed by transactions.

SQLite locks the file during a write, so two Blender processes can index at once, and the file
stays intact if a process dies. Views and triggers, which SQLite would execute, are refused.
"""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ...errors import InvalidFileError
from ...files import is_missing, real_path
from ..index import (
    IndexBlock,
    Vocabulary,
    block_arrays,
    block_from_arrays,
    vocabulary_arrays,
    vocabulary_from_arrays,
)
from .database_errors import is_full_disk, readable_errors, report_damage
from .schema import MAX_NUMBER, check_schema, create_tables, refuse_side_files
from .values import check_number, read_row_numbers

SUFFIXES = (".clips", ".library")
"""Suffixes of new libraries; older versions named the shared one .library."""
APPLICATION = 0x4D434C42
"""Application id of our SQLite files ("MCLB")."""
VERSION = 1
LOCK_TIMEOUT_S = 120.0
"""Seconds to wait for a write of another process. A guard against a process that ended while it
wrote."""
BLOCK_COLUMNS = ("clips", "frames", "histograms", "summaries", "starts", "spans", "weights")


def create_database() -> sqlite3.Connection:
    """Return an empty library in memory."""
    database = sqlite3.connect(":memory:", isolation_level=None, check_same_thread=False)
    _lay_out(database)
    return database


def create_file(path: Path) -> None:
    """Create an empty library in a missing or empty file; leave other files unchanged.

    If two processes do so at the same time, only one creates the tables. A file that this call
    made and could not fill as the disk is full is removed.

    Raises
    ------
    InvalidFileError
        The name has no suffix of a library; the folder is missing or not writable.
    """
    refuse_other_suffix(path)
    with readable_errors(path), _no_empty_file_on_full_disk(path):
        database = _connect(path)
        try:
            if not database.execute("PRAGMA page_count").fetchone()[0]:
                with _exclusive_transaction(database):
                    if not database.execute("SELECT 1 FROM sqlite_master").fetchone():
                        _lay_out(database)
        finally:
            database.close()


@contextmanager
def _no_empty_file_on_full_disk(path: Path) -> Iterator[None]:
    """Remove a file that the block made and could not fill, as the disk is full.

    After any other error it stays: another process may be creating the tables in it.
    """
    is_new = is_missing(path)
    try:
        yield
    except sqlite3.Error as error:
        if is_new and is_full_disk(error):
            made = real_path(path)
            with suppress(OSError):
                if not made.stat().st_size:
                    made.unlink()
        raise


def refuse_other_suffix(path: Path) -> None:
    """Raise InvalidFileError if a name does not have the suffix of a library."""
    if Path(os.path.realpath(path)).suffix.lower() not in SUFFIXES:
        raise InvalidFileError(
            f"Cannot create a clip library as {path}; end its name in {SUFFIXES[0]}."
        )


def open_database(path: Path) -> sqlite3.Connection:
    """Open the library in a file.

    Raises
    ------
    InvalidFileError
        The file is missing, not a library, or of a newer version.
    """
    if not path.is_file():
        raise InvalidFileError(f"There is no clip library {path}.")
    with readable_errors(path):
        database = _connect(path)
        try:
            _check(database, path)
        except BaseException:
            database.close()
            raise
    return database


def _connect(path: Path) -> sqlite3.Connection:
    """Open an untrusted file with the settings that SQLite recommends."""
    refuse_side_files(path)
    database = sqlite3.connect(
        path, timeout=LOCK_TIMEOUT_S, isolation_level=None, check_same_thread=False
    )
    database.execute("PRAGMA trusted_schema = OFF")
    database.execute("PRAGMA cell_size_check = ON")
    return database


@contextmanager
def transaction(database: sqlite3.Connection) -> Iterator[None]:
    """Apply all changes of the block or none; other processes wait."""
    with _exclusive_transaction(database):
        check_schema(database)
        yield


@contextmanager
def _exclusive_transaction(database: sqlite3.Connection) -> Iterator[None]:
    database.execute("BEGIN IMMEDIATE")
    try:
        yield
        database.execute("COMMIT")
    except BaseException:
        if database.in_transaction:  # on a full disk SQLite has already rolled back
            database.execute("ROLLBACK")
        raise


@contextmanager
def read_transaction(database: sqlite3.Connection) -> Iterator[None]:
    """Read a consistent state of the database in the block."""
    if database.in_transaction:
        yield
        return
    database.execute("BEGIN")
    try:
        check_schema(database)
        yield
    finally:
        if database.in_transaction:
            database.execute("ROLLBACK")


def _lay_out(database: sqlite3.Connection) -> None:
    create_tables(database)
    database.execute(f"PRAGMA application_id = {APPLICATION}")
    database.execute(f"PRAGMA user_version = {VERSION}")


def _check(database: sqlite3.Connection, path: Path) -> None:
    application = database.execute("PRAGMA application_id").fetchone()[0]
    version = database.execute("PRAGMA user_version").fetchone()[0]
    if application != APPLICATION:
        raise InvalidFileError(f"{path} is not a clip library.")
    if version > VERSION:
        raise InvalidFileError(
            f"The clip library {path} was written by a newer version of Mocap Assist"
            f" (format {version}; this version reads up to {VERSION}). Update the add-on."
        )
    with read_transaction(database):  # It checks the tables.
        pass


def vocabulary_number(database: sqlite3.Connection) -> int:
    """Return a number that increases with each new vocabulary."""
    number = database.execute("SELECT max(number) FROM vocabulary").fetchone()[0] or 0
    with report_damage():
        return check_number(number, 0, MAX_NUMBER)


def read_vocabulary(database: sqlite3.Connection) -> Vocabulary | None:
    """Return the vocabulary; None for a library that never had a clip."""
    rows = database.execute("SELECT name, value FROM vocabulary").fetchall()
    with report_damage():
        return vocabulary_from_arrays(dict(rows)) if rows else None


def write_vocabulary(database: sqlite3.Connection, vocabulary: Vocabulary) -> None:
    """Replace the vocabulary."""
    number = vocabulary_number(database)
    database.execute("DELETE FROM vocabulary")
    for row, (name, value) in enumerate(vocabulary_arrays(vocabulary).items(), number + 1):
        database.execute("INSERT INTO vocabulary VALUES (?, ?, ?)", (row, name, value))


def block_numbers(database: sqlite3.Connection) -> list[int]:
    """Return the numbers of all blocks of the index, oldest first."""
    with report_damage():
        return read_row_numbers(database, "blocks")


def read_block(database: sqlite3.Connection, number: int, n_words: int) -> IndexBlock:
    """Return a block of the index."""
    row = database.execute(
        f"SELECT {', '.join(BLOCK_COLUMNS)} FROM blocks WHERE number = ?", (number,)
    ).fetchone()
    with report_damage():
        return block_from_arrays(dict(zip(BLOCK_COLUMNS, row, strict=True)), n_words)


def write_block(database: sqlite3.Connection, block: IndexBlock) -> None:
    """Add a block to the index."""
    stored = block_arrays(block)
    marks = ", ".join("?" * len(BLOCK_COLUMNS))
    database.execute(
        f"INSERT INTO blocks ({', '.join(BLOCK_COLUMNS)}) VALUES ({marks})",
        [stored[name] for name in BLOCK_COLUMNS],
    )
