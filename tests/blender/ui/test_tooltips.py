"""Tooltips of buttons, properties and choices are there, and short enough to be read."""

import bpy
import pytest

MAX_TOOLTIP = 110
CHOICE_TOOLTIP = range(10, MAX_TOOLTIP + 1)


def buttons():
    for name in dir(bpy.ops.mocap_assist):
        yield getattr(bpy.ops.mocap_assist, name).get_rna_type()


def owners(extension):
    """Everything of ours that has properties: groups, preferences and buttons."""
    for base in (bpy.types.PropertyGroup, bpy.types.AddonPreferences):
        for each in base.__subclasses__():
            if each.__module__.startswith(extension.__name__) and each.is_registered:
                yield each.bl_rna
    yield from buttons()


@pytest.fixture
def properties(extension):
    """Return our properties by the name of what has them and their own."""
    found = {
        f"{owner.identifier}.{each.identifier}": each
        for owner in owners(extension)
        for each in owner.properties
        if each.identifier not in {"rna_type", "bl_idname"}
    }
    found |= {
        f"WindowManager.{each.identifier}": each
        for each in bpy.types.WindowManager.bl_rna.properties
        if each.identifier.startswith("mocap_assist")
    }
    assert len(found) > 150
    return found


def test_every_button_has_a_short_tooltip():
    long = {each.identifier: each.description for each in buttons()}

    assert {name: text for name, text in long.items() if len(text) > MAX_TOOLTIP} == {}
    assert [name for name, text in long.items() if not text or text.endswith(".")] == []


def test_no_tooltip_of_a_property_is_too_long(properties):
    long = {
        name: each.description
        for name, each in properties.items()
        if len(each.description) > MAX_TOOLTIP or each.description.endswith(".")
    }
    assert long == {}


def test_every_choice_of_a_menu_has_a_tooltip(properties):
    without = {
        f"{name} {item.identifier}": item.description
        for name, each in properties.items()
        if each.type == "ENUM"
        for item in each.enum_items
        if len(item.description) not in CHOICE_TOOLTIP
    }
    assert without == {}
