"""Which panels the tab shows: those that suit the selection, in the order of the work."""

import numpy as np
import pytest

FOR_ARMATURES = [
    "import", "fix", "check", "reconstruct", "clean", "compare", "feet", "physics", "retarget",
    "library", "vary", "perform",
]  # fmt: skip


@pytest.fixture
def shown(blank, load):
    """Names of the panels of the 3D view that are shown, in their order."""

    def names():
        sidebar = load("mocap_assist.ui.sidebar")
        panels = [each for each in sidebar.PANELS if each.bl_space_type == "VIEW_3D"]
        found = {each.__name__.removeprefix("MOCAP_PT_"): each for each in panels}
        visible = [name for name, each in found.items() if _polls(each, blank.context)]
        return [name for name in visible if _is_within(found[name], visible)]

    return names


def _polls(panel, context):
    return not hasattr(panel, "poll") or panel.poll(context)


def _is_within(panel, visible):
    """A panel within another one is shown with it."""
    parent = getattr(panel, "bl_parent_id", "").removeprefix("MOCAP_PT_")
    return not parent or parent in visible


def test_empty_scene_has_only_import(shown, draw):
    assert shown() == ["import"]
    assert draw("MOCAP_PT_import") == [
        "mocap_assist.import_recording", "Or drop files into the 3D", "View.",
        "mocap_assist.load_sample", "wm.url_open", "mocap_assist.add_workspace",
    ]  # fmt: skip


def test_track_live_is_there_once_its_recording_is_chosen(blank, shown, actor):
    actor.select_set(False)
    blank.context.view_layer.objects.active = None

    blank.ops.mocap_assist.choose_live(directory="/tmp/take/", filename="1.png")

    live = blank.context.scene.mocap_assist.track_live
    assert live.recording_file == "/tmp/take/1.png" and shown() == ["import", "tracklive"]
    blank.context.view_layer.objects.active = actor
    actor.select_set(True)
    assert shown() == FOR_ARMATURES


def test_choice_of_no_recording_is_one_sentence(blank):
    with pytest.raises(RuntimeError, match="Choose the folder that the recorder writes to"):
        blank.ops.mocap_assist.choose_live()


def test_other_objects_change_nothing(blank, shown):
    blank.ops.mesh.primitive_cube_add()

    assert shown() == ["import"]


def test_selected_armature_that_is_not_active_gets_a_hint(blank, actor, shown, draw):
    blank.context.view_layer.objects.active = None
    actor.select_set(True)

    assert shown() == ["import"]
    drawn = " ".join(draw("MOCAP_PT_import"))
    assert "Shift-click the selected armature" in drawn and "load_sample" not in drawn
    with pytest.raises(RuntimeError, match="Shift-click the selected armature"):
        blank.ops.mocap_assist.denoise()

    actor.select_set(False)
    assert "mocap_assist.load_sample" in draw("MOCAP_PT_import")


def test_armature_has_its_panels_in_the_order_of_the_work(actor, shown, draw):
    assert shown() == FOR_ARMATURES
    assert "mocap_assist.load_sample" not in draw("MOCAP_PT_import")


def test_import_of_a_skeleton_needs_no_reconstruction(blank, shown):
    blank.ops.mocap_assist.load_sample()

    assert shown() == [name for name in FOR_ARMATURES if name != "reconstruct"]


def test_markers_have_their_panel_and_none_of_armatures(blank, load, shown, tmp_path):
    positions = np.random.default_rng(3).normal(size=(30, 2, 3))
    tracks = load("solvers.motion").Tracks(("a", "b"), positions, 24.0)
    load("solvers.recordings").write_trc(tracks, tmp_path / "two.trc")

    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "two.trc"))

    assert shown() == [
        "import", "fix", "check", "markers", "clean", "compare", "library", "perform",
    ]  # fmt: skip


def test_all_panels_are_shown_on_request(all_panels, shown, draw):
    assert set(shown()) == {*FOR_ARMATURES, "markers", "track", "tracklive"}
    assert "mocap_assist.load_sample" in draw("MOCAP_PT_import")


def test_compare_and_feet_belong_to_clean_in_each_editor(load, blank):
    for suffix in ("", "_graph", "_dopesheet"):
        for name in ("compare", "feet"):
            panel = getattr(blank.types, f"MOCAP_PT_{name}{suffix}")
            assert panel.bl_parent_id == f"MOCAP_PT_clean{suffix}"


def test_perform_is_last_and_closed(load):
    last = load("mocap_assist.ui.sidebar").BODIES[-1]

    assert last.bl_label == "Perform" and "DEFAULT_CLOSED" in last.bl_options


def test_matches_keep_the_library_in_sight(blank, shown):
    rows = blank.context.window_manager.mocap_assist_matches.rows
    rows.add()

    assert shown() == ["import", "library"]
    rows.clear()
