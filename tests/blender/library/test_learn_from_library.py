"""Clean and Reconstruct learn from what in the library is like the take."""

import numpy as np
import pytest


@pytest.fixture
def library(blank, index, clip_files, blend_file, clip_motions, load, tmp_path):
    """Eight walks, as recordings and as actions of a .blend file, and the others."""
    write_bvh = load("solvers.recordings").write_bvh
    for seed in (2, 3, 4):
        write_bvh(clip_motions("walk", seed, seconds=4.0), clip_files / f"walk_{seed}.bvh")
    index(clip_files, blend_file)
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "clips.library")


@pytest.fixture
def noisy(library, newcomer, rng):
    """A walk with 3 degrees of noise."""
    armature = newcomer("walk", seconds=4.0)
    action = armature.animation_data.action
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in bag.fcurves:
        if "rotation" in curve.data_path:
            for key in curve.keyframe_points:
                key.co.y += rng.normal(scale=np.radians(1.5))
            curve.update()
    return armature


def test_clean_finds_examples_in_the_library(noisy, blank, load):
    done = blank.ops.mocap_assist.denoise(prior="LIBRARY", plant_feet=False)

    assert done == {"FINISHED"}
    action = noisy.animation_data.action
    entry = load("mocap_assist.scene.history").history(action)[-1]
    assert entry["settings"]["prior"] == "library"
    assert "clips of the library: " in entry["prior_used"] and "walk_" in entry["prior_used"]


def test_clean_learns_from_actions_of_blend_files(
    noisy, blank, load, clip_files, entries, tmp_path
):
    with load("solvers.retrieval").load_clip_library(tmp_path / "clips.library") as opened:
        opened.remove([name for name in entries() if not name.startswith("shot/")])

    blank.ops.mocap_assist.denoise(prior="LIBRARY", plant_feet=False)

    entry = load("mocap_assist.scene.history").history(noisy.animation_data.action)[-1]
    assert "of the library: shot/walk_0" in entry["prior_used"]


def test_reconstruct_finds_postures_in_the_library(library, blank, recordings, load):
    take = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
    blank.ops.mocap_assist.import_recording(filepath=str(take))

    assert blank.ops.mocap_assist.reconstruct(postures="LIBRARY") == {"FINISHED"}

    action = blank.context.object.animation_data.action
    remarks = " ".join(load("mocap_assist.scene.history").history(action)[-1]["remarks"])
    assert "of the library: " in remarks


@pytest.mark.parametrize(
    ("button", "setting"), [("denoise", "prior"), ("reconstruct", "postures")]
)
def test_buttons_report_a_missing_library(newcomer, blank, tmp_path, button, setting):
    newcomer("walk")
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "none.library")

    with pytest.raises(RuntimeError, match="There is no clip library to learn from"):
        getattr(blank.ops.mocap_assist, button)(**{setting: "LIBRARY"})


def test_command_line_accepts_a_library(noisy, load, capsys, tmp_path):
    run = load("mocap_assist.batch.command").run
    words = ["denoise", "--library", str(tmp_path / "clips.library"), "--no-plant-feet"]

    assert run([*words, "--output", str(tmp_path / "out.blend")]) == 0

    assert "of the library" in capsys.readouterr().out
