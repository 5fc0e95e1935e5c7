"""Sources that change are indexed again by themselves; without a window Index does not wait."""

import pytest


@pytest.fixture
def library(blank, clip_files):
    """Settings of the library in this scene, whose file lies among the sources."""
    settings = blank.context.scene.mocap_assist.library
    settings.sources, settings.library_file = str(clip_files), str(clip_files / "my.clips")
    settings.keep_current = True
    return settings


@pytest.fixture
def look(load, blank, monkeypatch, library):
    """Let so many quarters of a minute pass; return the state of what Index has said."""
    keeping = load("mocap_assist.library.keeping")
    monkeypatch.setattr(keeping, "_keeper", [])
    pressed = []
    ask = keeping.Keeper.wants
    monkeypatch.setattr(
        keeping.Keeper, "wants",
        lambda *given: ask(*given) and (pressed.append("Index") or True),
    )  # fmt: skip

    def look(times):
        pressed.clear()
        for _ in range(times):
            keeping.keep(blank.context.scene)
            for keeper in keeping._keeper:
                keeper._look.result(timeout=10)
        return len(pressed)

    yield look
    for keeper in keeping._keeper:
        keeper.stop()


def test_it_is_pressed_once_when_there_is_something_new(look, library, clip_files, entries):
    assert look(6) == 1
    assert len(entries(clip_files / "my.clips")) == 6

    (clip_files / "walk_0.bvh").rename(clip_files / "stroll.bvh")
    assert look(6) == 1
    assert "stroll" in entries(clip_files / "my.clips")


def test_not_while_a_file_is_being_written(look, clip_files):
    look(6)
    with (clip_files / "long.bvh").open("w") as file:
        for line in range(4):
            file.write(f"line {line}")
            file.flush()
            assert look(1) == 0


def test_not_unless_asked_for(look, library, clip_files):
    library.keep_current = False
    assert look(4) == 0

    library.keep_current, library.sources = True, ""
    assert look(4) == 0
    assert not (clip_files / "my.clips").exists()


def test_it_goes_on_where_files_cannot_be_looked_at(look, clip_files):
    (clip_files / "lost.bvh").symlink_to(clip_files / "nowhere.bvh")

    assert look(6) == 1


def test_another_library_is_filled_too(look, library, clip_files, entries):
    look(6)
    library.library_file = str(clip_files / "other.clips")

    assert look(6) == 1
    assert len(entries(clip_files / "other.clips")) == 6


def test_a_refusal_is_shown_and_does_not_end_the_looking(look, library, blank, clip_files):
    (clip_files / "in_the_way").write_text("a file where a folder should be")
    library.library_file = str(clip_files / "in_the_way" / "my.clips")

    assert look(3) == 1
    assert "my.clips" in blank.context.window_manager.mocap_assist_indexing.said


def test_a_source_beside_the_library_that_begins_like_it_counts(look, library, clip_files):
    library.sources = str(clip_files / "my.clips-takes")
    (clip_files / "my.clips-takes").mkdir()
    (clip_files / "walk_0.bvh").rename(clip_files / "my.clips-takes" / "walk.bvh")

    assert look(6) == 1
    assert look(6) == 0


def test_a_place_that_cannot_be_looked_at_does_not_hide_the_others(look, library, clip_files):
    library.sources = f"{clip_files / ('long' * 100)}; {clip_files}"

    assert look(3) == 1


def test_it_waits_for_another_solve(load, look, monkeypatch):
    keeping = load("mocap_assist.library.keeping")
    monkeypatch.setattr(keeping, "why_busy", lambda: "Track runs.")
    assert look(4) == 0
    monkeypatch.undo()


def test_the_extension_can_be_switched_off_after_the_looking_has_ended(load):
    keeping = load("mocap_assist.library.keeping")
    keeping.unregister()
    keeping.unregister()
    keeping.register()
