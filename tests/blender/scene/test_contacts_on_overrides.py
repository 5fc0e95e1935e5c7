"""Foot contacts on a rig that is linked from a library and overridden."""

import numpy as np


def test_an_override_keeps_its_foot_contacts_when_its_file_is_loaded_again(
    make_armature, animate, tmp_path, blank, load
):
    contacts = load("mocap_assist.scene.contacts")
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
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))

    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))

    (again,) = [each for each in blank.data.objects if each.override_library]
    assert [again[name] for name in contacts.PROPERTIES] == [0, 1]
    blank.context.scene.frame_set(10)
    assert [again[name] for name in contacts.PROPERTIES] == [1, 0]
