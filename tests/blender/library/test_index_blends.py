"""Actions in .blend files become clips of a library; read in another Blender."""

import os

import numpy as np
import pytest


def test_actions_become_clips_with_tags_and_catalog(index, entries, blend_file):
    done = index(blend_file.parent, tags=("studio",))

    found = entries()
    assert (done.n_clips, done.n_added, done.refused) == (3, 3, ())
    assert sorted(found) == ["shot/squat_0", "shot/walk_0", "shot/wave_0"]
    assert found["shot/wave_0"].tags == ("studio", "greeting", "Gestures/Hello")
    assert found["shot/walk_0"].tags == ("studio",)
    origin = found["shot/walk_0"].origin
    assert (origin.path, origin.item) == (str(blend_file), "walk_0")
    assert (found["shot/walk_0"].n_frames, found["shot/walk_0"].frame_rate) == (75, 30.0)


def test_only_assets_of_asset_libraries_are_indexed(index, entries, blend_file):
    index(blend_file.parent, assets_only=True)

    assert sorted(entries()) == ["shot/wave_0"]


def test_indexed_motion_equals_the_recording(load, index, blend_file, clip_motions, tmp_path):
    index(blend_file)
    retrieval = load("solvers.retrieval")
    with retrieval.load_clip_library(tmp_path / "clips.library") as library:
        found = {entry.name: number for number, entry in library.numbered().items()}
        stored = library.postures(found["shot/wave_0"]).positions
    wave = retrieval.describe_clip(retrieval.Clip("wave", clip_motions("wave", 0)))

    np.testing.assert_allclose(stored, wave.postures.positions, atol=2e-3)


def test_unchanged_files_are_not_read_again(index, entries, blend_file, monkeypatch, load):
    index(blend_file)
    indexing = load("mocap_assist.library.solve_indexing")
    read = []
    real = indexing.read_blends
    monkeypatch.setattr(
        indexing, "read_blends", lambda *a, **k: read.append(a[1]) or real(*a, **k)
    )

    again = index(blend_file)
    assert (again.n_kept, again.n_added, read) == (3, 0, [])

    assert index(blend_file, tags=("new",)).n_added == 3
    assert index(blend_file).n_kept == 3

    read.clear()
    os.utime(blend_file, ns=(1, 1))
    changed = index(blend_file)
    assert (changed.n_kept, changed.n_added, changed.n_removed) == (0, 3, 0)
    assert len(read) == 1 and len(entries()) == 3


def test_deleted_actions_are_removed_from_the_library(blank, index, entries, blend_file):
    index(blend_file)
    blank.ops.wm.open_mainfile(filepath=str(blend_file))
    blank.data.actions.remove(blank.data.actions["squat_0"])
    blank.ops.wm.save_mainfile()

    done = index(blend_file)

    assert (done.n_removed, sorted(entries())) == (1, ["shot/walk_0", "shot/wave_0"])


def test_a_deleted_file_stays_in_the_library_and_is_reported(index, entries, blend_file):
    index(blend_file)
    blend_file.unlink()

    done = index(blend_file)

    assert len(entries()) == 3
    assert done.refused == (f"There is no file or folder {blend_file}.",)


@pytest.mark.parametrize("content", [b"", b"no blend file at all", b"BLENDER-v405" + bytes(99)])
def test_an_invalid_blend_file_is_reported_and_others_are_read(
    index, entries, blend_file, content
):
    (blend_file.parent / "broken.blend").write_bytes(content)

    done = index(blend_file.parent)

    assert len(entries()) == 3
    (message,) = done.refused
    assert "broken.blend" in message


def test_actions_without_a_rig_or_a_body_are_refused(blank, index, entries, blend_file):
    blank.ops.wm.open_mainfile(filepath=str(blend_file))
    for name in ("walk_0", "squat_0", "wave_0"):
        action = blank.data.actions[name]
        action.use_fake_user = True
        if name != "wave_0":
            blank.data.objects.remove(blank.data.objects[name])
    bag = blank.data.actions["walk_0"].layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        curve.data_path = curve.data_path.replace('bones["', 'bones["Odd')
    blank.ops.object.camera_add()
    camera = blank.context.object
    camera.keyframe_insert("location", frame=1)
    blank.ops.wm.save_mainfile()

    done = index(blend_file)

    assert sorted(entries()) == ["shot/squat_0", "shot/wave_0"]
    (message,) = done.refused
    assert "walk_0" in message and "no armature" in message


def test_a_file_without_motion_is_not_opened_again(index, blank, tmp_path, monkeypatch, load):
    blank.ops.mesh.primitive_cube_add()
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    blank.ops.wm.save_as_mainfile(filepath=str(meshes / "cube.blend"), copy=True)
    blank.ops.export_scene.gltf(filepath=str(meshes / "cube.glb"))
    first = index(meshes)
    indexing = load("mocap_assist.library.solve_indexing")
    read = []
    monkeypatch.setattr(indexing, "read_blends", lambda *a, **k: read.append(a[1]) or [])

    again = index(meshes)

    assert not read
    assert again.refused == first.refused
    assert "cube.glb has no skeleton" in again.refused[0]


def test_clips_of_the_same_name_in_two_folders_become_unique(
    index, entries, blend_file, tmp_path
):
    other = tmp_path / "other"
    other.mkdir()
    (other / "shot.blend").write_bytes(blend_file.read_bytes())

    index(blend_file.parent, other)

    assert "shot/walk_0 (2)" in entries() and len(entries()) == 6


def test_nothing_in_a_file_is_executed(blank, index, entries, blend_file, tmp_path):
    trap = tmp_path / "trap"
    blank.ops.wm.open_mainfile(filepath=str(blend_file))
    text = blank.data.texts.new("trap.py")
    text.write(f"open({str(trap)!r}, 'w')")
    text.use_module = True
    blank.ops.wm.save_mainfile()

    index(blend_file)

    assert len(entries()) == 3 and not trap.exists()


def test_recordings_and_blend_files_of_one_folder_are_indexed(
    index, entries, blend_file, clip_files
):
    blend_file.rename(clip_files / "shot.blend")
    (clip_files / "empty.bvh").write_bytes(b"")
    (clip_files / "notes.txt").write_text("nothing of ours")

    done = index(clip_files)

    assert len(entries()) == done.n_clips == 9
    assert {"walk_0", "shot/walk_0"} <= set(entries())
    assert index(clip_files).n_kept == 9
