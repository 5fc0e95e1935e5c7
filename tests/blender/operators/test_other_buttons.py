"""Check, jump, plant feet and learn."""

import json

import numpy as np
import pytest


def test_check_lists_the_worst_issues_and_jump_goes_there(bad_arm, blank, load):
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}

    found = blank.context.scene.mocap_assist
    issue = next(each for each in found.issues if each.kind == "gap")
    assert (issue.name, issue.start, issue.stop) == ("LeftArm", 101, 160)
    assert "missing" in issue.sentence and "LeftArm" in found.report
    assert blank.ops.mocap_assist.jump_to_issue(index=found.issues.values().index(issue)) == {
        "FINISHED"
    }
    assert blank.context.scene.frame_current == 101
    selected = load("mocap_assist.blender.compat").is_selected
    assert [bone.name for bone in bad_arm.pose.bones if selected(bone)] == ["LeftArm"]
    assert (
        blank.context.active_pose_bone is None
        or blank.context.active_pose_bone.name == "LeftArm"
    )


def test_jump_steps_through_the_list(bad_arm, blank):
    with pytest.raises(RuntimeError, match="Press Check first"):
        blank.ops.mocap_assist.jump_to_issue()
    blank.ops.mocap_assist.measure_quality()
    found = blank.context.scene.mocap_assist

    blank.ops.mocap_assist.jump_to_issue(step=-1)

    assert found.active_issue == len(found.issues) - 1
    assert blank.context.scene.frame_current == int(found.issues[-1].start)


def test_plant_feet_uses_keyed_contacts_and_moves_only_legs_and_hips(
    dancer, blank, load, keys_of
):
    contacts = load("mocap_assist.actions.contact_keys")
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


def test_clean_uses_saved_patterns(dancer, blank, tmp_path):
    learned = tmp_path / "dance.npz"
    with pytest.raises(RuntimeError, match="Choose a file to write the motion model"):
        blank.ops.mocap_assist.learn_patterns(examples="walk")
    with pytest.raises(RuntimeError, match="does not exist"):
        blank.ops.mocap_assist.learn_patterns(
            examples="walk", learned_file=str(tmp_path / "no" / "x")
        )

    assert blank.ops.mocap_assist.learn_patterns(
        examples="walk", learned_file=str(learned)
    ) == {"FINISHED"}

    settings = {"prior": "LEARNED", "learned_file": str(learned), "plant_feet": False}
    assert blank.ops.mocap_assist.denoise(**settings) == {"FINISHED"}


def test_feet_of_a_short_take_are_planted_in_this_process(dancer, blank, load, monkeypatch):
    """The redo panel does so at every change of a setting."""
    monkeypatch.setattr(load("mocap_assist.jobs.job"), "Job", None)

    assert blank.ops.mocap_assist.plant_feet() == {"FINISHED"}


def test_check_adds_no_undo_step_and_no_redo_panel(blank):
    assert blank.types.MOCAP_ASSIST_OT_measure_quality.bl_options == {"REGISTER"}
    assert blank.types.MOCAP_ASSIST_OT_plant_feet.bl_options == {"REGISTER", "UNDO"}


@pytest.fixture
def shifted_leg(make_armature, animate):
    """A figure whose left leg has its names shifted: its thigh is called shin, and so on."""
    armature = make_armature()
    names = ("LeftUpLeg", "LeftLeg", "LeftFoot")
    bones = [armature.data.bones[name] for name in names]
    for number, bone in enumerate(bones):
        bone.name = f"bone {number}"
    for bone, name in zip(bones, (*names[1:], names[0]), strict=True):
        bone.name = name
    animate(armature)
    return armature


SHIFTED = "low confidence: LeftLeg as leftUpperLeg (by name, but no bone between"


def test_check_reports_bones_whose_names_the_tree_refutes(shifted_leg, blank, capsys):
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}

    assert SHIFTED in capsys.readouterr().out


def test_clean_names_uncertain_legs_where_it_plants_feet(shifted_leg, blank, capsys):
    assert blank.ops.mocap_assist.denoise(plant_feet=True) == {"FINISHED"}

    assert SHIFTED in capsys.readouterr().out


def test_clean_is_silent_about_legs_that_it_leaves_alone(shifted_leg, blank, capsys):
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    assert "low confidence" not in capsys.readouterr().out


def test_clean_is_silent_about_certain_legs(make_armature, animate, blank, capsys):
    animate(make_armature())

    assert blank.ops.mocap_assist.denoise(plant_feet=True) == {"FINISHED"}

    assert "low confidence" not in capsys.readouterr().out
