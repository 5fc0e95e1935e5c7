"""A fault of ours over one .blend file or action leaves the others in the library."""

import os
import shutil

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


def test_the_other_actions_of_a_file_are_read_when_one_raises(load, blend_file, failing):
    failing("read_source", lambda scene, armature, source: source[0].name == "wave_0")

    (read,) = load("mocap_assist.library.blend_clips").read_files([str(blend_file)], False, ())

    assert sorted(clip.item for clip in read.clips) == ["squat_0", "walk_0"]
    (sentence,) = read.refused
    assert sentence.startswith(f"{blend_file}, wave_0: {FAULT}")


def test_the_other_files_are_read_when_one_raises(load, blend_file, failing, tmp_path):
    twin = shutil.copy(blend_file, tmp_path / "twin.blend")
    opened = iter([True, False])
    failing("actions_of", lambda assets_only: next(opened))

    odd, whole = load("mocap_assist.library.blend_clips").read_files(
        [str(blend_file), str(twin)], False, ()
    )

    assert odd.clips == () and odd.refused[0].startswith(f"{blend_file}: {FAULT}")
    assert len(whole.clips) == 3 and whole.refused == ()


def test_a_file_with_a_name_that_is_no_utf8_is_refused_and_the_others_are_not(
    load, index, blend_file
):
    odd = blend_file.with_name(os.fsdecode(b"caf\xe9.blend"))
    shutil.copy(blend_file, odd)

    done = index(blend_file.parent)

    assert done.n_clips == 3
    (sentence,) = done.refused
    assert r"caf\udce9.blend' is not valid UTF-8" in sentence


def test_the_other_clips_are_indexed_when_one_cannot_be_described(
    load, index, blend_file, monkeypatch
):
    indexing = load("mocap_assist.jobs.indexing")
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
