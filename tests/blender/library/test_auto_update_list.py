"""Which libraries are kept current, as this user said on this machine; no file asks for it."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("permissions")


def test_a_file_from_elsewhere_starts_and_writes_nothing(look, library, blank, clip_files):
    """It names sources and a library, as one that was saved where Keep Current was on."""
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

    assert look(6) == 0
    assert sorted(clip_files.rglob("*")) == before


def test_pressing_again_ends_it(look, library, keep, clip_files):
    keep()
    keep()

    assert look(4) == 0
    assert not (clip_files / "my.clips").exists()


def test_the_button_shows_whether_these_sources_are_kept(library, keep, load, blank):
    are_kept = load("mocap_assist.library.auto_update_list").choices_are_kept
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

    assert not load("mocap_assist.library.auto_update_list").auto_updated_libraries()


def test_nothing_to_keep_is_refused(library, blank):
    library.sources = ""
    with pytest.raises(RuntimeError, match="No sources are listed"):
        blank.ops.mocap_assist.keep_current()


def test_it_waits_for_another_solve(load, library, keep, monkeypatch):
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


def test_permissions_are_kept_in_a_file_of_this_machine(permissions, library, keep, clip_files):
    keep()
    permissions.allow_recording("//depth.mkv")

    stored = json.loads(permissions._file().read_text())
    assert stored["kept_libraries"][0]["library"] == str(clip_files / "my.clips")
    assert permissions.recording_allowed("//depth.mkv")


def test_the_extension_can_be_switched_off_after_the_looking_has_ended(load):
    auto_update = load("mocap_assist.library.auto_update")
    auto_update.unregister()
    auto_update.unregister()
    auto_update.register()
