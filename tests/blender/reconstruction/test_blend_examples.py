"""Other .blend files as libraries of clean clips: linked to be read, and gone again."""

import json
import shutil

import numpy as np
import pytest


@pytest.fixture
def stroll(load, tmp_path):
    """A clean walk, as a file."""
    samples = load("solvers.samples")
    clip = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    path = tmp_path / "stroll.bvh"
    load("solvers.recordings").write_bvh(clip, path)
    return path


@pytest.fixture
def library(stroll, bring, blank, tmp_path):
    """A .blend with that walk on its rig, which leans, and a second action of the rig."""
    armature = bring(stroll)
    armature.rotation_euler.x = 0.3
    second = armature.animation_data.action.copy()
    second.name = "again"
    lamp = blank.data.objects.new("lamp", None)
    lamp.keyframe_insert("location")
    door = lamp.animation_data.action  # of nothing that is a rig
    path = tmp_path / "library.blend"
    blank.data.libraries.write(str(path), {armature, second, door}, fake_user=True)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


@pytest.fixture
def all_there_is(blank):
    """Names of everything in the file, by kind."""

    def names():
        kinds = ("libraries", "objects", "actions", "armatures", "collections")
        return {
            kind: sorted(each.name_full for each in getattr(blank.data, kind)) for kind in kinds
        }

    return names


def test_all_actions_of_a_blend_file_are_read_and_nothing_remains(
    library, walk, reconstruct, all_there_is
):
    before = all_there_is()

    result = reconstruct(postures="EXAMPLES", examples=str(library))

    assert "2 clips of your own" in json.loads(result["mocap_assist_history"])[-1]["method"]
    after = all_there_is()
    assert after.pop("actions") == sorted([*before.pop("actions"), result.name])
    assert after == before


def test_rig_of_another_file_is_read_in_its_world_space(library, walk, load, blank, stroll):
    examples = load("mocap_assist.clean.examples").read_examples(
        blank.context.scene, walk, str(library)
    )

    kinematics = load("solvers.motion").forward_kinematics
    true = kinematics(load("solvers.recordings").read_recording(stroll)).positions
    cosine, sine = np.cos(0.3), np.sin(0.3)
    leaning = true @ np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]]).T
    assert len(examples.motions) == 2 and not examples.files
    for motion in examples.motions:
        positions = kinematics(motion).positions
        assert np.allclose(positions[:, 0], leaning[:, 0], atol=1e-4)


def in_time_slices(load, *given):
    """Read examples in the shortest possible time slices; count them."""
    work = load("mocap_assist.blender.time_slices").Work(
        load("mocap_assist.clean.examples").read_examples, *given
    )
    n_slices = 0
    while not work.run_slice(0.0):
        n_slices += 1
        yield n_slices, None
    yield n_slices, work.result


def test_actions_are_read_in_time_slices_without_linked_data_between(
    library, walk, load, blank, all_there_is
):
    scene, before = blank.context.scene, all_there_is()
    at_once = load("mocap_assist.clean.examples").read_examples(scene, walk, str(library))

    between = [
        (time_slice, all_there_is())
        for time_slice in in_time_slices(load, scene, walk, str(library))
    ]

    assert all(each == before for _, each in between)
    n_slices, examples = between[-1][0]
    assert n_slices >= 2  # one for each action
    assert len(examples.motions) == len(at_once.motions) == 2
    for one, other in zip(examples.motions, at_once.motions, strict=True):
        np.testing.assert_array_equal(one.rotations, other.rotations)
        np.testing.assert_array_equal(one.root_positions, other.root_positions)


def test_folder_of_recordings_is_read_in_time_slices(walk, load, blank, stroll, tmp_path):
    folder = tmp_path / "takes"
    folder.mkdir()
    for number in range(5):
        (folder / f"take_{number}.bvh").write_bytes(stroll.read_bytes())
        (folder / f"note_{number}.txt").write_text("not a recording")

    *_, (n_slices, examples) = in_time_slices(load, blank.context.scene, walk, str(folder))

    assert n_slices == 10  # one for each file
    assert examples.found == tuple(str(folder / f"take_{each}.bvh") for each in range(5))


def test_file_that_is_already_linked_is_read(library, walk, reconstruct, blank, all_there_is):
    with blank.data.libraries.load(str(library), link=True) as (there, into):
        into.objects = list(there.objects)
    blank.context.scene.collection.objects.link(into.objects[0])
    blank.context.view_layer.objects.active = walk

    reconstruct(postures="EXAMPLES", examples=str(library))

    assert len(all_there_is()["libraries"]) == 1
    assert into.objects[0].name in blank.context.scene.collection.objects


@pytest.mark.parametrize("content", ["text", "no rig"])
def test_invalid_examples_give_one_message(content, walk, blank, tmp_path, all_there_is):
    path = tmp_path / "other.blend"
    if content == "text":
        path.write_text("No Blender file.")
    else:
        blank.data.libraries.write(str(path), {walk.animation_data.action}, fake_user=True)
    before = all_there_is()

    with pytest.raises(RuntimeError) as error:
        blank.ops.mocap_assist.reconstruct(postures="EXAMPLES", examples=str(path))

    sentence = "cannot be read as a .blend" if content == "text" else "has no armature with"
    assert sentence in str(error.value) and "other.blend" in str(error.value)
    assert all_there_is() == before


def test_clean_learns_from_a_blend_file(library, stroll, bring, blank):
    bring(stroll)

    status = blank.ops.mocap_assist.denoise(
        prior="EXAMPLES", examples=str(library), plant_feet=False
    )

    assert status == {"FINISHED"}
    action = blank.context.object.animation_data.action
    assert action.name == "stroll.clean" and not blank.data.libraries


MANNEQUIN = "corpus/fbx/ue4_mannequin/SK_Mannequin.FBX"
"""A skeleton without animation."""


def test_a_file_without_motion_in_a_folder_of_examples_is_left_out(
    stroll, bring, blank, recordings, tmp_path
):
    folder = tmp_path / "takes"
    folder.mkdir()
    shutil.copy(stroll, folder / "take.bvh")
    shutil.copy(recordings / MANNEQUIN, folder)
    bring(stroll)

    status = blank.ops.mocap_assist.denoise(prior="EXAMPLES", examples=str(folder))

    assert status == {"FINISHED"}


@pytest.mark.parametrize("name", ["cut.bvh", "cut.fbx"])
def test_a_damaged_file_in_a_folder_of_examples_is_left_out_and_named(
    stroll, bring, blank, recordings, tmp_path, name
):
    folder = tmp_path / "takes"
    folder.mkdir()
    shutil.copy(stroll, folder / "take.bvh")
    complete = stroll if name == "cut.bvh" else recordings / MANNEQUIN
    (folder / name).write_bytes(complete.read_bytes()[:400])
    bring(stroll)

    status = blank.ops.mocap_assist.denoise(prior="EXAMPLES", examples=str(folder))

    assert status == {"FINISHED"}
    action = blank.context.object.animation_data.action
    said = json.loads(action["mocap_assist_history"])[-1]["prior_used"]
    assert "A file of the examples was left out" in said and name in said
    with pytest.raises(RuntimeError, match=name):
        blank.ops.mocap_assist.denoise(prior="EXAMPLES", examples=str(folder / name))


@pytest.mark.parametrize("inside", [True, False])
def test_examples_without_any_motion_are_refused(
    stroll, bring, blank, recordings, tmp_path, inside
):
    folder = tmp_path / "rigs"
    folder.mkdir()
    shutil.copy(recordings / MANNEQUIN, folder)
    bring(stroll)

    with pytest.raises(RuntimeError, match=r"no animation|has motion"):
        blank.ops.mocap_assist.denoise(
            prior="EXAMPLES",
            examples=str(folder if inside else folder / "SK_Mannequin.FBX"),
        )
