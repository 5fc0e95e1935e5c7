"""What the tab shows: by default only panels that suit the selection."""

import bpy

from ..runtime.selection import selected_armature, selected_subject

ALL_PANELS = "mocap_assist_all_panels"
"""Property of the window manager: show every panel, whatever is selected."""


def shows_all(context: bpy.types.Context) -> bool:
    """Whether the animator wants every panel."""
    return bool(getattr(context.window_manager, ALL_PANELS))


def shows_take(context: bpy.types.Context) -> bool:
    """Whether panels for armatures and markers are shown."""
    return shows_all(context) or selected_subject(context) is not None


def shows_armature(context: bpy.types.Context) -> bool:
    """Whether panels for armatures are shown."""
    return shows_all(context) or selected_armature(context) is not None
