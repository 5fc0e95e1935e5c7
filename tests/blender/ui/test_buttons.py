"""What a button takes from the sidebar. Presses need a window: see tests/gui."""

from types import SimpleNamespace


def test_next_goes_on_from_an_issue_that_was_clicked(blank, actor):
    found = blank.context.scene.mocap_assist
    for frame in (10.0, 20.0, 30.0):
        issue = found.issues.add()
        issue.name, issue.start, issue.stop = "LeftLeg", frame, frame
    jump = blank.ops.mocap_assist.jump_to_issue

    assert jump(index=1) == {"FINISHED"}
    assert jump(step=1) == {"FINISHED"}

    assert (found.active_issue, blank.context.scene.frame_current) == (2, 30)


def test_nothing_that_a_button_was_given_is_filled_in_at_the_next_press(blank):
    """Blender fills it in, unless an option says not to: it then looks like a caller's wish."""
    for name in dir(blank.ops.mocap_assist):
        for each in getattr(blank.ops.mocap_assist, name).get_rna_type().properties:
            if each.identifier != "rna_type":
                assert each.is_skip_save, f"{name}: {each.identifier}"


def test_the_redo_panel_offers_only_what_needs_no_new_solve(blank, draw):
    button = blank.types.MOCAP_ASSIST_OT_denoise
    properties = blank.ops.mocap_assist.denoise.get_rna_type()
    shown = set(draw(SimpleNamespace(draw=button.draw, bl_rna=properties)))

    assert {"strength", "bones", "plant_feet", "blend", "result_as"} <= shown
    assert not {"prior", "examples", "frame_range", "method", "joint_limits"} & shown
