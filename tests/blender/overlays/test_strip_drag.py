"""A drag on the strip sets the range to work on, and a click or Esc gives it back."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def drag(load):
    return load("mocap_assist.overlays.strip.drag")


@pytest.fixture
def editor(blank, load, actor):
    """A Dope Sheet of 1000 pixels that shows frames 0 to 100, and a strip of one row."""
    contacts = np.ones((60, 2), bool)
    contacts[:, 0] = False
    action, slot = actor.animation_data.action, actor.animation_data.action_slot
    load("mocap_assist.overlays.strip.reading").forget()
    load("mocap_assist.actions.contact_keys").write_contacts(
        actor, action, slot, np.arange(1.0, 61.0), contacts
    )
    view = SimpleNamespace(region_to_view=lambda x, y: (0.1 * x, y))
    return SimpleNamespace(
        scene=blank.context.scene,
        view_layer=blank.context.view_layer,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(width=1000, height=300, view2d=view),
        space_data=SimpleNamespace(
            type="DOPESHEET_EDITOR", mode="DOPESHEET", show_markers=True
        ),
        window_manager=SimpleNamespace(
            mocap_assist_strip=True, modal_handler_add=lambda _: None, windows=[]
        ),
    )


@pytest.fixture
def button(drag, blank):
    """The operator with plain attributes in place of Blender's properties."""
    reports = []
    made = type(
        "Button",
        (drag.RangeOperator,),
        {"start": 1, "end": 0, "report": lambda _, __, text: reports.append(text)},
    )()
    made.reports = reports
    return made


def at(kind, x, y=20, value="PRESS"):
    return SimpleNamespace(type=kind, value=value, mouse_region_x=x, mouse_region_y=y)


def pull(button, editor, first, last):
    assert button.invoke(editor, at("LEFTMOUSE", first)) == {"RUNNING_MODAL"}
    button.modal(editor, at("MOUSEMOVE", last))


def test_drag_sets_the_preview_range_that_clean_works_on(button, editor):
    shown = editor.scene.mocap_assist
    pull(button, editor, 402, 101)

    assert button.modal(editor, at("LEFTMOUSE", 101, value="RELEASE")) == {"FINISHED"}

    assert editor.scene.use_preview_range
    assert (editor.scene.frame_preview_start, editor.scene.frame_preview_end) == (10, 40)
    assert shown.clean.frame_range == shown.reconstruct.frame_range == "PREVIEW"
    assert button.reports == ["Clean and Reconstruct work on frames 10 to 40."]

    button.invoke(editor, at("LEFTMOUSE", 500))
    assert button.modal(editor, at("LEFTMOUSE", 501, value="RELEASE")) == {"FINISHED"}
    assert not editor.scene.use_preview_range
    assert shown.clean.frame_range == "ACTION"


def test_esc_restores_the_range(button, drag, editor):
    scene = editor.scene
    scene.mocap_assist.clean.frame_range = "SCENE"
    before = drag.working_range(scene)
    pull(button, editor, 100, 400)
    assert drag.working_range(scene) != before

    assert button.modal(editor, at("ESC", 400)) == {"CANCELLED"}

    assert drag.working_range(scene) == before


@pytest.mark.parametrize("height", [5, 60])
def test_press_outside_the_strip_is_blenders(button, editor, height):
    assert button.invoke(editor, at("LEFTMOUSE", 100, height)) == {"PASS_THROUGH"}


def test_script_sets_and_clears_the_range(blank):
    scene = blank.context.scene
    assert blank.ops.mocap_assist.set_range(start=5, end=9) == {"FINISHED"}
    assert (scene.frame_preview_start, scene.frame_preview_end) == (5, 9)
    assert blank.ops.mocap_assist.set_range() == {"FINISHED"}
    assert not scene.use_preview_range
