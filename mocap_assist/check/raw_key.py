"""The key that shows the recorded action while it is held, in the add-on key map."""

from collections.abc import Iterator

import bpy

SHOW_RAW = "mocap_assist.show_raw"
KEY = "Y"
"""Key that neither of Blender's key maps uses in Pose Mode and in Object Mode."""
MODES = ("Pose", "Object Mode")
MODE_COLUMN = 0.16
"""Width of the names of the modes in the preferences, as a fraction."""
_items: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def animators_items() -> Iterator[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]]:
    """Yield the items as the animator edited them, if there is a key map, as in a window."""
    keyconfig = bpy.context.window_manager.keyconfigs.user
    for mode in MODES:
        keymap = keyconfig and keyconfig.keymaps.get(mode)
        for item in keymap.keymap_items if keymap else ():
            if item.idname == SHOW_RAW:
                yield keymap, item


def key_text() -> str:
    """Return the key as Blender writes it; nothing where it was removed or switched off."""
    return next((item.to_string() for _, item in animators_items() if item.active), "")


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
    for mode in MODES if keyconfig else ():
        keymap = keyconfig.keymaps.new(name=mode)
        _items.append((keymap, keymap.keymap_items.new(SHOW_RAW, KEY, "PRESS")))


def unregister() -> None:
    """Remove the items."""
    while _items:
        keymap, item = _items.pop()
        keymap.keymap_items.remove(item)
