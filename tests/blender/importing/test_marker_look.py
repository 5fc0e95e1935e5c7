"""Markers look like a body: sticks, no lines to a parent, computed points out of sight."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

GAIT = "formats/c3d/PiG_Motion-FlatFoot-Hole.c3d"  # 35 markers, 78 computed points
TOLERANCE_M = 1e-5  # meters; 32-bit numbers


@pytest.fixture
def gait(recordings, bring):
    return bring(recordings / GAIT)


def sticks_of(holder):
    return next(each for each in holder.children if "mocap_assist_sticks" in each)


def ends_of(sticks, blank):
    """Ends of all sticks in the world, as Blender draws them."""
    depsgraph = blank.context.evaluated_depsgraph_get()
    shown = sticks.evaluated_get(depsgraph)
    mesh = shown.data
    positions = np.array([shown.matrix_world @ vertex.co for vertex in mesh.vertices])
    return positions[np.array([edge.vertices[:] for edge in mesh.edges])]


def names_of_ends(sticks, holder, load):
    """Names of the markers that each stick connects, by the rule for their names."""
    markers = load("mocap_assist.actions.markers.holders").markers_of(holder)
    names = [each["mocap_assist_point"] for each in markers]
    where = dict(zip(names, markers, strict=True))
    pairs = load("solvers.markers").find_marker_sticks(names)
    return [(where[names[one]], where[names[other]]) for one, other in pairs]


def assert_follows(holder, blank, load):
    sticks = sticks_of(holder)
    expected = {
        tuple(sorted((one.name, other.name))): np.array([
            one.matrix_world.translation, other.matrix_world.translation
        ])
        for one, other in names_of_ends(sticks, holder, load)
    }  # fmt: skip
    found = ends_of(sticks, blank)
    assert len(found) == len(expected) > 30
    for ends in expected.values():
        distances = np.minimum(
            np.abs(found - ends).max(axis=(1, 2)), np.abs(found - ends[::-1]).max(axis=(1, 2))
        )
        assert distances.min() < TOLERANCE_M


def test_sticks_follow_the_markers_even_when_the_take_is_moved(gait, blank, load):
    scene = blank.context.scene
    for frame in (1, 100, 250):
        scene.frame_set(frame)
        assert_follows(gait, blank, load)

    gait.location, gait.rotation_euler.z, gait.scale = (3.0, -1.0, 0.5), 0.7, [2.0] * 3
    scene.frame_set(120)
    assert_follows(gait, blank, load)


def test_sticks_survive_save_and_load_and_new_names(gait, blank, load, tmp_path):
    for number, marker in enumerate(
        load("mocap_assist.actions.markers.holders").markers_of(gait)
    ):
        marker.name = f"other {number % 7} {number}"
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))

    blank.context.scene.frame_set(50)

    holder = blank.data.objects["PiG_Motion-FlatFoot-Hole"]
    assert_follows(holder, blank, load)


def test_computed_points_lie_in_a_hidden_collection(gait, blank, load, capfd):
    markers = load("mocap_assist.actions.markers.holders").markers_of(gait)

    assert len(markers) == 35
    assert {"LASI", "CLAV"} <= {each["mocap_assist_point"] for each in markers}
    hidden = blank.data.collections["PiG_Motion-FlatFoot-Hole model outputs"]
    computed = [each for each in hidden.objects if "mocap_assist_point" in each]
    assert len(computed) == 78
    assert not any(each.visible_get() for each in hidden.objects)
    assert all(each.visible_get() for each in markers)
    assert {each.animation_data.action for each in computed}.isdisjoint(
        each.animation_data.action for each in markers
    )


def test_computed_points_move_with_the_take(gait, blank):
    hidden = blank.data.collections["PiG_Motion-FlatFoot-Hole model outputs"]
    point = hidden.objects["PELO"]
    blank.context.view_layer.layer_collection.children[0].hide_viewport = False
    blank.context.view_layer.update()
    before = np.array(point.matrix_world.translation)

    gait.location.x += 2.0
    blank.context.view_layer.update()

    assert_allclose(
        np.array(point.matrix_world.translation) - before, [2.0, 0.0, 0.0], atol=TOLERANCE_M
    )


def test_computed_points_are_not_cleaned(gait, blank):
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    hidden = blank.data.collections["PiG_Motion-FlatFoot-Hole model outputs"]
    played = {each.animation_data.action.name for each in hidden.objects if each.animation_data}
    assert not any("clean" in name for name in played)


def test_markers_are_selected_and_their_parent_is_active(gait, blank, load):
    markers = load("mocap_assist.actions.markers.holders").markers_of(gait)

    assert blank.context.object == gait
    assert set(blank.context.selected_objects) == set(markers)
    # Blender draws a line to a parent that is drawn itself.
    assert not gait.show_instancer_for_viewport


def test_sticks_stand_for_their_take(gait, blank, load):
    selection = load("mocap_assist.runtime.selection")
    blank.context.view_layer.objects.active = sticks_of(gait)

    assert selection.selected_subject(blank.context) == gait
    assert not selection.why_not_clean(blank.context)


def test_joints_as_empties_have_sticks_to_their_parents(recordings, bring, blank):
    path = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"

    holder = bring(path, target="OBJECT")

    assert len(ends_of(sticks_of(holder), blank)) == 24  # of 25 joints, all but the root


def test_undo_leaves_neither_sticks_nor_collection(recordings, blank, load, monkeypatch):
    sticks = load("mocap_assist.importing.marker_objects")

    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(sticks, "write_sensor_values", fail)
    with pytest.raises(RuntimeError):
        blank.ops.mocap_assist.import_recording(filepath=str(recordings / GAIT))

    for kind in ("objects", "collections", "node_groups", "meshes", "actions"):
        assert not getattr(blank.data, kind), kind


def test_armatures_are_sticks_in_front(recordings, bring):
    armature = bring(recordings / "mocap" / "cmu_walk" / "07_01.bvh")

    assert armature.data.display_type == "STICK"
    assert armature.show_in_front
    assert armature.mode == "OBJECT"  # a script goes on as before
