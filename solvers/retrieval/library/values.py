"""Check the values of a row: SQLite accepts any type in any column."""

import sqlite3
from typing import Any

from ..index import find_text_fault
from .schema import MAX_NUMBER

MAX_BYTES = 2**63 - 1
"""Largest integer of SQLite, for file sizes and times in nanoseconds."""


def check_number(value: Any, lowest: int, highest: int) -> int:
    """Return an integer within limits; raise ValueError for anything else."""
    if type(value) is not int or not lowest <= value <= highest:
        raise ValueError("The value is not an integer within its limits.")
    return value


def check_row_number(value: Any) -> int:
    """Return the number of a row; raise ValueError for an invalid one."""
    return check_number(value, 1, MAX_NUMBER)


def read_row_numbers(database: sqlite3.Connection, table: str) -> list[int]:
    """Return the numbers of all rows of a table, oldest first."""
    rows = database.execute(f"SELECT number FROM {table} ORDER BY 1")
    return [check_row_number(number) for (number,) in rows]


def check_text(value: Any) -> str:
    """Return a text without null characters; raise ValueError for anything else."""
    if not isinstance(value, str) or "\0" in value:
        raise ValueError("The value is not a text.")
    return value


def check_printable(value: Any) -> str:
    """Return a text without control characters; raise ValueError for anything else."""
    if find_text_fault(check_text(value)):
        raise ValueError("The text has control characters.")
    return str(value)
