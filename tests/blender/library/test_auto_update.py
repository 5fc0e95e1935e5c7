"""Libraries that this user keeps current are indexed automatically."""

import pytest

pytestmark = pytest.mark.usefixtures("permissions")


def test_changed_folder_is_indexed_once(poll, library, keep, clip_files, entries):
    keep()
    assert poll(6) == 1
    assert len(entries(clip_files / "my.clips")) == 6

    (clip_files / "walk_0.bvh").rename(clip_files / "stroll.bvh")
    assert poll(6) == 1
    assert "stroll" in entries(clip_files / "my.clips")


def test_library_is_not_indexed_while_a_file_is_written(poll, library, keep, clip_files):
    keep()
    poll(6)
    with (clip_files / "long.bvh").open("w") as file:
        for line in range(4):
            file.write(f"line {line}")
            file.flush()
            assert poll(1) == 0


def test_opening_another_file_keeps_the_updated_libraries(
    poll, library, keep, blank, clip_files
):
    keep()
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    blank.context.scene.mocap_assist.library.sources = "//somewhere/else"

    assert poll(6) == 1
    assert (clip_files / "my.clips").is_file()


def test_update_continues_with_a_broken_link(poll, library, keep, clip_files):
    keep()
    (clip_files / "lost.bvh").symlink_to(clip_files / "nowhere.bvh")

    assert poll(6) == 1


def test_two_libraries_are_updated(poll, library, keep, tmp_path, entries):
    names = ("one.clips", "other.clips")
    for name in names:
        library.library_file = str(tmp_path / name)
        keep()

    assert poll(8) == 2
    for name in names:
        assert len(entries(tmp_path / name)) == 6


def test_refusal_is_shown_and_updates_continue(poll, library, keep, blank, clip_files):
    (clip_files / "in_the_way").write_text("a file where a folder should be")
    library.library_file = str(clip_files / "in_the_way" / "my.clips")
    keep()

    assert poll(3) == 1
    assert "my.clips" in blank.context.window_manager.mocap_assist_indexing.report


def test_source_with_the_library_name_as_prefix_is_checked(poll, library, keep, clip_files):
    library.sources = str(clip_files / "my.clips-takes")
    (clip_files / "my.clips-takes").mkdir()
    (clip_files / "walk_0.bvh").rename(clip_files / "my.clips-takes" / "walk.bvh")
    keep()

    assert poll(6) == 1
    assert poll(6) == 0


def test_invalid_source_does_not_hide_the_others(poll, library, keep, clip_files):
    library.sources = f"{clip_files / ('long' * 100)}; {clip_files}"
    keep()

    assert poll(3) == 1


def test_opening_a_file_delays_the_update(
    load, library, keep, blank, clip_files, entries, poll
):
    auto_update = load("mocap_assist.library.auto_update")
    keep()
    while not auto_update._running:
        auto_update.update_libraries()
        for watcher in auto_update._watchers.values():
            watcher._scan.result(timeout=500)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert poll(4) == 1
    assert len(entries(clip_files / "my.clips")) == 6
