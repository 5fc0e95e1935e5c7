"""Keys of the extension, in the add-on key map: the animator can edit them."""

from collections.abc import Iterator
from typing import NamedTuple

import bpy

SHOW_RAW = "mocap_assist.show_raw"
KEY = "Y"
"""Key that neither of Blender's key maps uses in Pose Mode and in Object Mode."""
SET_RANGE = "mocap_assist.set_range"
DRAG = "LEFTMOUSE"
"""The operator passes on every press that is not on the strip."""
MODE_COLUMN = 0.16
"""Width of the names of the modes in the preferences, as a fraction."""


class _Entry(NamedTuple):
    operator: str
    key: str
    mode: str
    """Name of Blender's key map."""
    editor: str = "EMPTY"


ENTRIES = (
    _Entry(SHOW_RAW, KEY, "Pose"),
    _Entry(SHOW_RAW, KEY, "Object Mode"),
    _Entry(SET_RANGE, DRAG, "Dopesheet", "DOPESHEET_EDITOR"),
    _Entry(SET_RANGE, DRAG, "Graph Editor", "GRAPH_EDITOR"),
)
_items: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def animators_items() -> Iterator[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]]:
    """Yield the items as the animator edited them, if there is a key map, as in a window."""
    keyconfig = bpy.context.window_manager.keyconfigs.user
    for entry in ENTRIES:
        keymap = keyconfig and keyconfig.keymaps.get(entry.mode)
        for item in keymap.keymap_items if keymap else ():
            if item.idname == entry.operator:
                yield keymap, item


def key_text() -> str:
    """Return the key of the recorded take as Blender writes it; nothing if it is off."""
    shown = (item for _, item in animators_items() if item.idname == SHOW_RAW and item.active)
    return next((item.to_string() for item in shown), "")


def draw_keys(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the items with their keys, for the preferences."""
    import rna_keymap_ui

    keyconfig = context.window_manager.keyconfigs.user
    for keymap, item in animators_items():
        split = layout.split(factor=MODE_COLUMN)
        split.label(text=keymap.name)
        column = split.column()
        column.context_pointer_set("keymap", keymap)
        rna_keymap_ui.draw_kmi([], keyconfig, keymap, item, column, 0)


def register() -> None:
    """Add the items; without a window Blender may have no key maps."""
    keyconfig = bpy.context.window_manager.keyconfigs.addon
    for operator, key, mode, editor in ENTRIES if keyconfig else ():
        keymap = keyconfig.keymaps.new(name=mode, space_type=editor)
        _items.append((keymap, keymap.keymap_items.new(operator, key, "PRESS")))


def unregister() -> None:
    """Remove the items."""
    while _items:
        keymap, item = _items.pop()
        keymap.keymap_items.remove(item)
