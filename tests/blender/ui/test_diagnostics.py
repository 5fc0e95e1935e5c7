"""What Copy Diagnostics says about an error, and what it never says."""

import getpass
from pathlib import Path

import bpy
import pytest

SECRET = "SecretShow"


@pytest.fixture
def copied(load):
    """Return what the button copies; without a window Blender has no clipboard."""
    return lambda: load("mocap_assist.ui.diagnostics").diagnostics(bpy.context)


def test_diagnostics_of_an_error_have_its_place_and_no_names(blank, actor, copied):
    actor.name = actor.data.name = f"{SECRET}Rig"
    actor.animation_data.action.name = f"{SECRET} take"
    with pytest.raises(RuntimeError, match=SECRET):
        bpy.ops.mocap_assist.denoise(
            strength=0.5, prior="EXAMPLES", examples=f"/home/{SECRET}/missing.bvh"
        )

    text = copied()

    assert "Last press: MOCAP_ASSIST_OT_denoise, ended with " in text
    assert "  mocap_assist/clean/" in text
    assert "strength 0.5" in text
    assert f"{len(actor.data.bones)} bones" in text
    for private in (SECRET, *actor.data.bones.keys(), str(Path.home()), "/tmp"):
        assert private not in text, private
    assert f" {getpass.getuser()} " not in text


def test_diagnostics_of_an_unexpected_error_have_its_place(blank, load, copied):
    class Button(load("mocap_assist.blender.act_operator").ActOperator):
        bl_idname = "MOCAP_ASSIST_OT_broken"

        def act(self, context):
            raise KeyError(SECRET)

    with pytest.raises(KeyError):
        Button().execute(bpy.context)

    text = copied()
    assert "Last press: MOCAP_ASSIST_OT_broken, ended with KeyError" in text
    assert "  mocap_assist/blender/act_operator.py:" in text
    assert SECRET not in text


def test_diagnostics_name_versions_and_changed_preferences(blank, copied, load):
    ours = load("mocap_assist.panel_parts.preference_values").preferences()
    ours.tab, ours.show_research = SECRET, True
    try:
        text = copied()
    finally:
        bpy.ops.mocap_assist.reset_preferences()

    assert text.startswith(f"Mocap Assist {load('solvers.version').version()}, ")
    assert bpy.app.version_string in text
    assert "show_research True" in text
    assert " missing\n" not in text and " missing," not in text
    assert SECRET not in text
    assert "Preferences: defaults\n" in copied()


@pytest.mark.parametrize(
    ("message", "template"),
    [
        ("", ""),
        ("Nothing of ours knows Anna.", "…"),
        ("Cancelled. Nothing of ours knows Anna.", "Cancelled. …"),
        ("Planted 12 contacts of Anna.bvh.", "…"),
    ],
)
def test_messages_lose_what_no_catalog_knows(load, message, template):
    assert load("mocap_assist.languages").template_of(message) == template


def test_choices_that_depend_on_files_are_left_out_without_a_warning(load, capfd):
    """Blender warns in the console when such a choice is asked for its default."""
    last = bpy.context.window_manager.operator_properties_last("mocap_assist.import_recording")

    found = load("mocap_assist.blender.last_press").changed_values(last)

    assert "body_choice" not in found
    assert "matches no enum" not in "".join(capfd.readouterr())
