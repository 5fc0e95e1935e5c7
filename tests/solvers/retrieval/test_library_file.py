"""The file of a library stays intact in all events; other files are refused in one sentence."""

import pickle
import shutil
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest
from acted_clips import ACTS, act
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from solvers.errors import InvalidFileError, MocapAssistError
from solvers.retrieval import (
    Clip,
    build_clip_library,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.library import library_file

ROOT = Path(__file__).parents[3]
ADD = """
import sys
sys.path += [{fixtures!r}, {root!r}]
from acted_clips import act
from solvers.retrieval import Clip, open_clip_library
name, path, n_rounds = sys.argv[1], sys.argv[2], int(sys.argv[3])
with open_clip_library(path) as library:
    for number in range(n_rounds):
        library.add([Clip(f"{{name}} {{number}}", act(name, 1.5 + 0.05 * number))])
        print(number, flush=True)
"""


@pytest.fixture(scope="module")
def intact_file(tmp_path_factory) -> Path:
    """File of a library of fifteen clips."""
    path = tmp_path_factory.mktemp("whole") / "library.clips"
    clips = [
        Clip(f"{name} {s}", act(name, s), (name,)) for name in ACTS for s in (1.6, 2.0, 2.4)
    ]
    build_clip_library(clips).save(path)
    return path


@pytest.fixture
def path(intact_file, tmp_path) -> Path:
    """A copy of it."""
    return Path(shutil.copy(intact_file, tmp_path / "library.clips"))


def ranking(library) -> list[tuple]:
    found = find_similar(act("kick", 2.2), library)
    return [(match.clip, match.frames, match.score) for match in found]


def adding(name: str, path: Path, n_rounds: int) -> subprocess.Popen:
    program = ADD.format(fixtures=str(ROOT / "tests" / "fixtures"), root=str(ROOT))
    return subprocess.Popen(
        [sys.executable, "-c", program, name, str(path), str(n_rounds)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def test_loaded_library_ranks_exactly_the_same(tmp_path):
    library = build_clip_library([Clip(name, act(name), (name,)) for name in ACTS])
    library.add([Clip("again", act("kick", 2.7))])
    library.save(tmp_path / "a")

    with load_clip_library(tmp_path / "a") as loaded:
        assert loaded.entries == library.entries
        assert ranking(loaded) == ranking(library)
        loaded.save(tmp_path / "b")
    with load_clip_library(tmp_path / "b") as copy:
        assert ranking(copy) == ranking(library)


def test_open_libraries_show_changes_by_other_processes(path):
    with load_clip_library(path) as one, load_clip_library(path) as other:
        assert ranking(other)[0][0] == "kick 2.4"
        one.add([Clip("new", act("kick", 2.2))])
        assert ranking(other) == ranking(one)
        assert "new" in [entry.name for entry in other.entries]
        one.remove(["new"])
        assert "new" not in [match[0] for match in ranking(other)]


@pytest.mark.skipif(sys.platform == "win32", reason="needs permissions as on Unix")
def test_read_only_file_can_be_searched(path, monkeypatch):
    with load_clip_library(path) as library:
        expected = ranking(library)
        library._database.execute("PRAGMA query_only = 1")  # Root may write everywhere.
        assert ranking(library) == expected
        with pytest.raises(InvalidFileError, match="cannot be used: attempt to write a read"):
            library.add([Clip("new", act("wave"))])
        assert ranking(library) == expected


def test_open_names_the_path_where_no_file_can_be_created(tmp_path):
    (tmp_path / "file").write_text("")
    for wrong in (tmp_path / "none" / "a.clips", tmp_path / "file" / "a.clips"):
        with pytest.raises(InvalidFileError, match="cannot be used"):
            open_clip_library(wrong)
        with pytest.raises(InvalidFileError):
            build_clip_library([]).save(wrong)


def test_newer_version_is_refused_in_one_sentence(path):
    database = sqlite3.connect(path)
    database.execute(f"PRAGMA user_version = {library_file.VERSION + 1}")
    database.close()

    with pytest.raises(InvalidFileError, match="written by a newer version of Mocap Assist"):
        load_clip_library(path)
    with pytest.raises(InvalidFileError, match="Update the add-on"):
        open_clip_library(path)


def test_other_files_are_refused(tmp_path):
    other = tmp_path / "other.sqlite"
    with closing(sqlite3.connect(other)) as database:
        database.executescript("CREATE TABLE clips (a); INSERT INTO clips VALUES (1)")
    text, pickled = tmp_path / "text", tmp_path / "pickle"
    text.write_text("HIERARCHY\nROOT Hips" * 999)
    pickled.write_bytes(pickle.dumps({"clips": [1, 2, 3]}) * 100)
    empty = tmp_path / "empty"
    empty.touch()

    for wrong in (other, text, pickled, empty, tmp_path, tmp_path / "none"):
        with pytest.raises(InvalidFileError, match="library"):
            load_clip_library(wrong)
    for wrong in (other, text, pickled, tmp_path):
        before = None if wrong.is_dir() else wrong.read_bytes()
        with pytest.raises(InvalidFileError, match="library"):
            open_clip_library(wrong)
        assert before is None or wrong.read_bytes() == before


def test_library_is_created_in_an_empty_file(tmp_path):
    """A process that was killed at its start leaves such a file."""
    (tmp_path / "empty.clips").touch()
    with open_clip_library(tmp_path / "empty.clips") as library:
        library.add([Clip("wave", act("wave"))])
    with load_clip_library(tmp_path / "empty.clips") as library:
        assert len(library.entries) == 1


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_file_is_refused_or_works(intact_file, tmp_path, data):
    """Bytes are changed or the end is missing; the only error is InvalidFileError."""
    content = bytearray(intact_file.read_bytes())
    offsets = st.integers(0, len(content) - 1)
    near = st.one_of(st.integers(0, 4096), offsets)
    for offset in data.draw(st.lists(near, min_size=1, max_size=20)):
        length = data.draw(st.integers(1, 64))
        content[offset : offset + length] = data.draw(st.binary(min_size=1, max_size=64))
    damaged = tmp_path / "damaged"
    damaged.write_bytes(content[: data.draw(st.one_of(st.just(len(content)), offsets))])

    try:
        with load_clip_library(damaged) as library:
            ranking(library)
            library.add([Clip("new", act("wave"))])
            library.remove(["new"])
            ranking(library)
    except InvalidFileError as error:
        assert str(damaged) in str(error)
        assert str(error).endswith((".", "add-on."))


@pytest.mark.parametrize("table", ["clips", "blocks", "vocabulary"])
def test_missing_or_garbled_table_is_reported(path, table):
    with closing(sqlite3.connect(path)) as database, database:
        columns = [row[1] for row in database.execute(f"PRAGMA table_info({table})")]
        database.execute(f"UPDATE {table} SET {columns[-1]} = x'0102030405'")
    with pytest.raises(InvalidFileError, match="damaged"), load_clip_library(path) as library:
        ranking(library)

    with closing(sqlite3.connect(path)) as database, database:
        database.execute(f"DROP TABLE {table}")
    with pytest.raises(InvalidFileError, match="is not a clip library"):
        ranking(load_clip_library(path))


def test_no_content_is_unpickled(path, monkeypatch):
    def refuse(*arguments, **options):
        raise AssertionError("unpickled")

    for name in ("load", "loads", "Unpickler"):
        monkeypatch.setattr(pickle, name, refuse)
    with load_clip_library(path) as library:
        assert len(ranking(library)) == 15
    assert b"pickle" not in path.read_bytes()


def test_locked_library_waits_and_then_reports_it(path, monkeypatch):
    monkeypatch.setattr(library_file, "LOCK_TIMEOUT_S", 0.1)
    writer = sqlite3.connect(path, isolation_level=None)
    with load_clip_library(path) as library:
        expected = ranking(library)
        writer.execute("BEGIN IMMEDIATE")
        assert ranking(library) == expected
        for change in (
            lambda: library.add([Clip("a", act("bow"))]),
            lambda: library.remove([]),
        ):
            with pytest.raises(InvalidFileError, match="is being written by another program"):
                change()
        writer.execute("ROLLBACK")
        library.add([Clip("a", act("bow"))])
    writer.close()


def test_two_processes_can_add_to_a_new_file_at_once(tmp_path):
    path = tmp_path / "shared.clips"
    processes = [adding(name, path, 12) for name in ("wave", "kick", "squat")]
    for process in processes:
        _, errors = process.communicate(timeout=500)
        assert (process.returncode, errors) == (0, "")

    with load_clip_library(path) as library:
        names = {entry.name for entry in library.entries}
        assert names == {f"{act} {n}" for act in ("wave", "kick", "squat") for n in range(12)}
        assert {match[0] for match in ranking(library)} == names
    assert is_intact(path)


@pytest.mark.parametrize("after", [0.0, 0.011])
def test_killed_process_leaves_the_file_intact(path, after):
    process = adding("wave", path, 10_000)
    output = [process.stdout.readline() for _ in range(3)]
    time.sleep(after)
    process.kill()
    output += process.communicate()[0].splitlines()

    assert is_intact(path)
    with load_clip_library(path) as library:
        waves = [entry.name for entry in library.entries if entry.origin is None][15:]
        assert len(waves) in {len(output), len(output) + 1}
        assert {match[0] for match in ranking(library)} == {e.name for e in library.entries}
        library.add([Clip("afterwards", act("bow"))])


def test_all_database_errors_are_converted():
    assert issubclass(InvalidFileError, MocapAssistError)


def is_intact(path: Path) -> bool:
    with closing(sqlite3.connect(path)) as database, database:
        return database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
