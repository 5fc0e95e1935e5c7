"""Entries of Blender's menus."""

import bpy

from ..panel_parts.panel_layout import operator_exists

BUTTONS = (
    "mocap_assist.import_recording",
    "mocap_assist.load_sample",
    "mocap_assist.fix_take",
    "mocap_assist.fix_takes",
    "mocap_assist.fix_folder",
    "mocap_assist.submit_folder",
    "mocap_assist.accept_fix",
    "mocap_assist.track_depth",
    "mocap_assist.choose_live",
    "mocap_assist.track_live",
    "mocap_assist.retrack",
    "mocap_assist.reconstruct",
    "mocap_assist.solve_skeleton",
    "mocap_assist.denoise",
    "mocap_assist.measure_quality",
    "mocap_assist.mark_issues",
    "mocap_assist.plant_feet",
    "mocap_assist.simulate",
    "mocap_assist.retarget",
    "mocap_assist.reduce_keys",
    "mocap_assist.revert_to_raw",
    "mocap_assist.show_raw",
    "mocap_assist.export_take",
    "mocap_assist.index_library",
    "mocap_assist.find_similar",
    "mocap_assist.vary",
    "mocap_assist.listen",
    "mocap_assist.copy_diagnostics",
    "mocap_assist.record_live",
    "mocap_assist.add_workspace",
)
MENUS = (
    "VIEW3D_MT_object",
    "VIEW3D_MT_pose",
    "VIEW3D_MT_pose_context_menu",
    "GRAPH_MT_key",
    "GRAPH_MT_context_menu",
    "DOPESHEET_MT_key",
    "DOPESHEET_MT_context_menu",
)


class MOCAP_MT_clean(bpy.types.Menu):
    """All buttons; they take the sidebar's settings."""

    bl_label = "Mocap Assist"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for idname in filter(operator_exists, BUTTONS):
            layout.operator(idname)


def _draw_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu("MOCAP_MT_clean")


def register() -> None:
    """Append the entries."""
    bpy.utils.register_class(MOCAP_MT_clean)
    for menu in MENUS:
        getattr(bpy.types, menu).append(_draw_entry)


def unregister() -> None:
    """Remove the entries."""
    for menu in MENUS:
        getattr(bpy.types, menu).remove(_draw_entry)
    bpy.utils.unregister_class(MOCAP_MT_clean)
