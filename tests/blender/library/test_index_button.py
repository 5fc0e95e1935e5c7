"""The button Index runs in the background and reads nothing of the scene."""

import tempfile
import time
from types import SimpleNamespace

import pytest
from modal_events import event


@pytest.fixture
def library(blank, tmp_path):
    """Settings of the library in this scene, with a file of its own."""
    settings = blank.context.scene.mocap_assist.library
    settings.library_file = str(tmp_path / "own" / "clips.library")
    return settings


def test_index_uses_sources_tags_and_asset_libraries(blank, clip_files, blend_file, entries):
    library = blank.context.scene.mocap_assist.library
    library.library_file = str(clip_files.parent / "own" / "clips.library")
    library.sources, library.tags = f"{clip_files}; ", "take one, hall"
    assets = blank.context.preferences.filepaths.asset_libraries
    added = assets.new(name="Shots", directory=str(blend_file.parent))
    library.asset_libraries = True
    try:
        assert blank.ops.mocap_assist.index_library() == {"FINISHED"}
    finally:
        assets.remove(added)

    found = entries(clip_files.parent / "own" / "clips.library")
    assert len(found) == 7 and "shot/wave_0" in found
    assert found["walk_0"].tags == ("take one", "hall")


def test_index_reports_missing_sources(blank, library):
    with pytest.raises(RuntimeError, match="No sources are listed"):
        blank.ops.mocap_assist.index_library()


def test_default_library_is_in_the_user_folder(load, blank):
    sources = load("mocap_assist.library.sources")
    choices = load("mocap_assist.library.button_settings").LibraryChoices()

    path = sources.library_path(choices)

    assert path.name == "clips.library"
    assert str(path.parent) == blank.utils.extension_path_user(sources.EXTENSION)


def test_sources_are_added_and_removed(blank, library, tmp_path):
    add = blank.ops.mocap_assist
    add.add_source_folder(directory=str(tmp_path))
    add.add_source_files(directory=str(tmp_path), files=[{"name": "a.blend"}])
    add.add_source_folder(directory=str(tmp_path))
    assert library.sources == f"{tmp_path}; {tmp_path / 'a.blend'}"

    add.remove_source(index=0)
    assert library.sources == str(tmp_path / "a.blend")


@pytest.fixture
def waiting(load, blank, monkeypatch, tmp_path, clip_files):
    """Index, pressed in a window that only pretends to be one."""
    (tmp_path / "jobs").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "jobs"))
    module = load("mocap_assist.library.index_operator")
    button_settings = load("mocap_assist.library.button_settings")
    monkeypatch.setattr(module, "in_background", lambda: False)
    state = blank.context.window_manager.mocap_assist_indexing
    timers, reports = [], []
    manager = SimpleNamespace(
        event_timer_add=lambda *_, **__: timers.append("timer") or "timer",
        event_timer_remove=timers.remove,
        modal_handler_add=lambda _: None,
        mocap_assist_indexing=state,
        windows=[],
    )
    context = SimpleNamespace(scene=blank.context.scene, window=None, window_manager=manager)
    path = tmp_path / "clips.library"

    class Operator(module.WaitingIndex):
        setting_names = ()

        def settings(self):
            return button_settings.LibraryBundle(
                button_settings.LibraryChoices(library_file=str(path), sources=str(clip_files))
            )

        def report(self, kind, message):
            reports.append((kind, message))

    operator = Operator()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    return SimpleNamespace(
        operator=operator, context=context, state=state, timers=timers, reports=reports,
        path=path, jobs=tmp_path / "jobs",
    )  # fmt: skip


def test_window_stays_responsive_during_indexing(waiting, blank, entries):
    assert waiting.state.running
    assert not blank.ops.mocap_assist.index_library.poll()
    outcomes = set()
    while waiting.state.running:
        for each in (event("LEFTMOUSE", "PRESS"), event("TIMER")):
            if waiting.state.running:
                outcomes |= waiting.operator.modal(waiting.context, each)
        time.sleep(0.05)

    assert outcomes == {"PASS_THROUGH", "FINISHED"}
    assert waiting.state.report == "The library has 6 clips: 6 read."
    assert waiting.reports == [({"INFO"}, waiting.state.report)]
    assert not waiting.timers and not list(waiting.jobs.iterdir())
    assert len(entries(waiting.path)) == 6
    assert blank.ops.mocap_assist.index_library.poll()


def test_escape_cancels_indexing(waiting):
    assert waiting.operator.modal(waiting.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert waiting.reports == [({"INFO"}, "Cancelled.")]
    assert not (waiting.state.running or waiting.timers or list(waiting.jobs.iterdir()))


def test_opening_another_file_ends_indexing(waiting, blank):
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    waiting.context.window_manager.mocap_assist_indexing = (
        blank.context.window_manager.mocap_assist_indexing
    )
    waiting.operator.cancel(waiting.context)

    assert not waiting.timers

    assert not list(waiting.jobs.iterdir())
    assert not blank.context.window_manager.mocap_assist_indexing.running
