"""Panel: quality figures of the action, and the list of issues."""

from typing import Any

import bpy

from ..blender.mixins import PanelMixin
from ..languages import translated
from ..overlays.strip.switch import draw_strip_switch
from ..panel_parts.figure_rows import figure_rows, frame_text, frames_text
from ..panel_parts.fix_card import shown_card
from ..panel_parts.panel_layout import draw_job, draw_sentence, is_wide, operator_exists
from ..panel_parts.visibility import shows_take
from ..runtime.selection import played_result, selected_subject, shown_frames
from ..scene import history
from .issue_markers import has_issue_markers
from .issue_views import draw_view_switches
from .renewing import is_awaited
from .scene_checking import is_stale, why_not_visible

CHECK, JUMP = "mocap_assist.measure_quality", "mocap_assist.jump_to_issue"
MARK = "mocap_assist.mark_issues"
ICONS = {
    "spike": "IPO_ELASTIC",
    "jump": "IPO_CONSTANT",
    "gap": "REMOVE",
    "jitter": "RNDCURVE",
    "foot slide": "FORWARD",
    "limit": "CON_ROTLIMIT",
}
KINDS = {
    "spike": "Spike",
    "jump": "Jump",
    "gap": "Gap",
    "jitter": "Jitter",
    "foot slide": "Foot Slide",
    "limit": "Joint Limit",
    "cut": "Cut",
    "low confidence": "Low Confidence",
}
KIND_COLUMN, BONE_COLUMN = 0.33, 0.65  # of the list's width, and of the rest of it
AWAITED = "These issues are from before this result, which is being checked."
STALE = 'Results are for "{action}". Run Check again.'
MIN_ROWS, MAX_ROWS = 4, 8


class MOCAP_UL_issues(bpy.types.UIList):
    """Worst issues; a click jumps to the issue."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: object,
        item: Any,
        icon: int,
        active_data: object,
        active_property: str,
        index: int,
    ) -> None:
        wide = is_wide(context)
        row = layout.split(factor=KIND_COLUMN)
        icon_name = ICONS.get(item.kind, "ERROR") if wide else "NONE"
        _jump(row, index, translated(KINDS.get(item.kind, item.kind)), icon_name)
        row = row.split(factor=BONE_COLUMN)
        _jump(row, index, item.name.rpartition(":")[2], "NONE")  # without its namespace
        first, last = shown_frames(context, item)
        _jump(row, index, frames_text(first, last) if wide else frame_text(first), "NONE")


class CheckPanel(PanelMixin):
    """Figures before and after, and the worst issues."""

    bl_label = "Check"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(CHECK) and shows_take(context)

    def draw(self, context: bpy.types.Context) -> None:
        layout, shown = self.layout, context.scene.mocap_assist
        draw_job(layout, context, "check")
        row = layout.row()
        row.scale_y = 1.3
        row.operator(CHECK, icon="VIEWZOOM")
        _draw_figures(layout, context)
        if shown.issues:
            _draw_issues(layout, context)
        elif shown.checked_action and not is_stale(
            shown.checked_action, selected_subject(context)
        ):
            draw_sentence(layout, context, "No issues found.", icon="CHECKMARK")
        _draw_markers(layout, context.scene)
        draw_strip_switch(layout, context)
        _draw_thresholds(layout, shown.check)


def _draw_figures(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    if shown_card(context):  # which compares the same takes
        return
    result = played_result(selected_subject(context))
    rows = figure_rows(history.history(result[0])) if result else []
    if not rows:
        return
    table = layout.box().column(align=True)
    table.scale_y = 0.9
    for label, before, after in (("", "Before", "After"), *rows):
        names = table.split(factor=0.52)
        names.label(text=translated(label), translate=False)
        values = names.split(factor=0.5)
        values.label(text=translated(before), translate=False)
        values.label(text=translated(after), translate=False)


def _draw_issues(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    shown = context.scene.mocap_assist
    rows = min(max(len(shown.issues), MIN_ROWS), MAX_ROWS)
    layout.template_list(
        "MOCAP_UL_issues", "", shown, "issues", shown, "active_issue", rows=rows, maxrows=rows
    )
    row = layout.row(align=True)
    row.operator(JUMP, text="Previous", icon="TRIA_LEFT").step = -1
    row.operator(JUMP, text="Next", icon="TRIA_RIGHT").step = 1
    draw_view_switches(row, context)
    if 0 <= shown.active_issue < len(shown.issues):
        issue = shown.issues[shown.active_issue]
        draw_sentence(layout, context, issue.sentence)
        if reason := why_not_visible(context, issue):
            draw_sentence(layout, context, reason, icon="HIDE_ON")
    subject = selected_subject(context)
    if subject is not None and is_stale(shown.checked_action, subject):
        text = AWAITED if is_awaited(context) else _stale_text(shown.checked_action)
        draw_sentence(layout, context, text, icon="INFO")


def _stale_text(checked: bpy.types.Action | None) -> str:
    """Return a sentence about issues that are not of the played action."""
    if checked is None:
        return "Results are for another action. Run Check again."
    return translated(STALE).format(action=checked.name)


def _draw_markers(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    """Draw buttons that mark the issues and remove existing markers."""
    if not has_issue_markers(scene):
        if scene.mocap_assist.issues:
            layout.operator(MARK, icon="MARKER_HLT")
        return
    row = layout.row(align=True)
    if scene.mocap_assist.issues:
        row.operator(MARK, text="Update Markers", icon="MARKER_HLT")
    row.operator(MARK, text="Remove Markers", icon="X").remove = True


def _draw_thresholds(layout: bpy.types.UILayout, check: bpy.types.PropertyGroup) -> None:
    header, body = layout.panel("mocap_assist_check_thresholds", default_closed=True)
    header.label(text="Thresholds")
    if body is None:
        return
    column = body.column(align=True)
    column.use_property_split = False  # names of a default sidebar have more room in the fields
    for name in type(check).setting_names:
        column.prop(check, name)


def _jump(layout: bpy.types.UILayout, index: int, text: str, icon: str) -> None:
    row = layout.row()
    row.alignment = "LEFT"
    row.operator(JUMP, text=text, icon=icon, emboss=False, translate=False).index = index
