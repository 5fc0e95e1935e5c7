"""Rings under feet lie where the feet are, while their contacts are keyed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def markers(load):
    load("mocap_assist.overlays.comparison.drawing").forget()
    return load("mocap_assist.overlays.contacts.rings")


@pytest.fixture
def stepping(load, actor):
    """Left foot in contact from frame 10 to 20, both from 31 on, the hips in the first 5."""
    contacts = np.zeros((60, 7), bool)
    contacts[9:20, 0] = contacts[30:, :2] = True
    contacts[:5, 6] = True
    source = actor.animation_data.action, actor.animation_data.action_slot
    load("mocap_assist.actions.contact_keys").write_contacts(
        actor, *source, np.arange(1.0, 61.0), contacts
    )
    return actor


def rings(blank, markers, armature, frame):
    """Return the points and the color of each ring."""
    blank.context.scene.frame_set(frame)
    found = markers.rings_at(armature, frame)
    if found is None:
        return []
    n = markers.N_SEGMENTS
    return [
        (found.lines[start : start + n, 0], tuple(found.colors[start, 0]))
        for start in range(0, len(found.lines), n)
    ]


def test_ring_lies_flat_under_the_foot_in_contact(blank, load, markers, stepping):
    stepping.location = (5.0, 2.0, 1.0)
    stepping.scale = (2.0, 2.0, 2.0)
    ((points, color),) = rings(blank, markers, stepping, 15)

    ranges = load("mocap_assist.overlays.marked_ranges")
    assert color == pytest.approx(ranges.COLORS[ranges.Mark.LEFT])
    foot = stepping.pose.bones["LeftFoot"]
    ends = [stepping.matrix_world @ end for end in (foot.head, foot.tail)]
    assert_allclose(points[:, 2], min(end.z for end in ends), atol=1e-5)
    assert_allclose(points[:, :2].mean(axis=0), np.mean(ends, axis=0)[:2], atol=1e-5)


def test_each_part_in_contact_has_a_ring(blank, markers, stepping):
    numbers = [len(rings(blank, markers, stepping, frame)) for frame in (1, 8, 20, 21, 40, 60)]

    assert numbers == [1, 0, 1, 0, 2, 2]


def test_nothing_is_drawn_without_contact_keys(blank, markers, actor):
    assert rings(blank, markers, actor, 15) == []


def test_renamed_bone_has_no_ring(blank, markers, stepping):
    assert len(rings(blank, markers, stepping, 40)) == 2
    stepping.data.bones["LeftFoot"].name = "renamed"

    assert len(rings(blank, markers, stepping, 40)) == 1


def test_panel_has_the_switch_and_the_colors_of_the_sides(blank, draw, stepping):
    shown = draw("MOCAP_PT_feet")

    assert shown[-5:-1] == [
        "mocap_assist_contacts", "Left Contact", "Right Contact", "Hips Contact"
    ]  # fmt: skip
    blank.context.window_manager.mocap_assist_contacts = False
    try:
        assert "Left Contact" not in draw("MOCAP_PT_feet")
    finally:
        blank.context.window_manager.mocap_assist_contacts = True


def test_only_contact_keys_are_read(blank, load, markers, stepping, monkeypatch):
    """A 3D View cannot wait for all keys of a long action after each edit."""
    reading = load("mocap_assist.overlays.strip.reading")
    monkeypatch.setattr(reading, "read_action", None)

    assert len(rings(blank, markers, stepping, 40)) == 2


def test_contact_begins_at_a_key_between_frames(markers):
    """Blender stores 10.1 as 10.100000381."""
    keys = np.array([[1.0, 0.0], [np.float32(10.1), 1.0]])

    assert not markers.is_in_contact(keys, 10.0)
    assert markers.is_in_contact(keys, 10.1)


def test_armature_that_lost_its_bones_has_no_rings(blank, markers, stepping):
    blank.context.view_layer.objects.active = stepping
    blank.ops.object.mode_set(mode="EDIT")
    for bone in list(stepping.data.edit_bones):
        stepping.data.edit_bones.remove(bone)
    blank.ops.object.mode_set(mode="OBJECT")

    assert rings(blank, markers, stepping, 40) == []


def test_rings_follow_deleted_and_undone_keys(blank, load, markers, stepping):
    compat = load("mocap_assist.blender.compat")
    assert len(rings(blank, markers, stepping, 40)) == 2
    animation = stepping.animation_data
    bag = compat.channelbag(animation.action, animation.action_slot)
    bag.fcurves.remove(bag.fcurves.find('["mocap_contact_left"]'))
    load("mocap_assist.overlays.comparison.drawing").refresh()  # as after the edit

    assert len(rings(blank, markers, stepping, 40)) == 1
    blank.data.actions.remove(animation.action)
    assert rings(blank, markers, stepping, 40) == []
