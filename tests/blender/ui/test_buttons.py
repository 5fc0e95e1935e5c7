"""What a button takes from the sidebar. Presses need a window: see tests/gui."""

from types import SimpleNamespace


def test_next_continues_from_a_clicked_issue(blank, actor):
    found = blank.context.scene.mocap_assist
    for frame in (10.0, 20.0, 30.0):
        issue = found.issues.add()
        issue.name, issue.start, issue.stop = "LeftLeg", frame, frame
    jump = blank.ops.mocap_assist.jump_to_issue

    assert jump(index=1) == {"FINISHED"}
    assert jump(step=1) == {"FINISHED"}

    assert (found.active_issue, blank.context.scene.frame_current) == (2, 30)
    assert actor.mode == "POSE"
    assert blank.context.active_pose_bone.name == "LeftLeg"


def test_button_properties_are_not_reused_at_the_next_press(blank):
    """Without SKIP_SAVE, Blender would fill in the last value as if the caller had given it."""
    for name in dir(blank.ops.mocap_assist):
        for each in getattr(blank.ops.mocap_assist, name).get_rna_type().properties:
            if each.identifier != "rna_type":
                assert each.is_skip_save, f"{name}: {each.identifier}"


def test_redo_panel_has_only_properties_without_a_new_solve(blank, draw):
    button = blank.types.MOCAP_ASSIST_OT_denoise
    properties = blank.ops.mocap_assist.denoise.get_rna_type()
    shown = set(draw(SimpleNamespace(draw=button.draw, bl_rna=properties)))

    assert {"strength", "bones", "plant_feet", "blend", "result_as"} <= shown
    assert not {"prior", "examples", "frame_range", "method", "joint_limits"} & shown
