"""The image of the labels: the region is drawn on as before it was made."""

import sys
from contextlib import contextmanager
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest


@pytest.fixture
def target(load, monkeypatch):
    """What is drawn to, in a GPU that goes back as Blender's does.

    After a frame buffer it is what it was before, after an offscreen the whole window.
    """
    target, gpu = SimpleNamespace(name="region"), MagicMock()

    def binding(after):
        @contextmanager
        def bind():
            before, target.name = target.name, "image"
            yield
            target.name = after or before

        return bind

    gpu.types.GPUOffScreen.return_value.bind = binding("window")
    gpu.types.GPUFrameBuffer.return_value.bind = binding(None)
    module = load("mocap_assist.overlays.strip.labels")
    monkeypatch.setattr(module, "gpu", gpu)
    monkeypatch.setattr(module, "blf", MagicMock(dimensions=lambda *_: (50.0, 10.0)))
    monkeypatch.setattr(module.blf, "draw", lambda *_: target.drawn.append(target.name))
    monkeypatch.setattr(module, "_images", {})
    monkeypatch.setitem(sys.modules, "gpu_extras.batch", MagicMock())
    target.drawn = []
    return target


def test_first_drawing_is_in_the_region_too(load, target):
    module = load("mocap_assist.overlays.strip.labels")
    labels = module.Labels(("Left Foot", "Right Foot"), 13.0, 1.0)

    module.draw_labels(labels, 20.0)
    module.draw_labels(labels, 20.0)

    assert target.name == "region"
    assert target.drawn == ["image", "image"]  # once for each label
