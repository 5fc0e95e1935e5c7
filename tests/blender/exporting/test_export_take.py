"""The button: what it changes, what it refuses, and the command of the same name."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

FORMATS = ("fbx", "glb", "bvh")


def state_of(bpy):
    """Everything of a session that an export could change."""
    scene, active = bpy.context.scene, bpy.context.view_layer.objects.active
    render, units = scene.render, scene.unit_settings
    return {
        "objects": {each.name: tuple(map(tuple, each.matrix_world)) for each in scene.objects},
        "selected": [each.name for each in bpy.context.view_layer.objects.selected],
        "active": (active.name, active.mode),
        "actions": sorted(each.name for each in bpy.data.actions),
        "played": (active.animation_data.action.name, active.animation_data.action_slot.handle),
        "frame": (
            scene.frame_current,
            scene.frame_subframe,
            scene.frame_start,
            scene.frame_end,
        ),
        "rate": (render.fps, render.fps_base, units.scale_length, units.system),
        "data": sorted(each.name for each in bpy.data.armatures),
        "scenes": sorted(each.name for each in bpy.data.scenes),
        "meshes": sorted(each.name for each in bpy.data.meshes),
    }


def test_the_scene_and_the_action_are_unchanged(walk, blank, export, keys_of):
    blank.ops.object.mode_set(mode="POSE")
    blank.context.scene.frame_set(17, subframe=0.25)
    before, keys = state_of(blank), keys_of(walk.animation_data.action)

    export("out.fbx")

    assert state_of(blank) == before
    assert keys_of(walk.animation_data.action) == keys


def test_only_the_played_action_and_the_selected_armature_are_exported(
    walk, make_armature, animate, blank, export
):
    played = walk.animation_data.action
    other = animate(make_armature(name="Bystander"), frames=range(1, 20))
    other.name = "other"
    blank.context.view_layer.objects.active = walk

    path = export("out.glb")

    content = json.loads(path.read_bytes()[20:].split(b"\x00")[0].rpartition(b"}")[0] + b"}")
    assert [each["name"] for each in content["animations"]] == [played.name]
    assert not any("Bystander" in each.get("name", "") for each in content["nodes"])
    times = content["accessors"][content["animations"][0]["samplers"][0]["input"]]
    assert (times["count"], times["min"], times["max"]) == (60, [0.0], [pytest.approx(59 / 30)])


def test_keys_between_frames_are_sampled_on_frames(make_armature, animate, blank, export, load):
    armature = make_armature()
    animate(armature, frames=np.arange(1.0, 31.0, 0.25))
    blank.context.scene.render.fps = 30

    motion = load("solvers.recordings").read_bvh(export("out.bvh"))

    assert (motion.n_frames, motion.frame_rate) == (30, pytest.approx(30.0))


@pytest.mark.parametrize("ending", FORMATS)
@pytest.mark.parametrize(("fps", "base"), [(60, 1.001), (333, 10.0)])
def test_rates_are_kept(walk, blank, export, bring, fps, base, ending):
    render = blank.context.scene.render
    render.fps, render.fps_base = fps, base

    bring(export(f"out.{ending}"))

    assert render.fps / render.fps_base == pytest.approx(fps / base, rel=1e-4)


def test_the_ending_of_the_name_decides(walk, export, blank, tmp_path):
    assert export("out.bvh", file_format="GLB").read_bytes().startswith(b"HIERARCHY")

    export("walk.clean", file_format="GLB")

    assert (tmp_path / "walk.clean.glb").read_bytes().startswith(b"glTF")


def test_the_recording_is_not_replaced_unless_allowed(load, blank, tmp_path, export):
    samples, files = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    files.write_bvh(walk, tmp_path / "walk.bvh")
    recorded = (tmp_path / "walk.bvh").read_bytes()
    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "walk.bvh"))
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    with pytest.raises(RuntimeError, match="is the recording that this take was imported from"):
        export("walk.bvh")
    assert (tmp_path / "walk.bvh").read_bytes() == recorded

    export("walk.bvh", overwrite_recording=True)
    assert (tmp_path / "walk.bvh").read_bytes() != recorded


@pytest.mark.parametrize(
    ("filepath", "sentence"),
    [
        ("", "Choose a file to export to"),
        ("/nowhere/at/all/x.fbx", "There is no folder /nowhere/at/all"),
        ("/tmp", "/tmp cannot be written: it is a folder"),
        ("/dev/full/x.fbx", "There is no folder"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused(walk, blank, filepath, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        blank.ops.mocap_assist.export_take(filepath=filepath)


def test_a_read_only_folder_is_refused(walk, blank, load, tmp_path, monkeypatch):
    target = load("mocap_assist.exporting.target_file")
    monkeypatch.setattr(target.os, "access", lambda path, mode: False)

    with pytest.raises(RuntimeError, match=r"the folder is read-only\. Choose another one"):
        blank.ops.mocap_assist.export_take(filepath=str(tmp_path / "x.fbx"))


def test_a_full_disk_leaves_what_was_there(walk, blank, load, tmp_path, monkeypatch):
    def full(self, content):
        raise OSError(28, "No space left on device", str(self))

    (tmp_path / "x.bvh").write_text("before")
    path = type(tmp_path)
    written = path.write_bytes
    monkeypatch.setattr(
        path,
        "write_bytes",
        lambda self, content: (full if self.suffix == ".bvh" else written)(self, content),
    )

    with pytest.raises(RuntimeError, match=r"x\.bvh cannot be written: the disk is full"):
        blank.ops.mocap_assist.export_take(filepath=str(tmp_path / "x.bvh"))
    assert [each.name for each in tmp_path.iterdir()] == ["x.bvh"]
    assert (tmp_path / "x.bvh").read_text() == "before"


def test_gaps_are_refused_by_name(walk, export, tmp_path):
    bag = walk.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        if '"LeftArm"' in curve.data_path:
            for key in list(curve.keyframe_points)[20:40][::-1]:
                curve.keyframe_points.remove(key)

    with pytest.raises(RuntimeError, match=r"gaps \(LeftArm; the first at frame 21\)"):
        export("out.fbx")
    assert not list(tmp_path.iterdir())


def test_button_gives_a_reason_without_armature_or_action(blank, make_armature):
    poll = blank.ops.mocap_assist.export_take
    with pytest.raises(RuntimeError, match="Select an animated armature"):
        poll(filepath="/tmp/x.fbx")
    make_armature()
    with pytest.raises(RuntimeError, match="has no action"):
        poll(filepath="/tmp/x.fbx")


def test_the_command_writes_a_file_for_each_armature(
    walk, make_armature, animate, blank, command, tmp_path
):
    animate(make_armature(name="Other"), frames=range(1, 11))

    status, _, err = command("export", tmp_path / "one.fbx")
    assert (status, err.startswith("Actor, Other cannot all be written to")) == (2, True)
    status, _, err = command("export", tmp_path / "one.c3d")
    assert status == 2 and "end the name in .fbx or .glb or .bvh" in err
    status, out, err = command("export", tmp_path, "--file-format", "bvh", "--json")

    assert (status, err) == (0, "")
    figures = [json.loads(line) for line in out.splitlines() if line[:1] == "{"]
    assert [(each["armature"], each["n_frames"]) for each in figures] == [
        ("Actor", 60), ("Other", 10),
    ]  # fmt: skip
    assert {path.name for path in tmp_path.iterdir()} == {"Actor.bvh", "Other.bvh"}


@pytest.mark.parametrize("ending", FORMATS)
def test_exported_bones_follow_constraints(walk, blank, export, bring, heads, ending):
    """The right arm points at an empty that nothing of the action moves."""
    goal = blank.data.objects.new("Goal", None)
    blank.context.scene.collection.objects.link(goal)
    goal.location = (-1.0, -2.0, 1.5)
    constraint = walk.pose.bones["RightArm"].constraints.new("DAMPED_TRACK")
    constraint.target, constraint.track_axis = goal, "TRACK_Y"
    expected = heads(walk, range(1, 61), ["RightForeArm"])

    back = bring(export(f"out.{ending}"))

    assert_allclose(heads(back, range(1, 61), ["RightForeArm"]), expected, atol=1e-3)
