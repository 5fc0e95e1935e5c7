"""The panel Perform says what can be done, and what was heard."""

import importlib.util
from pathlib import Path

import pytest


@pytest.fixture
def draw(blank):
    """Draw the panel as the tests of the other panels do; it asks for a window, so no poll."""
    path = Path(__file__).parents[1] / "ui" / "conftest.py"
    spec = importlib.util.spec_from_file_location("ui_conftest", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)

    def drawn():
        from types import SimpleNamespace

        kind, shown = blank.types.MOCAP_PT_perform, []
        kind.draw(SimpleNamespace(layout=module.Noted(blank, shown)), blank.context)
        return shown

    return drawn


def test_at_first_there_is_the_button_and_the_port(draw):
    assert draw() == ["mocap_assist.listen", "live_port"]


def test_while_it_listens_it_tells_what_it_hears(draw, listen, act):
    button = listen()
    assert "Nobody is seen yet." in " ".join(draw())

    act(button, "hand up")

    shown = " ".join(draw())
    assert "Wave to page, clap to perform" in shown
    assert "There is no library to show yet." in shown
    assert "frames, 0 dropped" in shown


@pytest.mark.parametrize("suffix", ["", "_graph", "_dopesheet"])
def test_it_is_on_the_tab(blank, suffix):
    assert getattr(blank.types, f"MOCAP_PT_perform{suffix}").bl_category == "Mocap"
