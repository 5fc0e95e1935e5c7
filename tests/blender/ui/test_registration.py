"""What the interface adds to Blender, it takes away again."""

import re
from fnmatch import fnmatchcase
from urllib.parse import unquote, urlparse

import bpy
import pytest

MENUS = ("VIEW3D_MT_pose", "GRAPH_MT_key", "DOPESHEET_MT_key")


def traces():
    """Everything of ours that Blender knows, in a form that can be compared."""
    handlers = [
        f"{name}: {function.__module__}"
        for name in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, name), list)
        for function in functions
        if "mocap_assist" in function.__module__
    ]
    entries = [
        f"{menu}: {function.__module__}"
        for menu in MENUS
        for function in getattr(bpy.types, menu)._dyn_ui_initialize()
        if "mocap_assist" in function.__module__
    ]
    manuals = [prefix for prefix, _ in bpy.utils.manual_map() if "mocap_assist" in prefix]
    classes = [name for name in dir(bpy.types) if name.startswith("MOCAP_")]
    properties = [
        f"{owner.__name__}.{name}"
        for owner in (bpy.types.Scene, bpy.types.WindowManager)
        for name in dir(owner)
        if name.startswith("mocap_assist")
    ]
    return handlers + entries + manuals + classes + properties


def test_disabling_and_enabling_twice_leaves_no_duplicates_or_remains(extension, blank):
    on = traces()
    for _ in range(2):
        extension.unregister()
        assert traces() == []
        extension.register()
        assert traces() == on


def test_every_menu_has_one_entry():
    assert [sum(trace.startswith(f"{menu}:") for trace in traces()) for menu in MENUS] == [
        1
    ] * 3


@pytest.fixture
def preferences(load):
    module = load("mocap_assist.ui.preferences")
    yield module.preferences()
    bpy.ops.mocap_assist.reset_preferences()


def test_panels_move_to_the_tab_in_the_preferences(blank, preferences):
    preferences.tab = "Cleaning"
    assert bpy.types.MOCAP_PT_clean_graph.bl_category == "Cleaning"

    bpy.ops.mocap_assist.reset_preferences()
    assert preferences.tab == "Mocap"
    assert bpy.types.MOCAP_PT_clean_graph.bl_category == "Mocap"


def test_new_scene_takes_the_result_target_from_the_preferences(blank, preferences):
    preferences.result_as = "NLA_TRACK"

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert bpy.context.scene.mocap_assist.clean.result_as == "NLA_TRACK"


def test_added_scene_takes_the_result_target_from_the_preferences(blank, preferences):
    preferences.result_as = "NLA_TRACK"

    bpy.ops.scene.new(type="EMPTY")
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Anything", None))
    bpy.context.view_layer.update()

    assert bpy.context.scene.name == "Scene.001"
    assert bpy.context.scene.mocap_assist.clean.result_as == "NLA_TRACK"


def test_open_scene_takes_the_result_target_when_the_extension_is_enabled(
    blank, extension, load, request
):
    extension.unregister()
    module = load("mocap_assist.ui.preferences")
    give = module._give_default
    assert not bpy.app.timers.is_registered(give)
    extension.register()
    request.addfinalizer(bpy.ops.mocap_assist.reset_preferences)
    module.preferences().result_as = "NLA_TRACK"

    assert bpy.app.timers.is_registered(give)  # timers run only where there is a window
    give()

    assert bpy.context.scene.mocap_assist.clean.result_as == "NLA_TRACK"


def test_scene_keeps_its_own_result_target(blank, preferences, load):
    preferences.result_as = "NLA_TRACK"
    bpy.context.scene.mocap_assist.clean.result_as = "ACTION"

    load("mocap_assist.ui.preferences")._give_default()

    assert bpy.context.scene.mocap_assist.clean.result_as == "ACTION"


def test_extension_works_without_preferences(blank, extension, draw, load):
    module, addons = load("mocap_assist.ui.preferences"), bpy.context.preferences.addons
    addons.remove(addons[module.EXTENSION])
    try:
        extension.unregister()
        extension.register()

        assert bpy.types.MOCAP_PT_clean.bl_category == "Mocap"
        assert "mocap_assist_overlay" in draw("MOCAP_PT_compare")
        assert tuple(module.preference_value("raw_color")) == (1.0, 0.45, 0.1, 0.8)
        assert not bpy.ops.mocap_assist.reset_preferences.poll()
    finally:
        addons.new().module = module.EXTENSION


def test_preferences_show_each_setting_and_a_reset_button(draw, load):
    kind = load("mocap_assist.ui.preferences").MOCAP_AP_preferences

    shown = [each for each in draw(kind) if each in kind.__annotations__]
    assert shown == list(kind.__annotations__)
    assert "mocap_assist.reset_preferences" in draw(kind)


def test_every_button_has_a_chapter_in_the_manual(load):
    manual = load("mocap_assist.ui.manual")
    address, chapters = manual.manual_map()
    page = manual.MANUAL.read_text(encoding="utf-8")
    buttons = [f"bpy.ops.mocap_assist.{name}" for name in dir(bpy.ops.mocap_assist)]

    assert unquote(urlparse(address).path).endswith("manual.html")
    assert set(re.findall(r'id="(\w+)"', page)) >= {anchor[1:] for _, anchor in chapters}
    for button in buttons:
        assert any(fnmatchcase(button, what) for what, _ in chapters), button


def test_tooltips_have_no_period():
    for name in dir(bpy.ops.mocap_assist):
        kind = getattr(bpy.ops.mocap_assist, name).get_rna_type()
        for described in (kind, *kind.properties):
            assert not described.description.endswith("."), described
        assert kind.description[:1].isupper(), name


def test_manual_button_opens_the_pages_of_the_zip(load):
    page = load("mocap_assist.panel_parts.manual_page").start_page()

    assert page.name == "README.html"
    assert "Fix My Take" in page.read_text(encoding="utf-8")
    assert (page.parent / "search.js").is_file()
