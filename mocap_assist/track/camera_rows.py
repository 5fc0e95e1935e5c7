"""Rows of the panel Track: the cameras that it joins, and how it aligns them."""

import bpy

from ..panel_parts.panel_layout import draw_sentence, split_column
from .other_cameras import other_previews
from .tracking import selected_preview

ALIGNMENT = ("max_offset", "min_overlap")


def draw_cameras(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the number and names of the selected cameras, and the settings of the alignment."""
    preview = selected_preview(context)
    if preview is None:
        return
    cameras = [preview, *other_previews(preview)]
    if len(cameras) > 1:
        column = layout.column(align=True)
        draw_sentence(column, context, f"{len(cameras)} cameras")
        for number, each in enumerate(cameras, start=1):
            text = f"{number}: {each.name}"
            column.label(text=text, translate=False, icon="OUTLINER_OB_POINTCLOUD")
    column = split_column(layout)
    for name in ALIGNMENT:
        column.prop(context.scene.mocap_assist.track, name)
