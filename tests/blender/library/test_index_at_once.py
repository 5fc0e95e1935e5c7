"""Two Blenders may index into one library at once; odd names keep nothing else out of it."""

import pytest


@pytest.fixture
def twin(blend_file, tmp_path):
    """Another file of the same name and actions, in another folder."""
    other = tmp_path / "other"
    other.mkdir()
    (other / "shot.blend").write_bytes(blend_file.read_bytes())
    return other / "shot.blend"


def test_all_clips_are_added_when_another_process_indexes_the_same_name(
    index, entries, blend_file, twin, load, monkeypatch
):
    indexing = load("mocap_assist.library.solve_indexing")
    describe, others = indexing.describe_clip, [twin]

    def describe_while_another_indexes(clip):
        if others:
            index(others.pop())
        return describe(clip)

    monkeypatch.setattr(indexing, "describe_clip", describe_while_another_indexes)

    done = index(blend_file)

    assert (done.n_clips, done.n_added, done.n_removed) == (6, 3, 0)
    found = [(entry.origin.path, entry.origin.item) for entry in entries().values()]
    assert len(set(found)) == 6
    assert {path for path, _ in found} == {str(blend_file), str(twin)}


def test_action_with_control_characters_is_refused_and_the_others_become_clips(
    blank, index, entries, blend_file
):
    blank.ops.wm.open_mainfile(filepath=str(blend_file))
    blank.data.actions["squat_0"].name = "x\r\necho pwned\r\nrem "
    blank.ops.wm.save_mainfile()

    done = index(blend_file)

    assert sorted(entries()) == ["shot/walk_0", "shot/wave_0"]
    (message,) = done.refused
    assert r"x\r\necho pwned\r\nrem" in message and message.isprintable()


def test_library_of_another_suffix_is_refused_and_makes_no_folder(
    index, load, clip_files, tmp_path
):
    with pytest.raises(load("solvers.errors").InvalidFileError, match="end its name in"):
        index(clip_files, library=tmp_path / "Startup" / "x.bat")

    assert not (tmp_path / "Startup").exists()


@pytest.mark.parametrize("fault", ["ProcessDied", "OutOfMemoryError"])
def test_file_that_ends_its_blender_is_refused_and_the_others_become_clips(
    index, entries, blend_file, twin, load, monkeypatch, fault
):
    indexing = load("mocap_assist.library.solve_indexing")
    real, job = indexing.read_blends, load("mocap_assist.jobs.job")
    errors = {
        "ProcessDied": lambda: job.ProcessDied("signal SIGABRT", ""),
        "OutOfMemoryError": lambda: job.OutOfMemoryError(),
    }

    def read(blender, paths, **options):
        if str(twin) in paths:
            raise errors[fault]()
        return real(blender, paths, **options)

    monkeypatch.setattr(indexing, "read_blends", read)

    done = index(blend_file, twin)

    assert len(entries()) == 3
    (message,) = done.refused
    assert str(twin) in message
