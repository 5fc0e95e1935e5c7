"""Read settings that an older version stored in a .blend file under other names."""

from typing import Any

import bpy
from bpy.app import handlers

from .blender.compat import stored_properties


@handlers.persistent
def read_former_names(*_: object) -> None:
    """Rename the settings of the opened file to their current names."""
    for scene in bpy.data.scenes:
        if scene.library is not None:
            continue
        stored = scene.mocap_assist
        for item in stored.bl_rna.properties:
            group = getattr(stored, item.identifier)
            if hasattr(group, "former_names"):
                _rename(group)
        _find_checked(stored)


def _rename(group: Any) -> None:
    properties = stored_properties(group)
    for former, present in group.former_names.items():
        if properties is not None and former in properties:
            stored_properties(group)[present] = properties[former]
            del properties[former]


def _find_checked(stored: Any) -> None:
    """Point to the checked action, which older versions stored by its name."""
    properties = stored_properties(stored)
    if properties is not None and isinstance(properties.get("checked"), str):
        stored.checked_action = bpy.data.actions.get(properties["checked"])
        del stored_properties(stored)["checked"]


def register() -> None:
    """Read former names from each file that is opened."""
    handlers.load_post.append(read_former_names)


def unregister() -> None:
    """Stop reading them."""
    handlers.load_post.remove(read_former_names)
