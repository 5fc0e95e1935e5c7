"""Libraries that this user keeps current are indexed by themselves; no file asks for it."""

import json
import time

import pytest


@pytest.fixture(autouse=True)
def permissions(load, tmp_path, monkeypatch):
    """Permissions of this test alone."""
    module = load("mocap_assist.permissions")
    monkeypatch.setattr(module, "_file", lambda: tmp_path / "permissions.json")
    return module


@pytest.fixture
def library(blank, clip_files):
    """Settings of a library in this scene, whose file lies among the sources."""
    settings = blank.context.scene.mocap_assist.library
    settings.sources, settings.library_file = str(clip_files), str(clip_files / "my.clips")
    return settings


@pytest.fixture
def keep(blank):
    """Press Keep Current."""

    def press():
        assert blank.ops.mocap_assist.keep_current() == {"FINISHED"}

    return press


@pytest.fixture
def look(load, monkeypatch):
    """Let so many looks pass, each until its end; return how often something was indexed."""
    keeping = load("mocap_assist.library.keeping")
    started = []
    begin = keeping.Indexing.__init__
    monkeypatch.setattr(
        keeping.Indexing, "__init__",
        lambda *given: started.append("Index") or begin(*given),
    )  # fmt: skip

    def look(times):
        started.clear()
        for _ in range(times):
            keeping.look()
            while keeping._running:
                time.sleep(0.02)
                keeping.look()
            for keeper in keeping._keepers.values():
                keeper._look.result(timeout=10)
        return len(started)

    yield look
    keeping.unregister()
    keeping.register()


def test_it_is_indexed_once_when_there_is_something_new(
    look, library, keep, clip_files, entries
):
    keep()
    assert look(6) == 1
    assert len(entries(clip_files / "my.clips")) == 6

    (clip_files / "walk_0.bvh").rename(clip_files / "stroll.bvh")
    assert look(6) == 1
    assert "stroll" in entries(clip_files / "my.clips")


def test_not_while_a_file_is_being_written(look, library, keep, clip_files):
    keep()
    look(6)
    with (clip_files / "long.bvh").open("w") as file:
        for line in range(4):
            file.write(f"line {line}")
            file.flush()
            assert look(1) == 0


def test_a_file_from_elsewhere_starts_and_writes_nothing(look, library, blank, clip_files):
    """It names sources and a library, as one that was saved where Keep Current was on."""
    library.library_file = "//startup/x.bat"
    blank.data.actions.new("x\r\necho pwned\r\nrem ")
    gift = clip_files / "gift.blend"
    blank.ops.wm.save_as_mainfile(filepath=str(gift))
    before = sorted(clip_files.rglob("*"))
    blank.ops.wm.open_mainfile(filepath=str(gift), use_scripts=False)

    assert look(6) == 0
    assert sorted(clip_files.rglob("*")) == before


def test_another_file_does_not_change_what_is_kept(look, library, keep, blank, clip_files):
    keep()
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    blank.context.scene.mocap_assist.library.sources = "//somewhere/else"

    assert look(6) == 1
    assert (clip_files / "my.clips").is_file()


def test_pressing_again_ends_it(look, library, keep, clip_files):
    keep()
    keep()

    assert look(4) == 0
    assert not (clip_files / "my.clips").exists()


def test_the_button_shows_whether_these_sources_are_kept(library, keep, load, blank):
    are_kept = load("mocap_assist.library.kept_libraries").choices_are_kept
    assert not are_kept(library.settings().choices)
    keep()
    assert are_kept(library.settings().choices)
    blank.ops.mocap_assist.add_source_folder(directory="/elsewhere")
    assert "/elsewhere" in library.sources and are_kept(library.settings().choices)

    library.sources = "/written/by/a/file"

    assert not are_kept(library.settings().choices)


def test_a_library_without_sources_is_no_longer_kept(library, keep, load, blank):
    keep()
    blank.ops.mocap_assist.remove_source(index=0)

    assert not load("mocap_assist.library.kept_libraries").kept_libraries()


def test_nothing_to_keep_is_refused(library, blank):
    library.sources = ""
    with pytest.raises(RuntimeError, match="Nothing is listed to index"):
        blank.ops.mocap_assist.keep_current()


def test_it_goes_on_where_files_cannot_be_looked_at(look, library, keep, clip_files):
    keep()
    (clip_files / "lost.bvh").symlink_to(clip_files / "nowhere.bvh")

    assert look(6) == 1


def test_two_libraries_are_kept(look, library, keep, tmp_path, entries):
    names = ("one.clips", "other.clips")
    for name in names:
        library.library_file = str(tmp_path / name)
        keep()

    assert look(8) == 2
    for name in names:
        assert len(entries(tmp_path / name)) == 6


def test_a_refusal_is_shown_and_does_not_end_the_looking(
    look, library, keep, blank, clip_files
):
    (clip_files / "in_the_way").write_text("a file where a folder should be")
    library.library_file = str(clip_files / "in_the_way" / "my.clips")
    keep()

    assert look(3) == 1
    assert "my.clips" in blank.context.window_manager.mocap_assist_indexing.said


def test_a_source_whose_name_begins_like_the_library_counts(look, library, keep, clip_files):
    library.sources = str(clip_files / "my.clips-takes")
    (clip_files / "my.clips-takes").mkdir()
    (clip_files / "walk_0.bvh").rename(clip_files / "my.clips-takes" / "walk.bvh")
    keep()

    assert look(6) == 1
    assert look(6) == 0


def test_a_place_that_cannot_be_looked_at_does_not_hide_the_others(
    look, library, keep, clip_files
):
    library.sources = f"{clip_files / ('long' * 100)}; {clip_files}"
    keep()

    assert look(3) == 1


def test_it_waits_for_another_solve(load, library, keep, monkeypatch):
    keep()
    keeping = load("mocap_assist.library.keeping")
    monkeypatch.setattr(keeping, "why_busy", lambda: "Track runs.")

    for _ in range(4):
        keeping.look()

    assert not keeping._keepers


def test_a_file_that_is_opened_meanwhile_only_delays_it(
    load, library, keep, blank, clip_files, entries, look
):
    keeping = load("mocap_assist.library.keeping")
    keep()
    while not keeping._running:
        keeping.look()
        for keeper in keeping._keepers.values():
            keeper._look.result(timeout=10)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert look(4) == 1
    assert len(entries(clip_files / "my.clips")) == 6


@pytest.mark.parametrize(
    "stored",
    [
        "",
        "{",
        "[" * 100_000,
        "[]",
        '{"kept_libraries": 3}',
        '{"kept_libraries": [{"library": 1}]}',
    ],
    ids=["empty", "cut", "deep", "list", "number", "other keys"],
)
def test_damaged_permissions_allow_nothing(permissions, load, stored):
    permissions._file().write_text(stored)

    assert load("mocap_assist.library.kept_libraries").kept_libraries() == []
    assert not permissions.recording_allowed("/x")


def test_permissions_are_kept_in_a_file_of_this_machine(permissions, library, keep, clip_files):
    keep()
    permissions.allow_recording("//depth.mkv")

    stored = json.loads(permissions._file().read_text())
    assert stored["kept_libraries"][0]["library"] == str(clip_files / "my.clips")
    assert permissions.recording_allowed("//depth.mkv")


def test_the_extension_can_be_switched_off_after_the_looking_has_ended(load):
    keeping = load("mocap_assist.library.keeping")
    keeping.unregister()
    keeping.unregister()
    keeping.register()
