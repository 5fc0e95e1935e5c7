"""Rigify's rig as a source: however many actions are read, it stays posed as it was."""

import numpy as np
import pytest

SWITCH = "thigh_parent.L"
CHANNELS = ("location", "rotation_quaternion", "rotation_euler", "scale")


def key(hero, bone, values, channel="location"):
    for frame, value in values:
        if channel in CHANNELS:
            getattr(hero.pose.bones[bone], channel)[0] = value
            hero.pose.bones[bone].keyframe_insert(channel, frame=frame)
        else:
            hero.pose.bones[bone][channel] = value
            hero.pose.bones[bone].keyframe_insert(f'["{channel}"]', frame=frame)


def pose_and_visibility(hero, blank):
    """What all controls hold, and where Blender shows all bones."""
    shown = hero.evaluated_get(blank.context.evaluated_depsgraph_get())
    held = {
        bone.name: (
            *(tuple(getattr(bone, channel)) for channel in CHANNELS),
            {name: value for name, value in bone.items() if isinstance(value, (int, float))},
        )
        for bone in hero.pose.bones
    }
    return held, np.array([bone.matrix for bone in shown.pose.bones])


@pytest.fixture
def acted(hero, blank):
    """Plays B; A keys other controls, and a switch that B does not; some posing has no key."""
    animation = hero.animation_data_create()
    animation.action = blank.data.actions.new("A")
    key(hero, "torso", [(1, 0.0), (30, 0.5)])
    key(hero, SWITCH, [(1, 0.0), (30, 1.0)], "IK_FK")
    key(hero, "head", [(1, 0.0), (30, 0.3)], "rotation_quaternion")
    animation.action = None
    animation.action = blank.data.actions.new("B")
    key(hero, "chest", [(1, 0.0), (40, 0.2)])
    blank.context.scene.frame_set(7, subframe=0.25)
    hero.pose.bones[SWITCH]["IK_FK"] = 0.25
    hero.pose.bones["torso"].location = (0.1, 0.2, 0.0)
    hero.pose.bones["head"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    hero.pose.bones["hand_ik.L"].location = (0.0, 0.1, 0.0)
    hero.update_tag(refresh={"OBJECT", "DATA"})
    blank.context.view_layer.update()
    return hero


@pytest.mark.parametrize("posed", [False, True])
@pytest.mark.parametrize("takes", ["ALL", "PLAYED"])
def test_source_rig_with_many_actions_is_unchanged(takes, posed, acted, make_rig, give, blank):
    target = make_rig("Mixamo", prefix="mixamorig:")
    if posed:  # where the played action has keys, too
        acted.pose.bones["chest"].location = (0.0, 0.3, 0.1)
        blank.context.view_layer.update()
    held, shown = pose_and_visibility(acted, blank)

    give(acted, target, takes=takes)

    assert acted.animation_data.action.name == "B"
    assert (blank.context.scene.frame_current, blank.context.scene.frame_subframe) == (7, 0.25)
    held_after, shown_after = pose_and_visibility(acted, blank)
    assert held_after == held
    np.testing.assert_allclose(shown_after, shown, atol=1e-5)
    assert len({each.name for each in blank.data.actions}) == (4 if takes == "ALL" else 3)
