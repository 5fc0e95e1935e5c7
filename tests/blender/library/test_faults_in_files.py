"""A fault of ours over one .blend file or action leaves the others in the library."""

import os
import shutil
from pathlib import Path

import pytest

FAULT = "this is a bug in Mocap Assist (IndexError at "


@pytest.fixture
def failing(load, monkeypatch):
    """`failing(name, when)`: a function of the reader raises where `when` says so."""
    blend_clips = load("mocap_assist.library.blend_clips")

    def spoil(name, when):
        works = getattr(blend_clips, name)

        def work(*words):
            if when(*words):
                raise IndexError
            return works(*words)

        monkeypatch.setattr(blend_clips, name, work)

    return spoil


def test_other_actions_of_a_file_are_read_when_one_raises(load, blend_file, failing):
    failing("read_source", lambda scene, armature, source, root: source[0].name == "wave_0")

    (read,) = load("mocap_assist.library.blend_clips").read_files([str(blend_file)], False, ())

    assert sorted(clip.item for clip in read.clips) == ["squat_0", "walk_0"]
    (sentence,) = read.refused
    assert sentence.startswith(f"{blend_file}, wave_0: {FAULT}")


def test_other_files_are_read_when_one_raises(load, blend_file, failing, tmp_path):
    twin = shutil.copy(blend_file, tmp_path / "twin.blend")
    opened = iter([True, False])
    failing("actions_of", lambda assets_only: next(opened))

    odd, intact = load("mocap_assist.library.blend_clips").read_files(
        [str(blend_file), str(twin)], False, ()
    )

    assert odd.clips == () and odd.refused[0].startswith(f"{blend_file}: {FAULT}")
    assert len(intact.clips) == 3 and intact.refused == ()


def test_file_name_that_is_not_utf_8_is_refused_and_others_are_read(load, index, blend_file):
    odd = blend_file.with_name(os.fsdecode(b"caf\xe9.blend"))
    shutil.copy(blend_file, odd)

    done = index(blend_file.parent)

    assert done.n_clips == 3
    (sentence,) = done.refused
    assert r"caf\udce9.blend' is not valid UTF-8" in sentence


def test_other_clips_are_indexed_when_one_cannot_be_described(
    load, index, blend_file, monkeypatch
):
    indexing = load("mocap_assist.library.solve_indexing")
    real = indexing.describe_clip

    def fail(clip):
        if clip.name.endswith("wave_0"):
            raise IndexError
        return real(clip)

    monkeypatch.setattr(indexing, "describe_clip", fail)

    done = index(blend_file)

    assert done.n_clips == 2
    (sentence,) = done.refused
    assert sentence.startswith(f"{blend_file}, wave_0: {FAULT}")


def test_other_files_are_indexed_when_one_is_deleted_meanwhile(
    load, index, blend_file, clip_files, monkeypatch
):
    indexing = load("mocap_assist.library.solve_indexing")
    gone = Path(shutil.copy(blend_file, blend_file.with_name("gone.blend")))
    index_files = indexing.index_files

    def remove_one(*given, **named):
        gone.unlink()
        return index_files(*given, **named)

    monkeypatch.setattr(indexing, "index_files", remove_one)

    done = index(blend_file.parent, clip_files)

    assert done.n_clips == 9
    assert done.refused == (f"{gone}: No such file or directory.",)


def test_other_sources_are_indexed_when_one_is_a_circular_link(index, blend_file, clip_files):
    circle = blend_file.parent.parent / "circle"
    circle.symlink_to(circle)

    done = index(circle, clip_files, circle / "inside.blend")

    assert done.n_clips == 6
    assert [each.partition(": ")[0] for each in done.refused] == [
        str(circle), str(circle / "inside.blend"),
    ]  # fmt: skip
    assert "fault of Mocap Assist" not in " ".join(done.refused)


@pytest.fixture
def closed(tmp_path, monkeypatch):
    """A folder that cannot be opened; root could open any."""
    folder, stat = tmp_path / "closed", Path.stat
    folder.mkdir()

    def refuse(self, **named):
        if folder in self.parents:
            raise PermissionError(13, "Permission denied", str(self))
        return stat(self, **named)

    monkeypatch.setattr(Path, "stat", refuse)
    return folder


def test_other_sources_are_indexed_when_one_is_unreadable(index, clip_files, closed):
    done = index(closed / "takes", clip_files, closed / "shot.blend")

    assert done.n_clips == 6
    assert done.refused == tuple(
        f"{closed / name}: Permission denied." for name in ("takes", "shot.blend")
    )


def test_library_or_rig_in_an_unreadable_folder_is_refused(load, index, clip_files, closed):
    refused = load("solvers.errors").InvalidFileError
    with pytest.raises(refused, match=r"my\.clips cannot be kept there: Permission denied\."):
        index(clip_files, library=closed / "my.clips")
    with pytest.raises(refused, match=r"rig\.blend, does not exist"):
        index(clip_files, rig=closed / "rig.blend")
