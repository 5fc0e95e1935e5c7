"""The panel Perform shows what can be done, and what was received."""

import pytest


@pytest.mark.usefixtures("all_panels")
def test_panel_shows_button_and_port_before_listening(draw):
    shown = draw("MOCAP_PT_perform")

    assert " ".join(shown[:3]) == "Search the library with gestures, or record a live stream."
    assert shown[3:] == [
        "live_port", "live_protocol", "live_person", "mocap_assist.listen",
    ]  # fmt: skip


def test_panel_shows_received_frames_while_listening(draw, listen, act):
    button = listen()
    assert "No data yet." in " ".join(draw("MOCAP_PT_perform"))

    act(button, "hand up")

    shown = " ".join(draw("MOCAP_PT_perform"))
    assert "Wave to page, left hand up to search with this clip" in shown
    assert "There is no library yet" in shown
    assert "JSON from 127.0.0.1:" in shown and "0 dropped." in shown


@pytest.mark.parametrize("suffix", ["", "_graph", "_dopesheet"])
def test_panel_is_on_the_mocap_tab(blank, suffix):
    assert getattr(blank.types, f"MOCAP_PT_perform{suffix}").bl_category == "Mocap"
