"""Damage files at relevant points: bytes, archive members, cells and tables of a library."""

import random
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress

from targets import MAX_BYTES, Target, members_of, packed

Mutate = Callable[[bytes, int], bytes]
VALUES = (
    None, 0, -1, 5, 2**31, 2**53, 2**63 - 1, -(2**63), 1e308, 1e-300, float("inf"), b"",
    b"\0" * 8, "", "x", "a\0b", "\x1b[31m", "[]", '["a\\n"]', "/dev/zero",
)  # fmt: skip
SCHEMA = (
    "DROP TABLE {table}", "DELETE FROM {table}",
    "CREATE TRIGGER t AFTER INSERT ON {table} BEGIN DELETE FROM clips; END",
    "CREATE VIEW v AS SELECT * FROM {table}", "CREATE TABLE more (a)",
    "CREATE INDEX more ON {table} (rowid)", "ALTER TABLE {table} ADD COLUMN more",
    "PRAGMA user_version = 2", "PRAGMA application_id = 1",
)  # fmt: skip
MAX_STEPS = 1_000_000
"""Of SQLite's machine: the schema of a damaged library may never end."""


def damaged(
    target: Target, content: bytes, max_size: int, rng: random.Random, mutate: Mutate
) -> bytes:
    """Return the content with a few damages that suit the kind of file."""
    if target.is_archive:
        return _archive(target, content, rng, mutate)[:max_size]
    if target.is_database and rng.random() < 0.8:
        for start in (content, target.seed):
            with suppress(sqlite3.Error, OverflowError, ValueError):
                return _database(start, target.tokens, rng, mutate)[:max_size]
    return _bytes(content, target.tokens, rng, mutate, max_size)


def _archive(target: Target, content: bytes, rng: random.Random, mutate: Mutate) -> bytes:
    try:
        members = members_of(content)
    except Exception:
        members = {}
    members = members or members_of(target.seed)
    chosen = rng.choice(sorted(members))
    if rng.random() < 0.05:
        del members[chosen]
    else:
        room = max(MAX_BYTES, len(members[chosen]))
        members[chosen] = _bytes(members[chosen], target.tokens, rng, mutate, room)
    return packed(members)


def _database(content: bytes, tokens: list[bytes], rng: random.Random, mutate: Mutate) -> bytes:
    """Change a cell, or rarely a table, of a SQLite file."""
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as database:
        database.deserialize(content)
        database.set_progress_handler(lambda: 1, MAX_STEPS)
        query = "SELECT name FROM sqlite_master WHERE type = 'table'"
        table = rng.choice([name for (name,) in database.execute(query)] or ["clips"])
        if rng.random() < 0.1:
            database.execute(rng.choice(SCHEMA).format(table=table))
            return database.serialize()
        rows = database.execute(f"SELECT rowid, * FROM {table}")
        columns = [each[0] for each in rows.description][1:]
        row, position = rng.choice(rows.fetchmany(1000) or [[]]), rng.randrange(len(columns))
        if row:
            value = _cell(row[position + 1], tokens, rng, mutate)
            changed = f"UPDATE {table} SET {columns[position]} = ? WHERE rowid = ?"
            database.execute(changed, (value, row[0]))
        return database.serialize()


def _cell(value: object, tokens: list[bytes], rng: random.Random, mutate: Mutate) -> object:
    if isinstance(value, bytes) and rng.random() < 0.7:
        changed = bytearray(_bytes(value, tokens, rng, mutate, len(value) + 64))
        same_size = rng.random() < 0.8  # Others are refused by their size alone.
        return bytes(changed[: len(value)].ljust(len(value), b"\0") if same_size else changed)
    if isinstance(value, str) and rng.random() < 0.5:
        return _bytes(value.encode(), tokens, rng, mutate, 200).decode("utf-8", "replace")
    return rng.choice(VALUES)


def _bytes(
    content: bytes, tokens: list[bytes], rng: random.Random, mutate: Mutate, max_size: int
) -> bytes:
    """Damage a few bytes, as libFuzzer does, or with the tokens of the format."""
    for _ in range(rng.randint(1, 3)):
        at = rng.randint(0, len(content))
        token = rng.choice(tokens)
        kind = rng.random()
        if kind < 0.5:
            content = mutate(content, max_size) if content else token
        elif kind < 0.65:
            content = content[:at] + token + content[at:]
        elif kind < 0.8:
            content = content[:at] + token + content[at + len(token) :]
        elif kind < 0.9:
            content = content[: at + rng.randint(0, 200)] + content[at:]
        else:
            content = content[:at]
    return content[:max_size]
