"""Convert SQLite errors to readable messages."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import InvalidFileError
from ...faults import escaped

BUSY = {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}
PRIMARY_CODE_MASK = 0xFF
"""Mask of the primary error code; the other bits are details."""


def is_full_disk(error: Exception) -> bool:
    """Return whether SQLite failed as the disk is full."""
    return getattr(error, "sqlite_errorcode", 0) & PRIMARY_CODE_MASK == sqlite3.SQLITE_FULL


@contextmanager
def readable_errors(path: Path | None) -> Iterator[None]:
    """Raise what SQLite, or `report_damage`, reports of a file as an InvalidFileError."""
    name = "The clip library in memory" if path is None else f"The clip library {path}"
    try:
        yield
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
        code = getattr(error, "sqlite_errorcode", 0) & PRIMARY_CODE_MASK
        if code in BUSY:
            raise InvalidFileError(
                f"{name} is being written by another program; try again when it is done."
            ) from None
        if is_full_disk(error):
            raise InvalidFileError(
                f"{name} cannot be written: the disk is full. It is as it was before."
            ) from None
        # Without a code it is Python that cannot decode a text, or `report_damage` below.
        if isinstance(error, sqlite3.OperationalError) and code:
            raise InvalidFileError(f"{name} cannot be used: {escaped(str(error))}.") from None
        raise InvalidFileError(f"{name} is not a clip library, or is damaged.") from None


@contextmanager
def report_damage() -> Iterator[None]:
    """Report invalid stored values as damage, as SQLite does."""
    try:
        yield
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
        raise sqlite3.DatabaseError("a stored value is damaged") from error
