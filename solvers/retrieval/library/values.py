"""Check what a row of a library holds: SQLite keeps any value in any column."""

import sqlite3
from typing import Any

from ..index import find_text_fault
from .schema import MAX_NUMBER

MAX_BYTES = 2**63 - 1
"""Of a file; also the last nanosecond of its date that SQLite can keep."""


def check_number(value: Any, lowest: int, highest: int) -> int:
    """Return a whole number within limits; raise ValueError for anything else."""
    if type(value) is not int or not lowest <= value <= highest:
        raise ValueError("It is not a number of its kind.")
    return value


def check_row_number(value: Any) -> int:
    """Return the number of a row; raise ValueError where no library has it."""
    return check_number(value, 1, MAX_NUMBER)


def read_row_numbers(database: sqlite3.Connection, table: str) -> list[int]:
    """Return the numbers of all rows of a table, oldest first."""
    rows = database.execute(f"SELECT number FROM {table} ORDER BY 1")
    return [check_row_number(number) for (number,) in rows]


def check_text(value: Any) -> str:
    """Return a text that names a file or a thing in it; raise ValueError for anything else."""
    if not isinstance(value, str) or "\0" in value:
        raise ValueError("It is not a text.")
    return value


def check_printable(value: Any) -> str:
    """Return a text that may be shown as it is; raise ValueError for anything else."""
    if find_text_fault(check_text(value)):
        raise ValueError("It has control characters.")
    return str(value)
