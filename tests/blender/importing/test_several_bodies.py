"""Files with several people or takes: as many armatures as are chosen, or none."""

from types import SimpleNamespace

import numpy as np
import pytest
from modal_events import event, wait

CROWD = "crowd.skeleton"


@pytest.fixture
def crowd(tmp_path, recordings, load):
    """Two real takes in one file: the other enters at frame 12; a ghost is in one frame."""
    read = load("solvers.recordings").read_recording
    path = recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt"
    positions = read(path).tracks.positions
    points = np.concatenate([positions, np.full((*positions.shape[:2], 1), 2.0)], axis=-1)
    axes = load("solvers.recordings.conventions").from_kinect_space(np.eye(3))
    points[..., :3] = points[..., :3] @ np.linalg.inv(axes)
    points = np.nan_to_num(points)
    other = points[::-1] + np.array([1.2, 0.0, 0.4, 0.0])
    frames = [{"72057594037944340": each} for each in points]
    for index in range(12, len(frames)):
        frames[index]["72057594037944999"] = other[index]
        if index % 2:
            frames[index] = dict(reversed(frames[index].items()))
    frames[20]["7"] = points[0]
    (tmp_path / CROWD).write_text(ntu(frames))
    return tmp_path / CROWD


def ntu(frames):
    """Return frames, mappings from body to x, y, z and state of 25 joints, as text."""
    lines = [str(len(frames))]
    for bodies in frames:
        lines.append(str(len(bodies)))
        for name, values in bodies.items():
            lines += [f"{name} 0 1 1 1 1 0 0.02 -0.3 2", str(len(values))]
            lines += [f"{x} {y} {z} 2 2 2 2 0 0 0 0 {state:.0f}" for x, y, z, state in values]
    return "\n".join(lines)


def armatures(blank):
    return sorted(each.name for each in blank.data.objects if each.type == "ARMATURE")


def bring(blank, path, **settings):
    """Import as a script does; return the names of armatures."""
    assert blank.ops.mocap_assist.import_recording(filepath=str(path), **settings) == {
        "FINISHED"
    }
    return armatures(blank)


def first_key(armature):
    curves = armature.animation_data.action.layers[0].strips[0].channelbags[0].fcurves
    return min(
        curve.keyframe_points[0].co.x
        for curve in curves
        if curve.data_path.endswith("rotation_quaternion")
    )


def test_default_is_the_body_in_most_frames_and_others_are_named(blank, crowd, capfd):
    assert bring(blank, crowd) == ["crowd"]

    message = capfd.readouterr().out
    assert "Body 1 of 2. Left out: 2 (1.0 s, 71 % of the frames)" in message
    assert "Left out as a false detection: 3" in message


def test_all_are_armatures_on_one_time_line(blank, crowd):
    assert bring(blank, crowd, body="all", frame_rate="ONE") == ["crowd 1", "crowd 2"]

    one, two = (blank.data.objects[name] for name in armatures(blank))
    assert (first_key(one), first_key(two)) == (1.0, 13.0)
    blank.context.scene.frame_set(20)
    heads = [each.matrix_world @ each.pose.bones["Head"].head for each in (one, two)]
    assert (heads[0] - heads[1]).length > 1.0
    assert {each.select_get() for each in (one, two)} == {True}


def test_one_is_chosen_by_number(blank, crowd, load):
    assert bring(blank, crowd, body="2") == ["crowd 2"]

    action = blank.data.objects["crowd 2"].animation_data.action
    assert load("mocap_assist.scene.origin").origin_of(action)["body"] == "2"


def test_unknown_body_leaves_nothing(blank, crowd):
    with pytest.raises(RuntimeError, match=r"no body 'Ben'\. Name one of its 3"):
        bring(blank, crowd, body="Ben")

    assert not blank.data.objects and not blank.data.actions


def test_dialog_shows_a_choice_only_where_there_is_one(blank, crowd, recordings, load):
    importing = load("mocap_assist.importing.importing")
    choice = load("mocap_assist.importing.dialog.body_choice")
    alone = recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt"

    notes = [importing.preview(blank.context, [path]) for path in (crowd, alone)]

    assert "Body 1 of 2" in notes[0] and "Body" not in notes[1]
    assert not choice.bodies_to_choose([alone])
    labels = [item[1] for item in choice.body_items([crowd])]
    assert labels == [
        "Most Frames", "All", "1 (1.4 s, 100 % of the frames)", "2 (1.0 s, 71 % of the frames)"
    ]  # fmt: skip
    for number, text in enumerate(("", "all", "1", "2")):
        assert choice.text_of(number, [crowd]) == text
        assert choice.number_of(text, [crowd]) == number
    assert [item[1] for item in choice.body_items([crowd, alone])] == ["Most Frames", "All"]


def test_a_redraw_reads_no_file_again(crowd, load, monkeypatch):
    importing = load("mocap_assist.importing.importing")
    chosen, sorted_out = SimpleNamespace(name=CROWD), []
    operator = SimpleNamespace(directory=str(crowd.parent), files=[chosen], filepath="")

    def sort_out(paths):
        sorted_out.append(paths)
        return paths

    monkeypatch.setattr(importing, "one_path_per_take", sort_out)

    assert importing.chosen_paths(operator) == importing.shown_paths(operator) == [crowd]
    assert len(sorted_out) == 1
    chosen.name = "other.skeleton"
    assert importing.shown_paths(operator) == [crowd.with_name("other.skeleton")]
    importing.chosen_paths(operator)  # a file may have been written since
    assert len(sorted_out) == 3


def test_esc_takes_every_body_back(press, window, crowd, walks, blank):
    """Nothing half imported: the second file's bodies are there, the third is being read."""
    (walks / CROWD).write_bytes(crowd.read_bytes())
    operator = press(CROWD, "first.bvh", body="all")
    wait(operator, window, until=lambda: len(armatures(blank)) == 2)
    assert operator.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert not blank.data.objects and not blank.data.actions and not blank.data.armatures


@pytest.fixture
def two_rigs(blank, recordings, tmp_path):
    """A file of two skeletons, one walks for longer, as Blender exports it."""

    def export(suffix):
        walks = sorted((recordings / "mocap" / "cmu_walk").glob("07_0*.bvh"))[:2]
        for name, path, last in zip(("Anna", "Ben"), walks, (100, 60), strict=True):
            blank.ops.import_anim.bvh(filepath=str(path))
            blank.context.object.name = name
            action = blank.context.object.animation_data.action
            action.name = f"{name} walks"
            for curve in action.layers[0].strips[0].channelbags[0].fcurves:
                while curve.keyframe_points[-1].co.x > last:
                    curve.keyframe_points.remove(curve.keyframe_points[-1], fast=True)
                curve.update()
        blank.context.scene.frame_start, blank.context.scene.frame_end = 1, 100
        path = tmp_path / f"duo.{suffix}"
        if suffix == "glb":
            blank.ops.export_scene.gltf(filepath=str(path), export_animation_mode="ACTIONS")
        else:
            blank.ops.export_scene.fbx(
                filepath=str(path), bake_anim_use_all_actions=False,
                bake_anim_use_nla_strips=False, add_leaf_bones=False,
            )  # fmt: skip
        for kind in (blank.data.objects, blank.data.armatures, blank.data.actions):
            blank.data.batch_remove(list(kind))
        return path

    return export


def _travel(armature, scene):
    """Return where the hips are in two frames."""
    found = []
    for frame in (2, 50):
        scene.frame_set(frame)
        found.append(armature.matrix_world @ armature.pose.bones["Hips"].head)
    return np.array(found)


@pytest.mark.parametrize("suffix", ["glb", "fbx"])
def test_rigs_of_a_file_are_bodies(blank, two_rigs, suffix, load):
    path = two_rigs(suffix)

    assert bring(blank, path) == ["duo Anna", "duo Ben"]  # nothing is left out unasked
    paths = [
        _travel(blank.data.objects[name], blank.context.scene) for name in armatures(blank)
    ]
    assert not np.allclose(*paths, atol=0.01)  # each plays its own slot

    listed = load("mocap_assist.importing.dialog.body_choice").bodies_to_choose([path])
    assert [body.name for body in listed] == ["Anna", "Ben"]
    for each in [*blank.data.objects]:
        blank.data.objects.remove(each)
    assert bring(blank, path, body="ben") == ["duo Ben"]


def test_takes_play_the_actions_of_their_names(blank, recordings, load):
    """Each action holds its own motion, and the rate of the scene is that of the takes."""
    path = recordings / "corpus" / "glb" / "mixamo_blender" / "walking.glb"
    assert bring(blank, path, frame_rate="UPDATE") == ["walking"]
    armature, scene = blank.data.objects["walking"], blank.context.scene

    read = load("mocap_assist.actions.armature_read").read_take
    motions = [
        read(armature, scene, source=(action, action.slots[0])).parts[0].motion
        for action in (blank.data.actions["Idle"], blank.data.actions["Walk"])
    ]

    assert scene.render.fps == 30
    assert [motion.n_frames for motion in motions] == [30, 30]
    spread = [np.ptp(motion.rotations, axis=0).max() for motion in motions]
    assert spread[1] > 3.0 * spread[0]  # who walks swings the arms


def test_many_takes_are_many_actions(blank, recordings, capfd):
    path = recordings / "corpus" / "glb" / "m2m_quadruped_fox" / "fox-animations.glb"

    assert bring(blank, path) == ["fox-animations"]

    names = {each.name for each in blank.data.actions}
    assert len(names) == 14 and {"Bark", "Walk", "Idle Alert"} <= names
    assert "Takes: Bark, Bite, Death and 11 more." in capfd.readouterr().out


def test_a_still_take_does_not_hold_the_others_back(blank, recordings, tmp_path, load):
    """Hips below a root bone: one take stands still, the other walks, in one file."""
    walk = min((recordings / "mocap" / "cmu_walk").glob("07_0*.bvh"))
    blank.ops.import_anim.bvh(filepath=str(walk), frame_start=1)
    armature = blank.context.object
    blank.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    root = bones.new("root")
    root.tail = (0.0, 1.0, 0.0)
    bones["Hips"].parent = root
    blank.ops.object.mode_set(mode="OBJECT")
    walking = armature.animation_data.action
    walking.name = "Walking"
    still = walking.copy()
    still.name = "Standing"
    for curve in still.layers[0].strips[0].channelbags[0].fcurves:
        for point in curve.keyframe_points:
            point.co.y = curve.keyframe_points[0].co.y
        curve.update()
    path = tmp_path / "game.glb"
    blank.ops.export_scene.gltf(filepath=str(path), export_animation_mode="ACTIONS")
    for kind in (blank.data.objects, blank.data.armatures, blank.data.actions):
        blank.data.batch_remove(list(kind))

    assert bring(blank, path, frame_rate="UPDATE") == ["game"]

    armature, read = blank.data.objects["game"], load("mocap_assist.actions.armature_read")
    travel = {}
    for action in blank.data.actions:
        take = read.read_take(
            armature, blank.context.scene, source=(action, action.slots[0])
        ).parts[0]
        assert take.motion.skeleton.names[0] == "Hips"
        travel[action.name] = np.ptp(take.motion.root_positions, axis=0).max()
    assert travel["Standing"] == pytest.approx(0.0, abs=1e-3)
    assert travel["Walking"] > 2.0


def test_failing_take_leaves_nothing(blank, recordings, load, monkeypatch):
    objects = load("mocap_assist.importing.recording_objects")
    write, written = objects.write_motion, []

    def fail(*arguments, **keywords):
        written.append(keywords.get("name"))
        if written[-1] == "Walk":
            raise ValueError("damaged")
        return write(*arguments, **keywords)

    monkeypatch.setattr(objects, "write_motion", fail)
    with pytest.raises(RuntimeError, match=r"walking\.glb"):
        bring(blank, recordings / "corpus" / "glb" / "mixamo_blender" / "walking.glb")

    assert written[-1] == "Walk"
    assert not blank.data.objects and not blank.data.actions and not blank.data.armatures
