"""What the panel Retarget shows, and when."""


def test_every_setting_is_offered_once(blank, draw, actor):
    shown = blank.context.scene.mocap_assist.retarget
    of_rigs_with_both_and_of_lists = {"limbs", "actions"}

    drawn = draw("MOCAP_PT_retarget")

    names = type(shown).setting_names
    assert sorted(set(names) - of_rigs_with_both_and_of_lists) == sorted(
        name for name in drawn if name in names
    )
    assert {"mocap_assist.retarget", "mocap_assist.find_bones", "tolerance"} <= set(drawn)


def test_it_says_that_a_target_is_missing(draw, actor):
    assert "Choose the target armature." in " ".join(draw("MOCAP_PT_retarget"))


def test_bones_and_presets_are_drawn_once_they_are_found(blank, draw, actor, make_armature):
    target = make_armature(name="Double")
    blank.context.view_layer.objects.active = actor
    blank.context.scene.mocap_assist.retarget.target = target.name
    assert "mocap_assist.save_bone_map" not in draw("MOCAP_PT_retarget")

    blank.ops.mocap_assist.find_bones()

    drawn = draw("MOCAP_PT_retarget")
    assert drawn.count("mocap_assist.save_bone_map") == 2
    assert "leftUpperArm" in drawn and drawn.count("LeftArm") == 2
    assert drawn.count("source") == 1 and drawn.count("target") == 2  # and the target itself


def test_actions_can_be_ticked_where_they_are_listed(blank, draw, actor):
    assert "mocap_assist.tick_action" not in draw("MOCAP_PT_retarget")

    blank.context.scene.mocap_assist.retarget.takes = "LISTED"

    assert draw("MOCAP_PT_retarget").count("mocap_assist.tick_action") == 1
