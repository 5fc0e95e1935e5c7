"""A library refuses invalid names, files of other programs and full disks, with a reason."""

import sqlite3
import struct
import sys
from contextlib import closing

import pytest
from acted_clips import act

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.retrieval import (
    Clip,
    Origin,
    build_clip_library,
    describe_clip,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.library import index_clips, library_file
from solvers.retrieval.library.schema import create_tables

ODD = {
    "a\r\nb": r"'a\r\nb' has control characters",
    "\x1b[31mred": r"'\x1b[31mred' has control characters",
    "a\x85": r"'a\x85' has control characters",
    "a\u2028b": r"'a\u2028b' has control characters",
    "a\u2029b": r"'a\u2029b' has control characters",
    "caf\udce9": r"'caf\udce9' is not valid UTF-8",
}


def clip(name: str, kind: str, path: str, item: str = "") -> Clip:
    return Clip(name, act(kind, 1.6), origin=Origin(path, item))


def names(library) -> list[str]:
    return [entry.name for entry in library.entries]


@pytest.mark.parametrize("invalid", ODD)
def test_invalid_name_or_tag_is_refused_and_escaped(invalid):
    for wrong in (lambda: Clip(invalid, None), lambda: Clip("walk", None, ("tag", invalid))):
        with pytest.raises(InvalidMotionError) as caught:
            wrong()
        assert ODD[invalid] in str(caught.value)
        assert str(caught.value).isprintable()


def test_path_that_is_not_utf_8_is_refused_and_escaped():
    with pytest.raises(InvalidMotionError, match=r"walk: its path '/caf\\udce9/a.bvh' is no"):
        Clip("walk", None, (), Origin("/caf\udce9/a.bvh"))


@pytest.mark.parametrize("name", ["Gehen (2)", "散歩/歩", "👨‍👩‍👧 walk", "café", "a b\u00a0c"])
def test_name_in_any_language_is_accepted(name):
    assert Clip(name, None, (name,)).name == name


def test_clip_of_another_file_with_the_same_name_stays():
    library = build_clip_library([clip("walk", "wave", "/a/walk.bvh")])

    library.add([
        clip("walk", "kick", "/b/walk.bvh"),
        clip("walk", "bow", "/a/x.blend", "walk"),
    ])

    assert names(library) == ["walk", "walk (2)", "walk (3)"]


def test_clip_of_the_same_file_is_replaced_and_keeps_its_name():
    library = build_clip_library([clip("walk", "wave", "/a/walk.bvh"), Clip("b", act("bow"))])
    (number, *_) = library.numbered()

    named = library.add_described([describe_clip(clip("b", "kick", "/a/walk.bvh"))])

    assert named == ("walk",)
    assert sorted(names(library)) == ["b", "walk"]
    assert library.discard([number]) == ()
    assert library.discard(library.numbered()) == ("b", "walk")
    assert library.entries == ()


def test_free_names_depend_on_the_current_library(tmp_path):
    path = tmp_path / "a.clips"
    with open_clip_library(path) as one, open_clip_library(path) as other:
        assert one.entries == other.entries == ()
        other.add([clip("walk", "wave", "/a/walk.bvh")])

        named = one.add_described(
            [describe_clip(clip("walk", "kick", "/b/walk.bvh"))],
            free_name=lambda entry, taken: f"not {sorted(taken)}",
        )

    assert named == ("not ['walk']",)


@pytest.mark.parametrize("name", ["x.bat", "x", "x.clips.sh", ".clips", "walk.bvh"])
def test_library_is_not_created_without_its_suffix(tmp_path, name):
    for _ in range(2):
        with pytest.raises(InvalidFileError, match=r"end its name in \.clips"):
            open_clip_library(tmp_path / name)
        assert not [path for path in tmp_path.iterdir() if path.stat().st_size]
        (tmp_path / name).touch()


@pytest.mark.parametrize("name", ["a.clips", "a.library", "A.CLIPS"])
def test_library_is_created_with_its_suffix(tmp_path, name):
    open_clip_library(tmp_path / name).close()
    assert load_clip_library(tmp_path / name).entries == ()


@pytest.mark.skipif(sys.platform == "win32", reason="needs links")
def test_library_is_not_created_by_a_link_to_another_suffix(tmp_path):
    (tmp_path / "a.clips").symlink_to(tmp_path / "x.bat")
    with pytest.raises(InvalidFileError, match="end its name"):
        open_clip_library(tmp_path / "a.clips")
    assert not (tmp_path / "x.bat").exists()


def test_older_library_with_any_suffix_is_opened(tmp_path):
    build_clip_library([clip("walk", "wave", "/a/walk.bvh")]).save(tmp_path / "my library")
    with open_clip_library(tmp_path / "my library") as library:
        library.add([clip("run", "kick", "/a/run.bvh")])
        assert names(library) == ["walk", "run"]


def test_database_of_another_program_stays_unchanged(tmp_path):
    path = tmp_path / "other.clips"
    with closing(sqlite3.connect(path)) as database:
        database.execute("PRAGMA user_version = 7")
    before = path.read_bytes()
    assert before

    library_file.create_file(path)

    assert path.read_bytes() == before
    with pytest.raises(InvalidFileError, match="is not a clip library"):
        open_clip_library(path)


def test_full_disk_is_reported_and_the_library_unchanged(tmp_path):
    path = tmp_path / "a.clips"
    with open_clip_library(path) as library:
        library.add([clip("walk", "wave", "/a/walk.bvh")])
        (pages,) = library._database.execute("PRAGMA page_count").fetchone()
        library._database.execute(f"PRAGMA max_page_count = {pages}")
        more = [clip(f"{number}", "kick", f"/a/{number}.bvh") for number in range(9)]

        with pytest.raises(InvalidFileError, match=r"cannot be written: the disk is full"):
            library.add(more)

        assert names(library) == ["walk"]
        library._database.execute("PRAGMA max_page_count = 100000")
        library.add(more)
        assert len(library.entries) == 10


@pytest.mark.parametrize("existed", [False, True])
def test_full_disk_leaves_no_empty_library(tmp_path, monkeypatch, existed):
    path = tmp_path / "a.clips"
    if existed:
        path.touch()

    def one_page(database: sqlite3.Connection) -> None:
        database.execute("PRAGMA max_page_count = 1")
        create_tables(database)

    monkeypatch.setattr(library_file, "create_tables", one_page)

    with pytest.raises(InvalidFileError, match="the disk is full"):
        open_clip_library(path)

    assert path.exists() == existed


def test_other_failures_leave_a_file_that_another_process_may_be_filling(tmp_path, monkeypatch):
    def fail(database: sqlite3.Connection) -> None:
        raise sqlite3.OperationalError("disk I/O error")

    monkeypatch.setattr(library_file, "create_tables", fail)
    path = tmp_path / "a.clips"

    with pytest.raises(InvalidFileError):
        open_clip_library(path)

    assert path.exists()


def test_full_disk_is_reported_where_the_empty_library_stays(tmp_path, monkeypatch):
    def one_page(database: sqlite3.Connection) -> None:
        database.execute("PRAGMA max_page_count = 1")
        create_tables(database)

    def fail(path, **_):
        raise PermissionError(path)

    monkeypatch.setattr(library_file, "create_tables", one_page)
    monkeypatch.setattr("pathlib.Path.unlink", fail)

    with pytest.raises(InvalidFileError, match="the disk is full"):
        open_clip_library(tmp_path / "a.clips")


def test_solver_error_is_not_reported_as_damage(tmp_path, monkeypatch):
    def fail(*_):
        raise ValueError("a mistake of ours")

    monkeypatch.setattr(index_clips, "learn_vocabulary", fail)
    with open_clip_library(tmp_path / "a.clips") as library:
        with pytest.raises(ValueError, match="a mistake of ours") as caught:
            library.add([clip("walk", "wave", "/a/walk.bvh")])
        assert not isinstance(caught.value, InvalidFileError)
        assert library.entries == ()


@pytest.mark.parametrize(
    "change",
    [
        "tags = '{\"a\": 1}'", "tags = 'x'", "tags = '[1]'", "name = x'00ff'", "frame_rate = 0",
        "n_frames = 'many'", "n_frames = -1", "positions = x'007c'", "course = 'words'",
    ],
)  # fmt: skip
def test_invalid_stored_value_is_damage(tmp_path, change):
    path = tmp_path / "a.clips"
    build_clip_library([clip("walk", "wave", "/a/walk.bvh")]).save(path)
    with closing(sqlite3.connect(path)) as database, database:
        database.execute(f"UPDATE clips SET {change}")

    with (
        pytest.raises(InvalidFileError, match="is damaged"),
        load_clip_library(path) as library,
    ):
        library.postures(*library.numbered())


def test_segment_beyond_the_end_of_its_clip_is_damage(tmp_path):
    path, query = tmp_path / "a.clips", clip("walk", "wave", "/a/walk.bvh")
    build_clip_library([query]).save(path)
    with closing(sqlite3.connect(path)) as database, database:
        segment = struct.pack("<2i", 10_000, 10_001)
        database.execute("UPDATE blocks SET frames = ?", [segment])

    with (
        load_clip_library(path) as library,
        pytest.raises(InvalidFileError, match="is damaged"),
    ):
        find_similar(query.recording, library)


def test_clip_removed_by_another_process_is_reported():
    library = build_clip_library([clip("walk", "wave", "/a/walk.bvh")])
    (number,) = library.numbered()
    library.discard([number])
    with pytest.raises(InvalidMotionError, match="has just removed"):
        library.postures(number)
