"""Import in the File menu, and by dropping files into the 3D view."""

import bpy
from bpy_extras.io_utils import poll_file_object_drop

from ..panel_parts.panel_layout import operator_exists
from .importing import EXTENSIONS

IMPORT = "mocap_assist.import_recording"
ENTRY = "Motion Capture (.bvh, .amc, .c3d, .trc, depth camera joints)"
LIVE = "mocap_assist.choose_live"
LIVE_ENTRY = "Depth Camera While It Records (folder, .mkv)"


class MOCAP_FH_recording(bpy.types.FileHandler):
    """Files dropped into the 3D View or the Outliner."""

    bl_idname = "MOCAP_FH_recording"
    bl_label = "Motion Capture (Mocap Assist)"
    bl_import_operator = IMPORT
    bl_file_extensions = ";".join(EXTENSIONS)

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        return operator_exists(IMPORT) and poll_file_object_drop(context)


def _draw_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if operator_exists(IMPORT):
        self.layout.operator(IMPORT, text=ENTRY)
    if operator_exists(LIVE):
        self.layout.operator(LIVE, text=LIVE_ENTRY)


def register() -> None:
    """Append the entry and take dropped files."""
    bpy.utils.register_class(MOCAP_FH_recording)
    bpy.types.TOPBAR_MT_file_import.append(_draw_entry)


def unregister() -> None:
    """Remove both."""
    bpy.types.TOPBAR_MT_file_import.remove(_draw_entry)
    bpy.utils.unregister_class(MOCAP_FH_recording)
