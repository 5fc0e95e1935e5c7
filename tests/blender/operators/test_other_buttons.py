"""Check, jump, plant feet, learn, and the command line."""

import json

import numpy as np
import pytest


@pytest.fixture
def dancer(make_armature, animate, blank):
    """A figure of 13 bones in smooth motion for ten seconds at 30 Hz."""
    armature = make_armature()
    animate(armature, frames=range(1, 301))
    blank.context.scene.render.fps = 30
    return armature


@pytest.fixture
def bad_arm(dancer):
    """Two seconds of it without the left arm, from frame 101 on."""
    bag = dancer.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        if "LeftArm" in curve.data_path:
            for key in list(curve.keyframe_points)[100:160][::-1]:
                curve.keyframe_points.remove(key)
    return dancer


def test_check_lists_the_worst_spots_and_jump_goes_there(bad_arm, blank, load):
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}

    found = blank.context.scene.mocap_assist
    spot = next(each for each in found.spots if each.kind == "gap")
    assert (spot.name, spot.start, spot.stop) == ("LeftArm", 101, 160)
    assert "missing" in spot.sentence and "LeftArm" in found.report
    assert blank.ops.mocap_assist.jump_to_spot(index=found.spots.values().index(spot)) == {
        "FINISHED"
    }
    assert blank.context.scene.frame_current == 101
    selected = load("mocap_assist.scene.compat").is_selected
    assert [bone.name for bone in bad_arm.pose.bones if selected(bone)] == ["LeftArm"]
    assert (
        blank.context.active_pose_bone is None
        or blank.context.active_pose_bone.name == "LeftArm"
    )


def test_jump_steps_through_the_list(bad_arm, blank):
    with pytest.raises(RuntimeError, match="Press Check first"):
        blank.ops.mocap_assist.jump_to_spot()
    blank.ops.mocap_assist.measure_quality()
    found = blank.context.scene.mocap_assist

    blank.ops.mocap_assist.jump_to_spot(step=-1)

    assert found.active_spot == len(found.spots) - 1
    assert blank.context.scene.frame_current == int(found.spots[-1].start)


def test_plant_feet_uses_the_keyed_contacts_and_moves_only_legs_and_hips(
    dancer, blank, load, keys_of
):
    contacts = load("mocap_assist.scene.contacts")
    raw = dancer.animation_data.action
    frames = np.arange(1.0, 301.0)
    standing = np.zeros((300, 2), bool)
    standing[100:130, 1] = True
    contacts.write_contacts(dancer, raw, raw.slots[0], frames, standing)
    before = keys_of(raw)

    assert blank.ops.mocap_assist.plant_feet() == {"FINISHED"}

    action = dancer.animation_data.action
    assert action.name == "walk.clean" and keys_of(raw) == before
    changed = {
        path
        for name, keys in keys_of(action).items()
        if keys != before[name]
        for path in [name[1]]
    }
    bones = {path.split('"')[1] for path in changed}
    assert (
        {"RightUpLeg", "RightLeg"}
        <= bones
        <= {"Hips", "RightUpLeg", "RightLeg", "RightFoot", "LeftUpLeg", "LeftLeg", "LeftFoot"}
    )
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["operation"] == "plant_feet"
    assert entry["slide_after_cm"] < 0.1 * entry["slide_before_cm"]


def test_what_was_learned_serves_clean(dancer, blank, tmp_path):
    learned = tmp_path / "dance.npz"
    with pytest.raises(RuntimeError, match="Choose the file that what is learned"):
        blank.ops.mocap_assist.learn_patterns(examples="walk")
    with pytest.raises(RuntimeError, match="There is no folder"):
        blank.ops.mocap_assist.learn_patterns(
            examples="walk", learned_file=str(tmp_path / "no" / "x")
        )

    assert blank.ops.mocap_assist.learn_patterns(
        examples="walk", learned_file=str(learned)
    ) == {"FINISHED"}

    settings = {"prior": "LEARNED", "learned_file": str(learned), "plant_feet": False}
    assert blank.ops.mocap_assist.denoise(**settings) == {"FINISHED"}


@pytest.fixture
def command(load, capsys):
    """Run `blender FILE --command mocap_assist ...`; return status, stdout and stderr."""
    run = load("mocap_assist.batch.command").run

    def call(*words):
        status = run(list(words))
        return status, *capsys.readouterr()

    return call


def test_the_command_cleans_and_saves(bad_arm, blank, command, tmp_path):
    target = tmp_path / "clean.blend"

    status, out, err = command(
        "denoise", "--output", str(target), "--json", "--no-plant-feet", "--strength", "0.9"
    )

    assert (status, err) == (0, "")
    said = json.loads(out.splitlines()[0])  # Blender itself says that it saved
    assert (said["armature"], said["action"], said["settings"]["strength"]) == (
        "Actor",
        "walk.clean",
        0.9,
    )
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert blank.data.objects["Actor"].animation_data.action.name == "walk.clean"
    assert blank.data.actions["walk.clean"]["mocap_assist_source"] == blank.data.actions["walk"]


def test_the_command_learns_from_files(dancer, blank, command, tmp_path):
    clips = [str(tmp_path / f"{name}.bvh") for name in ("one", "two")]
    for clip in clips:
        blank.ops.export_anim.bvh(filepath=clip, frame_start=1, frame_end=300)

    status, out, _ = command(
        "denoise", "--output", str(tmp_path / "x.blend"), "--json", "--train", *clips
    )

    settings = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))[
        "settings"
    ]
    assert (status, settings["prior"], settings["examples"]) == (
        0, "examples", ";".join(clips),
    )  # fmt: skip


def test_the_command_passes_over_armatures_that_play_nothing(dancer, make_armature, command):
    make_armature(name="Driven").driver_add("location", 0)

    status, out, _ = command("quality", "--json")

    assert (status, json.loads(out)["armature"]) == (0, "Actor")


def test_a_file_that_cannot_be_saved_is_said(dancer, command, tmp_path):
    (tmp_path / "x.blend").mkdir()

    status, _, err = command("denoise", "--output", str(tmp_path / "x.blend"))

    assert status == 2 and "x.blend was not saved" in err


def test_the_command_measures(bad_arm, command):
    status, out, _ = command("quality", "--armature", "Actor")
    assert status == 0 and "LeftArm is missing for 2.00 s." in out

    status, out, _ = command("quality", "--json")
    assert json.loads(out)["joints"]["LeftArm"]["turn_gaps"] == [[100, 160]]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            ["denoise", "--armature", "Nobody"],
            "There is no armature Nobody; the scene has Actor.\n",
        ),
        (["denoise"], "No file is open: say which one to save with --output FILE.\n"),
        (
            ["denoise", "--output", "/nowhere/x.blend"],
            "There is no folder /nowhere to save in.\n",
        ),
        (
            ["denoise", "--output", "/tmp/x.blend", "--strength", "7"],
            "strength is 7; it must lie between 0 and 1.\n",
        ),
    ],
)
def test_the_command_fails_with_one_sentence_and_status_2(words, sentence, dancer, command):
    assert command(*words) == (2, "", sentence)


def test_a_slip_in_the_command_line_has_status_2(dancer, command):
    status, _, err = command("denoise", "--strenght", "1")
    assert status == 2 and "unrecognized arguments" in err.lower()
