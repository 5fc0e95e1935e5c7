"""The panel of Physics."""


def test_the_panel_offers_every_setting_and_the_button(draw):
    shown = draw("MOCAP_PT_physics")

    assert {"strength", "ground", "ground_height", "response", "smoothing", "friction"} <= set(
        shown
    )
    assert "mocap_assist.simulate" in shown


def test_it_says_why_the_button_is_grey(draw):
    assert "Select an animated armature." in " ".join(draw("MOCAP_PT_physics"))
