"""A .blend file from somebody else shows a depth recording only when the animator asks."""

import json

import pytest
from depth_views import points_of

NEAR = 1e-4  # metres: 32-bit numbers


@pytest.fixture
def elsewhere(load, tmp_path, monkeypatch):
    """Another machine: nothing was allowed there."""
    permissions = load("mocap_assist.permissions")

    def move():
        monkeypatch.setattr(permissions, "_file", lambda: tmp_path / "permissions.json")

    return move


def test_a_recording_that_was_never_opened_here_is_opened_only_when_asked(
    archive, bring, blank, draw, elsewhere, load, monkeypatch
):
    bring(archive, frame_rate="ONE")
    blank.ops.wm.save_as_mainfile(filepath=str(archive.with_suffix(".blend")))
    elsewhere()
    preview = load("mocap_assist.scene.depth_preview")
    opened, read_depth = [], preview.read_depth
    monkeypatch.setattr(
        preview, "read_depth", lambda *given: opened.append(given) or read_depth(*given)
    )

    blank.ops.wm.open_mainfile(filepath=str(archive.with_suffix(".blend")))
    blank.context.scene.frame_set(3)

    made = blank.data.objects["wall"]
    assert not opened and not len(points_of(made))
    shown = " ".join(draw("MOCAP_PT_import"))
    assert "was not opened here" in shown and "Show Points" in shown
    assert not blank.ops.mocap_assist.track_depth.poll()

    assert blank.ops.mocap_assist.show_depth() == {"FINISHED"}

    assert points_of(made)[-1, 1] == pytest.approx(2.8, abs=NEAR)
    blank.ops.wm.open_mainfile(filepath=str(archive.with_suffix(".blend")))
    assert len(points_of(blank.data.objects["wall"]))


@pytest.mark.parametrize(
    "change",
    [
        {"step": 0.0},
        {"step": float("nan")},
        {"start": float("inf")},
        {"every": 0},
        {"path": 3, "settings": []},
        {"settings": {"held": "SIDEWAYS"}},
    ],
    ids=str,
)
def test_a_preview_that_was_tampered_with_shows_nothing(archive, bring, blank, change):
    mesh = bring(archive).data
    mesh["mocap_assist_depth"] = json.dumps(json.loads(mesh["mocap_assist_depth"]) | change)

    blank.context.scene.frame_set(3)

    assert "shows no recording" in mesh["mocap_assist_depth_problem"]


def test_points_whose_attribute_was_replaced_are_hidden(archive, bring, blank):
    mesh = bring(archive).data
    mesh.attributes.remove(mesh.attributes["seen"])
    mesh.attributes.new("seen", "FLOAT", "POINT")

    blank.context.scene.frame_set(3)

    assert "was edited" in mesh["mocap_assist_depth_problem"]
