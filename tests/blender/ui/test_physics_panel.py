"""The panel of Physics."""

import pytest

pytestmark = pytest.mark.usefixtures("all_panels")


def test_physics_panel_shows_every_setting_and_the_button(draw):
    shown = draw("MOCAP_PT_physics")

    assert {"strength", "ground", "ground_height", "response", "smoothing", "friction"} <= set(
        shown
    )
    assert "mocap_assist.simulate" in shown


def test_physics_panel_gives_a_reason_when_disabled(draw):
    assert "Select an animated armature." in " ".join(draw("MOCAP_PT_physics"))
