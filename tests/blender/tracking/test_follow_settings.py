"""The panel Track Live, and the settings that its button takes."""

import pytest


@pytest.mark.parametrize(
    ("chosen", "recording"),
    [
        ("take", "take"),
        ("take/000001.png", "take"),
        ("take/depth/1.5.png", "take"),
        ("take/film.mkv", "take/film.mkv"),
    ],
)
def test_chosen_image_stands_for_its_folder(load, tmp_path, chosen, recording):
    found = load("mocap_assist.track.following").recording_of(tmp_path / chosen)

    assert found == tmp_path / recording


def test_panel_offers_the_button_once_a_folder_is_chosen(blank, draw, all_panels):
    assert "Choose the folder that" in " ".join(draw("MOCAP_PT_tracklive"))
    blank.context.scene.mocap_assist.track_live.recording_file = "/tmp/take"

    drawn = draw("MOCAP_PT_tracklive")

    assert "mocap_assist.track_live" in drawn and "focal_length" in drawn
    assert "Choose the folder that" not in " ".join(drawn)


def test_settings_of_track_are_shared(load, blank):
    """Those of the panel Track Live and those of Track are copied, but none that is given."""
    scene = blank.context.scene
    scene.mocap_assist.track.refine = False
    scene.mocap_assist.track.plant_feet = False
    scene.mocap_assist.track_live.calibration = 4.0
    button = load("operators.track_live").MOCAP_OT_track_live
    given = {}

    class Pressed(button.__bases__[0]):
        setting_names = button.setting_names

        class properties:
            is_property_set = staticmethod("plant_feet".__eq__)

        def __setattr__(self, name, value):
            given[name] = value

    Pressed().prepare(blank.context)

    assert given["refine"] is False and given["calibration"] == 4.0
    assert "plant_feet" not in given and "method" in given
