"""What the panel Retarget shows, and when."""


def test_retarget_panel_shows_every_setting_once(blank, draw, actor):
    shown = blank.context.scene.mocap_assist.retarget
    of_rigs_with_both_and_of_lists = {"limbs", "actions"}

    drawn = draw("MOCAP_PT_retarget")

    names = type(shown).setting_names
    assert sorted(set(names) - of_rigs_with_both_and_of_lists) == sorted(
        name for name in drawn if name in names
    )
    assert {"mocap_assist.retarget", "mocap_assist.find_bones", "tolerance"} <= set(drawn)


def test_retarget_panel_reports_a_missing_target(draw, actor):
    assert "Choose the target armature." in " ".join(draw("MOCAP_PT_retarget"))


def test_retarget_panel_shows_found_bones_and_presets(blank, draw, actor, make_armature):
    target = make_armature(name="Double")
    for bone in target.data.bones:
        bone.name = f"mixamorig:{bone.name}"
    blank.context.view_layer.objects.active = actor
    blank.context.scene.mocap_assist.retarget.target = target.name
    assert "mocap_assist.save_bone_map" not in draw("MOCAP_PT_retarget")

    blank.ops.mocap_assist.find_bones()

    drawn = draw("MOCAP_PT_retarget")
    assert drawn.count("mocap_assist.save_bone_map") == 2
    assert {"Source", "Target"} <= set(drawn) and drawn.count("LeftArm") == 2
    assert {"Low", "Medium", "High", "mocap_assist_highlight"} <= set(drawn)
    assert drawn.count("source") == 1 and drawn.count("target") == 2  # and the target itself


def test_listed_actions_have_checkboxes(blank, draw, actor):
    assert "mocap_assist.tick_action" not in draw("MOCAP_PT_retarget")

    blank.context.scene.mocap_assist.retarget.takes = "LISTED"

    assert draw("MOCAP_PT_retarget").count("mocap_assist.tick_action") == 1
