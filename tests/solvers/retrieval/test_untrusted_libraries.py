"""Libraries of unknown origin are checked, harm no other file and run no code."""

import sqlite3
import sys
import warnings
from contextlib import closing, suppress
from pathlib import Path

import numpy as np
import pytest
from acted_clips import act

from solvers.errors import InvalidFileError
from solvers.retrieval import (
    Clip,
    Origin,
    build_clip_library,
    find_similar,
    load_clip_library,
    open_clip_library,
)

MAGIC = bytes.fromhex("d9d505f920a163d7")
ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n"


@pytest.fixture
def path(tmp_path) -> Path:
    path = tmp_path / "a.clips"
    origin = Origin("/a/walk.bvh", "", 1, 2)
    library = build_clip_library([Clip("walk", act("wave"), ("tag",), origin)])
    library.remember_refused("1", [(Origin("/b", "", 1, 2), "It is odd.")])
    library.save(path)
    return path


def change(path: Path, sql: str, *values: object) -> None:
    with closing(sqlite3.connect(path)) as database, database:
        database.execute(sql, values)


def use(path: Path) -> None:
    with load_clip_library(path) as library:
        find_similar(act("kick"), library)
        library.add([Clip("new", act("bow"))])
        library.refused("1")


def super_journal(library: Path, named: Path) -> bytes:
    """Return a journal that makes SQLite delete the file that it names."""
    name = str(named).encode()
    n_pages = library.stat().st_size // 4096
    header = MAGIC + b"".join(n.to_bytes(4, "big") for n in (0, 0, n_pages, 512, 4096))
    lock_page = (2**30 // 4096 + 1).to_bytes(4, "big")
    sums = len(name).to_bytes(4, "big") + sum(name).to_bytes(4, "big")
    return header.ljust(512, b"\0") + lock_page + name + sums + MAGIC


@pytest.mark.parametrize("start", [load_clip_library, open_clip_library])
def test_journal_that_names_another_file_is_refused(path, tmp_path, start):
    victim = tmp_path / "victim.blend"
    victim.write_text("years of work")
    journal = tmp_path / "a.clips-journal"
    journal.write_bytes(super_journal(path, victim))

    with pytest.raises(InvalidFileError, match="could harm other files; remove it first"):
        start(path).close()
    assert victim.read_text() == "years of work"

    with closing(sqlite3.connect(path)) as database:  # What SQLite itself does.
        database.execute("SELECT * FROM clips").fetchall()
    assert not victim.exists()


@pytest.mark.skipif(sys.platform == "win32", reason="needs links")
@pytest.mark.parametrize("ending", ["-journal", "-wal", "-shm"])
def test_link_next_to_a_library_is_refused(path, tmp_path, ending):
    (tmp_path / "victim").write_bytes(b"\0" * 9)
    (tmp_path / f"a.clips{ending}").symlink_to(tmp_path / "victim")
    (tmp_path / "link.clips").symlink_to(path)
    for named in (path, tmp_path / "link.clips"):
        with pytest.raises(InvalidFileError, match="could harm other files"):
            use(named)
    assert (tmp_path / "victim").read_bytes() == b"\0" * 9


def test_journal_of_a_killed_process_is_rolled_back(path):
    with closing(sqlite3.connect(path, isolation_level=None)) as database:
        database.execute("PRAGMA cache_size = 1")
        database.execute("BEGIN IMMEDIATE")
        database.execute("UPDATE clips SET positions = zeroblob(400000)")
        half_written = path.read_bytes()
        journal = Path(f"{path}-journal").read_bytes()
        database.execute("ROLLBACK")
    path.write_bytes(half_written)
    Path(f"{path}-journal").write_bytes(journal)

    use(path)


@pytest.mark.parametrize(
    "sql",
    [
        "CREATE TRIGGER t AFTER INSERT ON clips BEGIN DELETE FROM clips; END",
        f"CREATE VIEW refused2 AS {ENDLESS}",
        "CREATE TABLE more (a)",
        "CREATE INDEX more ON clips (abs(size))",
        "ALTER TABLE clips ADD COLUMN more",
        "ALTER TABLE blocks RENAME COLUMN spans TO other",
        "UPDATE sqlite_sequence SET seq = 9223372036854775807",
        "UPDATE sqlite_sequence SET seq = 'x'",
    ],
)
def test_schema_of_another_program_is_refused(path, sql):
    change(path, sql)
    with pytest.raises(InvalidFileError, match="is not a clip library, or is damaged"):
        load_clip_library(path)


def test_view_instead_of_a_table_is_refused(path):
    change(path, "DROP TABLE clips")
    change(path, f"CREATE VIEW clips AS {ENDLESS}")
    with pytest.raises(InvalidFileError, match="is not a clip library"):
        load_clip_library(path)


def test_trigger_added_to_an_open_library_is_refused(path):
    with load_clip_library(path) as library:
        change(path, "CREATE TRIGGER t AFTER DELETE ON clips BEGIN DELETE FROM blocks; END")
        for work in (
            lambda: library.entries,
            lambda: library.remove(["walk"]),
            lambda: library.add([Clip("new", act("bow"))]),
        ):
            with pytest.raises(InvalidFileError, match="is not a clip library"):
                work()


def test_library_without_the_refused_files_table_is_opened(path):
    change(path, "DROP TABLE refused")
    use(path)


CLIP = {
    "path": (b"ff", "a\0b"), "item": (None, b"ff", "a\0b"), "size": (None, "x", -1, 1.5),
    "modified": (None, "x"), "n_frames": (1e308, 2**62, 0, b"1"),
    "frame_rate": (1e-300, 1e300, float("inf"), "x", b"1"), "number": (-1, 2**63 - 1),
    "name": (b"f", "a\nb", "\x1b[31mred"), "tags": ("5", b"[]", '["a\\nb"]', '["\\u001b[31m"]'),
    "course": (np.full(400, np.nan, "<f2").tobytes(),),
}  # fmt: skip
REFUSED = {"path": (b"f",), "size": ("x",), "modified": (b"",), "sentence": (b"", "\x1b[31m")}


@pytest.mark.parametrize(
    ("table", "column", "value"),
    [("clips", column, value) for column, values in CLIP.items() for value in values]
    + [("refused", column, value) for column, values in REFUSED.items() for value in values],
)
def test_value_of_another_kind_is_damage(path, table, column, value):
    with suppress(sqlite3.IntegrityError):
        change(path, f"UPDATE {table} SET {column} = ?", value)
    with pytest.raises(InvalidFileError, match="damaged"):
        use(path)


def test_path_that_is_not_utf_8_is_damage(path):
    change(path, "UPDATE clips SET path = 'caf' || CAST(x'ff' AS TEXT)")
    with pytest.raises(InvalidFileError, match="damaged"):
        use(path)


@pytest.mark.parametrize(
    ("name", "filled"),
    [
        ("spread", 0), ("spread", -1), ("spread", np.nan), ("axes", 9), ("words", 1e300),
        ("covariance", -1), ("covariance", np.inf), ("mean", 1e99), ("n_frames", 0),
        ("n_frames", 1e300), ("n_frames", -5),
    ],
)  # fmt: skip
def test_vocabulary_that_was_never_learned_is_damage(path, name, filled):
    with closing(sqlite3.connect(path)) as database:
        (stored,) = database.execute(
            "SELECT value FROM vocabulary WHERE name = ?", (name,)
        ).fetchone()
    value = np.full(len(stored) // 8, float(filled)).tobytes()
    change(path, "UPDATE vocabulary SET value = ? WHERE name = ?", value, name)
    with pytest.raises(InvalidFileError, match="damaged"):
        use(path)


@pytest.mark.parametrize("number", [-5, 2**63 - 1])
def test_full_vocabulary_is_damage(path, number):
    change(path, "DELETE FROM vocabulary WHERE number > 1")
    change(path, "UPDATE vocabulary SET number = ?", number)
    with pytest.raises(InvalidFileError, match="damaged"):
        use(path)


def test_index_that_is_missing_is_damage(path):
    change(path, "DELETE FROM blocks")
    with pytest.raises(InvalidFileError, match="damaged"):
        use(path)


@pytest.mark.parametrize(
    ("table", "column"),
    [("blocks", "summaries"), ("clips", "positions"), ("clips", "course")],
)
def test_random_numbers_are_damage_or_searched_without_warnings(path, table, column):
    with closing(sqlite3.connect(path)) as database:
        (stored,) = database.execute(f"SELECT {column} FROM {table}").fetchone()
    random = np.random.default_rng(0)
    for highest in (2**16, 0x7C00):  # Any bits; all that are numbers.
        value = random.integers(0, highest, len(stored) // 2, dtype=np.uint16).tobytes()
        change(path, f"UPDATE {table} SET {column} = ?", value)
        with warnings.catch_warnings(), suppress(InvalidFileError):
            warnings.simplefilter("error")
            use(path)


def test_motion_beyond_half_precision_is_stored_and_found(tmp_path):
    motion = act("wave")
    positions = motion.positions.copy()
    positions[20:] += 1e7
    distant = motion.with_positions(positions)
    build_clip_library([Clip("far", distant)]).save(tmp_path / "a.clips")
    with load_clip_library(tmp_path / "a.clips") as library:
        assert find_similar(distant, library)
