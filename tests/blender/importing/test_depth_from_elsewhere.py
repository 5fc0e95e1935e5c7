"""A .blend file of another user shows a depth recording only when the animator asks."""

import json

import pytest
from depth_views import points_of

TOLERANCE_M = 1e-4  # meters: 32-bit numbers


@pytest.fixture
def elsewhere(load, tmp_path, monkeypatch):
    """Another machine: nothing was allowed there."""
    permissions = load("mocap_assist.blender.permissions")

    def move():
        monkeypatch.setattr(permissions, "_file", lambda: tmp_path / "permissions.json")

    return move


def test_unknown_recording_is_opened_only_on_request(
    archive, bring, blank, draw, elsewhere, load, monkeypatch
):
    bring(archive, frame_rate="ONE")
    blank.ops.wm.save_as_mainfile(filepath=str(archive.with_suffix(".blend")))
    elsewhere()
    preview = load("mocap_assist.depth.depth_preview")
    opened, read_depth = [], preview.read_depth
    monkeypatch.setattr(
        preview, "read_depth", lambda *given: opened.append(given) or read_depth(*given)
    )

    blank.ops.wm.open_mainfile(filepath=str(archive.with_suffix(".blend")))
    blank.context.scene.frame_set(3)

    made = blank.data.objects["wall"]
    assert not opened and not len(points_of(made))
    shown = " ".join(draw("MOCAP_PT_import"))
    assert "has not been opened on this machine yet" in shown and "Show Points" in shown
    assert not blank.ops.mocap_assist.track_depth.poll()

    assert blank.ops.mocap_assist.show_depth() == {"FINISHED"}
    press = load("mocap_assist.blender.last_press").last_press()
    assert "show_depth" in press.button.lower()

    assert points_of(made)[-1, 1] == pytest.approx(2.8, abs=TOLERANCE_M)
    blank.ops.wm.open_mainfile(filepath=str(archive.with_suffix(".blend")))
    assert len(points_of(blank.data.objects["wall"]))


@pytest.mark.parametrize(
    "change",
    [
        {"step": 0.0},
        {"step": float("nan")},
        {"start": float("inf")},
        {"start": "nan"},
        {"start": 10**400},
        {"step": "inf"},
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

    assert "shows no depth recording" in mesh["mocap_assist_depth_problem"]


@pytest.mark.parametrize("number", ["1e999", "-1e999", "1" + 400 * "0"])
def test_a_number_beyond_all_numbers_shows_nothing(archive, bring, blank, number):
    mesh = bring(archive).data
    stored = json.loads(mesh["mocap_assist_depth"]) | {"start": "HERE"}
    mesh["mocap_assist_depth"] = json.dumps(stored).replace('"HERE"', number)

    blank.context.scene.frame_set(3)

    assert "shows no depth recording" in mesh["mocap_assist_depth_problem"]


def test_the_steepest_step_shows_an_end_of_the_recording(archive, bring, blank, capsys):
    mesh = bring(archive).data
    stored = json.loads(mesh["mocap_assist_depth"])
    mesh["mocap_assist_depth"] = json.dumps(stored | {"step": 1e-320, "every": 10**300})

    for frame in (-5, 1, 3):
        blank.context.scene.frame_set(frame)

    assert "mocap_assist_depth_problem" not in mesh
    assert "Traceback" not in capsys.readouterr().err


def test_the_other_previews_follow_when_one_raises(archive, bring, blank, load, monkeypatch):
    meshes = [bring(archive).data for _ in range(2)]
    preview = load("mocap_assist.depth.depth_preview")
    shown, show = [], preview.show_points

    def fail_once(mesh, frame):
        shown.append(mesh)
        if len(shown) == 1:
            raise IndexError
        show(mesh, frame)

    monkeypatch.setattr(preview, "show_points", fail_once)

    blank.context.scene.frame_set(3)

    assert shown == meshes
    assert "bug in Mocap Assist" in meshes[0]["mocap_assist_depth_problem"]


def test_points_whose_attribute_was_replaced_are_hidden(archive, bring, blank):
    mesh = bring(archive).data
    mesh.attributes.remove(mesh.attributes["seen"])
    mesh.attributes.new("seen", "FLOAT", "POINT")

    blank.context.scene.frame_set(3)

    assert "was edited" in mesh["mocap_assist_depth_problem"]
