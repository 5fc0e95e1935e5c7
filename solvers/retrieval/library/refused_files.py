"""Store the files that a library has refused, so that they are not read again."""

import sqlite3
from collections.abc import Iterable

from ..index import Origin
from .clip_rows import stored_origin
from .database_errors import report_damage
from .schema import REFUSED
from .values import check_printable


def read_refused(database: sqlite3.Connection, reader: str) -> dict[Origin, str]:
    """Return the messages for the files that this version of the reader has refused.

    Libraries of older versions lack the table and return none.
    """
    if not database.execute(
        "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'refused'"
    ).fetchone():
        return {}
    rows = database.execute(
        "SELECT path, size, modified, sentence FROM refused WHERE reader = ?", (reader,)
    )
    with report_damage():
        return {
            stored_origin(path, "", size, modified): check_printable(sentence)
            for path, size, modified, sentence in rows
        }


def write_refused(
    database: sqlite3.Connection, reader: str, refused: Iterable[tuple[Origin, str]]
) -> None:
    """Store refused files with their current size and time, replacing older entries."""
    database.execute(REFUSED)
    database.executemany(
        "INSERT OR REPLACE INTO refused VALUES (?, ?, ?, ?, ?)",
        [
            (origin.path, origin.size, origin.modified, reader, sentence)
            for origin, sentence in refused
        ],
    )
