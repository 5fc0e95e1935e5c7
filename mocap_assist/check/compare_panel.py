"""Panel: compare raw and clean, revert, and export."""

import bpy

from ..actions.delta_layer import delta_strip
from ..blender.mixins import PanelMixin
from ..exporting.menu import EXPORT, draw_export
from ..languages import translated
from ..overlays.comparison.switches import draw_overlay_switches
from ..panel_parts.panel_layout import draw_sentence, operator_exists
from ..runtime.selection import played_result, selected_subject
from ..scene import history
from .key_map import key_text
from .reverting import why_not_revert

REVERT = "mocap_assist.revert_to_raw"
HOLD = "Hold {key} to see the raw take"


class ComparePanel(PanelMixin):
    """The overlay's switch, Revert and Export."""

    bl_label = "Compare"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        _draw_actions(layout, context)
        draw_overlay_switches(layout, context)
        _draw_key(layout, context)
        if operator_exists(REVERT):
            layout.operator(REVERT, icon="LOOP_BACK")
            if reason := why_not_revert(context):
                draw_sentence(layout, context, reason, icon="INFO")
        if operator_exists(EXPORT):
            draw_export(layout, context)


def _draw_key(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Name the key that shows the recorded action, where a result plays."""
    key = key_text()
    if key and played_result(selected_subject(context)):
        text = translated(HOLD).format(key=key)
        layout.label(text=text, icon="HIDE_OFF", translate=False)


def _draw_actions(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    played = played_result(selected_subject(context))
    recorded = played and history.raw_of(played[0])
    if not (played and recorded):
        return
    raw, _ = recorded
    column = layout.column(align=True)
    column.label(text=played[0].name, icon="ACTION", translate=False)
    made_from = translated("Made from {raw}").format(raw=raw.name)
    column.label(text=made_from, icon="BLANK1", translate=False)
    if strip := delta_strip(selected_subject(context)):
        row = layout.row()
        row.use_property_decorate = True  # it can have keys
        row.prop(strip, "influence", text="Delta Influence", slider=True)
