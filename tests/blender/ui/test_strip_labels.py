"""The image of the labels: the region is drawn on as before it was made."""

import sys
from contextlib import contextmanager
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

REGION, WINDOW = (0, 0, 801, 411), (0, 0, 1600, 1000)


@pytest.fixture
def state(load, monkeypatch):
    """The state of a GPU that goes back to the whole window after an image, as Blender does."""
    state = SimpleNamespace(viewport=REGION, scissor=REGION)
    gpu = MagicMock()
    gpu.state.viewport_get = lambda: state.viewport
    gpu.state.scissor_get = lambda: state.scissor
    gpu.state.viewport_set = lambda *given: setattr(state, "viewport", given)
    gpu.state.scissor_set = lambda *given: setattr(state, "scissor", given)

    @contextmanager
    def bind():
        yield
        state.viewport = state.scissor = WINDOW

    gpu.types.GPUOffScreen.return_value.bind = bind
    module = load("mocap_assist.overlays.strip_labels")
    monkeypatch.setattr(module, "gpu", gpu)
    monkeypatch.setattr(module, "blf", MagicMock(dimensions=lambda *_: (50.0, 10.0)))
    monkeypatch.setitem(sys.modules, "gpu_extras.batch", MagicMock())
    monkeypatch.setattr(module, "_images", {})
    return state


def test_first_drawing_is_in_the_region_too(load, state):
    module = load("mocap_assist.overlays.strip_labels")

    module.draw_labels(module.Labels(("Left Foot", "Right Foot"), 13.0, 1.0), 20.0)

    assert (state.viewport, state.scissor) == (REGION, REGION)
