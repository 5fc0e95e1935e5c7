"""Import is where an animator looks for it, and takes dropped files."""

import pytest

IMPORT = "mocap_assist.import_recording"
EXTENSIONS = {
    ".bvh", ".amc", ".asf", ".c3d", ".trc", ".skeleton", ".csv", ".json", ".txt", ".npy",
    ".npz", ".mkv", ".mat", ".mvnx", ".fbx", ".glb", ".gltf", ".vrm", ".vrma", ".usd", ".usda",
    ".usdc", ".usdz", ".dae", ".tsv",
}  # fmt: skip


def test_files_of_every_format_can_be_dropped(blank):
    handler = blank.types.MOCAP_FH_recording

    assert set(handler.bl_file_extensions.split(";")) == EXTENSIONS
    assert handler.bl_import_operator == IMPORT
    # What Blender fills in for dropped files, and must not remember for the next ones.
    given = blank.ops.mocap_assist.import_recording.get_rna_type().properties
    for name in ("directory", "files", "filepath"):
        assert given[name].is_skip_save


@pytest.mark.parametrize(("area", "taken"), [("VIEW_3D", True), ("TEXT_EDITOR", False)])
def test_files_can_be_dropped_in_object_editors(area, taken, blank):
    screen = blank.context.window.screen
    editor = max(screen.areas, key=lambda each: each.width)
    before, editor.type = editor.type, area
    region = next(each for each in editor.regions if each.type == "WINDOW")
    try:
        with blank.context.temp_override(area=editor, region=region):
            polled = blank.types.MOCAP_FH_recording.poll_drop(blank.context)
    finally:
        editor.type = before

    assert bool(polled) == taken


def test_file_menu_has_the_import_entry(blank, draw):
    menu = blank.types.TOPBAR_MT_file_import

    entries = [each for each in menu._dyn_ui_initialize() if "mocap_assist" in each.__module__]

    assert len(entries) == 1


def test_clean_panel_hides_joint_settings_for_markers(blank, draw, load, actor, rng, tmp_path):
    joints = {"joint_limits", "plant_feet", "contact_height"}
    assert joints - {"contact_height"} <= set(draw("MOCAP_PT_clean"))
    tracks = load("solvers.motion").Tracks(("a", "b"), rng.normal(size=(30, 2, 3)), 24.0)
    load("solvers.recordings").write_trc(tracks, tmp_path / "two.trc")

    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "two.trc"))

    shown = set(draw("MOCAP_PT_clean"))
    assert not joints & shown
    assert {"strength", "frame_range", "mocap_assist.denoise"} <= shown


def test_panel_shows_the_source_of_the_selected_take(blank, draw, load, tmp_path):
    samples = load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=25.0))
    load("solvers.recordings").write_bvh(walk, tmp_path / "stroll.bvh")
    drawn = draw("MOCAP_PT_import")
    assert drawn[0] == IMPORT and "mocap_assist.load_sample" in drawn

    blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / "stroll.bvh"))

    first, *rest = draw("MOCAP_PT_import")
    assert [first, *rest[:2]] == [IMPORT, "stroll.bvh", "25 frames, 25 Hz"]
    assert " ".join(rest[2:-1]) == "Y is up, Z is forward, lengths are in centimeters."
    assert rest[-1] == "mocap_assist.change_axes"


def test_panel_names_sensors_as_their_makers_do(load):
    figures = load("mocap_assist.importing.panel")._figures
    origin = {"n_frames": 49, "frame_rate": 30.0}

    assert figures(origin | {"sensor": "kinect_v2"}) == "49 frames, 30 Hz, Kinect v2"
    assert figures(origin | {"sensor": "other"}) == "49 frames, 30 Hz"
    sensors = {each.value for each in load("solvers.motion").Sensor}
    assert sensors - {"other"} == set(load("mocap_assist.importing.panel").SENSOR_NAMES)
