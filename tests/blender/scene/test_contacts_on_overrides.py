"""Foot contacts on a rig that is linked from a library and overridden."""

import numpy as np
import pytest


@pytest.fixture
def contacts(load):
    return load("mocap_assist.actions.contact_keys")


@pytest.fixture
def override(make_armature, animate, tmp_path, blank, contacts):
    """An override whose left foot stands up to frame 30, and whose right foot stands then."""
    armature = make_armature()
    animate(armature)
    blank.data.libraries.write(str(tmp_path / "rig.blend"), {armature}, fake_user=True)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with blank.data.libraries.load(str(tmp_path / "rig.blend"), link=True) as (_, into):
        into.objects = ["Actor"]
    blank.context.scene.collection.objects.link(into.objects[0])
    override = into.objects[0].override_create(remap_local_usages=True)
    action = override.animation_data.action.copy()
    override.animation_data.action, slot = action, action.slots[0]
    override.animation_data.action_slot = slot
    standing = np.repeat([[True, False], [False, True]], 30, axis=0)
    contacts.write_contacts(override, action, slot, np.arange(1.0, 61.0), standing)
    blank.context.scene.frame_set(45)
    return override


def save_and_open(bpy, path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    (again,) = [each for each in bpy.data.objects if each.override_library]
    return again


def test_override_keeps_its_foot_contacts_after_reloading(override, blank, tmp_path, contacts):
    again = save_and_open(blank, tmp_path / "shot.blend")

    assert [again[name] for name in contacts.FOOT_PROPERTIES] == [0, 1]
    blank.context.scene.frame_set(10)
    assert [again[name] for name in contacts.FOOT_PROPERTIES] == [1, 0]


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_key_without_a_value_means_no_contact(override, blank, tmp_path, contacts, load, value):
    curves = load("mocap_assist.actions.bone_channels").animated_curves
    animation = override.animation_data
    channel = curves(animation.action, animation.action_slot)['["mocap_contact_left"]', 0]
    for key in channel.curve.keyframe_points:
        key.co.y = value

    again = save_and_open(blank, tmp_path / "shot.blend")

    assert [again[name] for name in contacts.FOOT_PROPERTIES] == [0, 1]
