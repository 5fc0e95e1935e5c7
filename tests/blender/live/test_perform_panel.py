"""The panel Perform says what can be done, and what was heard."""

import pytest


def test_at_first_there_is_the_button_and_the_port(draw):
    assert draw("MOCAP_PT_perform") == ["mocap_assist.listen", "live_port"]


def test_while_it_listens_it_tells_what_it_hears(draw, listen, act):
    button = listen()
    assert "No data yet." in " ".join(draw("MOCAP_PT_perform"))

    act(button, "hand up")

    shown = " ".join(draw("MOCAP_PT_perform"))
    assert "Wave to page, clap to perform" in shown
    assert "No search yet." in shown
    assert "frames, 0 dropped" in shown


@pytest.mark.parametrize("suffix", ["", "_graph", "_dopesheet"])
def test_it_is_on_the_tab(blank, suffix):
    assert getattr(blank.types, f"MOCAP_PT_perform{suffix}").bl_category == "Mocap"
