"""Blender's properties say what the settings say, and give back what was set."""

import math
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, get_type_hints

import bpy
import pytest


@pytest.fixture
def flavors(load):
    """An enum of a setting; the shown name of one member is not its value."""

    class Taste(load("solvers.settings").Choice):
        SWEET = "sweet and sour", "Add sugar and vinegar"
        BITTER = "bitter", "Add coffee", "Like Coffee"

    return Taste


@pytest.fixture
def dish(load, flavors):
    """A property group made from settings of every kind."""
    settings = load("solvers.settings")

    @dataclass(frozen=True, kw_only=True)
    class Recipe(settings.Settings):
        salt: float = settings.setting(
            0.1, "More is saltier", unit="g", minimum=0.0, maximum=9.0
        )
        angle: float = settings.setting(0.3, "Wider", unit="rad", minimum=0.0, maximum=math.pi)
        fraction: float = settings.setting(0.25, "Fraction", minimum=0.0, maximum=1.0)
        wait: float = settings.setting(1.0, "Longer", unit="s", minimum=0.0)
        eggs: int = settings.setting(3, "Eggs", minimum=1, maximum=12)
        hot: bool = settings.setting(True, "Heat it")
        taste: Any = settings.setting(flavors.BITTER, "Taste")
        name: str = settings.setting("soup", "Name")

    class Menu(NamedTuple):
        recipe: Recipe

    class DISH_PG_test(bpy.types.PropertyGroup):
        pass

    load("mocap_assist.blender.settings_properties").settings_from(Menu)(DISH_PG_test)
    bpy.utils.register_class(DISH_PG_test)
    bpy.types.WindowManager.dish = bpy.props.PointerProperty(type=DISH_PG_test)
    group = bpy.context.window_manager.dish
    for name in DISH_PG_test.setting_names:
        group.property_unset(name)
    yield group, Recipe
    del bpy.types.WindowManager.dish
    bpy.utils.unregister_class(DISH_PG_test)


def test_defaults_are_restored_exactly(dish):
    group, recipe = dish
    assert group.settings().recipe == recipe()


def test_values_are_restored_as_set(dish, flavors):
    group, recipe = dish
    group.salt, group.angle, group.eggs, group.hot = 0.7, math.pi, 12, False
    group.taste, group.name = "SWEET", "stew"

    expected = {"salt": 0.7, "angle": math.pi, "eggs": 12, "hot": False}
    assert group.settings().recipe == recipe(taste=flavors.SWEET, name="stew", **expected)


def test_value_out_of_range_is_clamped(dish):
    group, _ = dish
    group.salt, group.angle, group.eggs = 100.0, 7.0, 0

    held = group.settings().recipe
    assert (held.salt, held.angle, held.eggs) == (9.0, math.pi, 1)


@pytest.fixture
def store():
    """Keep a value as a file of another version may, past all limits."""

    def store(group, name, value):
        properties = getattr(group, "bl_system_properties_get", lambda: group)()
        properties[name] = value

    return store


def test_stored_value_out_of_range_is_clamped(dish, store, flavors):
    group, _ = dish
    store(group, "eggs", -5)
    store(group, "salt", -math.inf)
    store(group, "fraction", math.nan)
    store(group, "wait", math.inf)
    store(group, "taste", 77)

    held = group.settings().recipe
    assert (held.salt, held.fraction, held.eggs) == (0.0, 0.25, 1)
    assert (held.wait, held.taste) == (math.inf, flavors.BITTER)

    store(group, "eggs", 10**8)
    assert group.settings().recipe.eggs == 12


def test_units_that_blender_has_are_shown(dish):
    shown = dish[0].bl_rna.properties
    subtypes = [shown[name].subtype for name in ("salt", "angle", "fraction", "wait")]

    assert subtypes == ["NONE", "ANGLE", "FACTOR", "TIME_ABSOLUTE"]
    assert shown["salt"].description == "More is saltier (g)"


def test_choices_have_label_and_help(dish):
    shown = dish[0].bl_rna.properties["taste"].enum_items

    assert [(each.identifier, each.name, each.description) for each in shown] == [
        ("SWEET", "Sweet and Sour", "Add sugar and vinegar"),
        ("BITTER", "Like Coffee", "Add coffee"),
    ]


def test_every_button_offers_every_setting_with_a_tooltip(load):
    bundles = {
        "denoise": load("mocap_assist.clean.button_settings").CleanBundle,
        "measure_quality": load("mocap_assist.check.button_settings").CheckBundle,
        "plant_feet": load("mocap_assist.clean.scene_planting").FeetBundle,
        "learn_patterns": load("mocap_assist.clean.scene_learning").LearnBundle,
        "simulate": load("mocap_assist.physics.scene_simulating").SimulateBundle,
    }
    for button, bundle in bundles.items():
        shown = getattr(bpy.ops.mocap_assist, button).get_rna_type().properties
        for settings in get_type_hints(bundle).values():
            for item in fields(settings):
                tooltip = shown[item.name].description
                assert tooltip.startswith(item.metadata["described"].help), item.name
                assert not tooltip.endswith("."), item.name


def test_every_path_can_be_relative_to_the_file(extension):
    """Otherwise Blender warns when one is set, at a moment of its own choosing."""
    owners = [
        each.bl_rna
        for each in bpy.types.PropertyGroup.__subclasses__()
        if each.__module__.startswith(extension.__name__) and each.is_registered
    ]
    buttons = bpy.ops.mocap_assist
    owners += [getattr(buttons, name).get_rna_type() for name in dir(buttons)]
    paths = [
        (owner.identifier, each)
        for owner in owners
        for each in owner.properties
        if each.type == "STRING" and each.subtype in {"FILE_PATH", "DIR_PATH"}
    ]

    assert len(paths) > 10
    for name, each in paths:
        assert each.is_path_supports_blend_relative, f"{name}.{each.identifier}"
