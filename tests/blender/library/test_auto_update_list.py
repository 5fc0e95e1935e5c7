"""Libraries that this user keeps current on this machine; no file can request it."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("permissions")


def test_received_file_starts_and_writes_nothing(poll, library, blank, clip_files):
    """It names sources and a library, as a file saved with Keep Current on."""
    library.library_file = "//startup/x.clips"
    stored = getattr(library, "bl_system_properties_get", lambda: library)()
    stored["keep_current"] = True  # which began it in earlier versions
    blank.data.actions.new("x\r\necho pwned\r\nrem ")
    gift = clip_files / "gift.blend"
    blank.ops.wm.save_as_mainfile(filepath=str(gift))
    before = sorted(clip_files.rglob("*"))
    blank.ops.wm.open_mainfile(filepath=str(gift), use_scripts=False)
    settings = blank.context.scene.mocap_assist.library
    stored = getattr(settings, "bl_system_properties_get", lambda: settings)()
    assert stored["keep_current"] and settings.sources == str(clip_files)

    assert poll(6) == 0
    assert sorted(clip_files.rglob("*")) == before


def test_second_press_ends_the_updates(poll, library, keep, clip_files):
    keep()
    keep()

    assert poll(4) == 0
    assert not (clip_files / "my.clips").exists()


def test_button_shows_whether_these_sources_are_updated(library, keep, load, blank):
    is_updated = load("mocap_assist.library.auto_update_list").choices_are_kept
    assert not is_updated(library.settings().choices)
    keep()
    assert is_updated(library.settings().choices)
    blank.ops.mocap_assist.add_source_folder(directory="/elsewhere")
    assert "/elsewhere" in library.sources and is_updated(library.settings().choices)

    library.sources = "/written/by/a/file"

    assert not is_updated(library.settings().choices)


def test_library_without_sources_is_not_updated(library, keep, load, blank):
    keep()
    blank.ops.mocap_assist.remove_source(index=0)

    assert not load("mocap_assist.library.auto_update_list").auto_updated_libraries()


def test_keep_current_raises_without_sources(library, blank):
    library.sources = ""
    with pytest.raises(RuntimeError, match="No sources are listed"):
        blank.ops.mocap_assist.keep_current()


def test_update_waits_for_another_solve(load, library, keep, monkeypatch):
    keep()
    auto_update = load("mocap_assist.library.auto_update")
    monkeypatch.setattr(auto_update, "why_busy", lambda: "Track runs.")

    for _ in range(4):
        auto_update.update_libraries()

    assert not auto_update._watchers


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

    assert load("mocap_assist.library.auto_update_list").auto_updated_libraries() == []
    assert not permissions.recording_allowed("/x")


def test_permissions_are_stored_on_this_machine(permissions, library, keep, clip_files):
    keep()
    permissions.allow_recording("//depth.mkv")

    stored = json.loads(permissions._file().read_text())
    assert stored["kept_libraries"][0]["library"] == str(clip_files / "my.clips")
    assert permissions.recording_allowed("//depth.mkv")


def test_extension_can_be_disabled_after_the_updates_have_ended(load):
    auto_update = load("mocap_assist.library.auto_update")
    auto_update.unregister()
    auto_update.unregister()
    auto_update.register()
