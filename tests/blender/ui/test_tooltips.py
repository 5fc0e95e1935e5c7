"""Tooltips of buttons, properties and choices are there, each one short sentence."""

import re

import bpy
import pytest

MIN_CHOICE_TOOLTIP = 10
MAX_TOOLTIP = 90
BLENDERS_OWN = {"rna_type", "bl_idname", "name"}
TWO_SENTENCES = re.compile(r"[.!?] [A-Z]")


def is_wrong(text):
    return len(text) > MAX_TOOLTIP or text.endswith(".") or TWO_SENTENCES.search(text)


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
        if each.identifier not in BLENDERS_OWN
    }
    found |= {
        f"WindowManager.{each.identifier}": each
        for each in bpy.types.WindowManager.bl_rna.properties
        if each.identifier.startswith("mocap_assist")
    }
    assert len(found) > 150
    return found


def test_every_button_has_a_tooltip_of_one_short_sentence():
    tooltips = {each.identifier: each.description for each in buttons()}

    assert {name: text for name, text in tooltips.items() if not text or is_wrong(text)} == {}


def test_every_tooltip_of_a_property_is_one_short_sentence(properties):
    wrong = {
        name: each.description
        for name, each in properties.items()
        if is_wrong(each.description)
    }
    assert wrong == {}


def test_every_choice_of_a_menu_has_a_tooltip(properties):
    wrong = {
        f"{name} {item.identifier}": item.description
        for name, each in properties.items()
        if each.type == "ENUM"
        for item in each.enum_items
        if len(item.description) < MIN_CHOICE_TOOLTIP or is_wrong(item.description)
    }
    assert wrong == {}
