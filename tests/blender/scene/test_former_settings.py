"""A .blend of an older version keeps its settings, though their names have changed."""

import bpy
import pytest

FORMER = [
    ("find", "n_alike", "n_neighbors", 12),
    ("check", "smallest_turn", "min_rotation_jump", 0.25),
    ("check", "n_spots", "max_issues", 7),
    ("track", "farthest", "max_distance", 4.5),
    ("track", "way", "actor_mask", 2),
]


@pytest.fixture
def opened(load, blank, tmp_path):
    """Open a file with values under former names."""

    def opened(stored):
        compat = load("mocap_assist.blender.compat")
        for group, former, present, value in stored:
            owner = getattr(blank.context.scene.mocap_assist, group)
            setattr(
                owner, present, getattr(owner, present)
            )  # a group without values is not stored
            properties = compat.stored_properties(owner)
            del properties[present]
            properties[former] = value
        path = str(tmp_path / "older.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        return bpy.context.scene.mocap_assist

    return opened


def test_settings_are_read_under_their_former_names(opened):
    scene = opened(FORMER)

    assert scene.find.n_neighbors == 12
    assert scene.check.min_rotation_jump == pytest.approx(0.25)
    assert scene.check.max_issues == 7
    assert scene.track.max_distance == pytest.approx(4.5)
    assert scene.track.actor_mask == "CUT"


def test_name_of_the_checked_action_becomes_a_pointer(load, blank, tmp_path):
    stored = blank.context.scene.mocap_assist
    blank.data.actions.new("walk").use_fake_user = True
    stored.report = "Jitter 1 cm"
    properties = load("mocap_assist.blender.compat").stored_properties
    properties(stored)["checked"] = "walk"
    path = str(tmp_path / "older.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)

    bpy.ops.wm.open_mainfile(filepath=path)

    stored = bpy.context.scene.mocap_assist
    assert stored.checked_action == bpy.data.actions["walk"]
    assert "checked" not in properties(stored)


def test_a_former_value_is_read_once(opened, tmp_path):
    scene = opened(FORMER)
    scene.find.property_unset("n_neighbors")
    path = str(tmp_path / "again.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)

    assert bpy.context.scene.mocap_assist.find.n_neighbors == 8


def test_each_former_name_is_of_a_setting_and_of_no_other(load):
    scene = bpy.context.scene.mocap_assist
    groups = [getattr(scene, each.identifier) for each in scene.bl_rna.properties]
    named = [each for each in groups if getattr(each, "former_names", None)]

    assert len(named) >= 4
    for group in named:
        assert set(group.former_names.values()) <= set(group.setting_names)
        assert not set(group.former_names) & set(group.setting_names)
