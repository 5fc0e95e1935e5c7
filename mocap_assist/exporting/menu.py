"""Export in the File menu and in the sidebar."""

import bpy

from ..panel_parts.panel_layout import draw_job, operator_exists

EXPORT = "mocap_assist.export_take"
ENTRY = "Motion Capture Take (.fbx, .glb, .bvh)"


def draw_export(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the format and the button."""
    running = draw_job(layout, context, "export")
    column = layout.column(align=True)
    column.enabled = not running
    row = column.row(align=True)
    row.prop(context.scene.mocap_assist.export, "file_format", expand=True)
    column.operator(EXPORT, icon="EXPORT")


def _draw_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if operator_exists(EXPORT):
        self.layout.operator_context = "INVOKE_REGION_WIN"
        self.layout.operator(EXPORT, text=ENTRY)


def register() -> None:
    """Append the entry."""
    bpy.types.TOPBAR_MT_file_export.append(_draw_entry)


def unregister() -> None:
    """Remove the entry."""
    bpy.types.TOPBAR_MT_file_export.remove(_draw_entry)
