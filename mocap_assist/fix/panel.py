"""Panel: one button that fixes a take, and the card of what it did."""

from collections.abc import Mapping
from typing import Any

import bpy

from ...solvers.workflows import TakeOrigin, figure_texts
from ..blender.mixins import PanelMixin
from ..check.reverting import why_not_revert
from ..languages import translated
from ..panel_parts.fix_card import shown_card
from ..panel_parts.panel_layout import draw_job, draw_sentence, operator_exists, split_column
from ..panel_parts.preference_values import preference_value
from ..panel_parts.visibility import shows_take
from ..track.tracking import selected_preview
from .queue import ICONS, Status, selected_takes, shown_queue
from .scene_fixing import why_not_fix

FIX, ACCEPT, REVERT = (
    f"mocap_assist.{name}" for name in ("fix_take", "accept_fix", "revert_to_raw")
)
FIX_TAKES, FIX_FOLDER, SUBMIT_FOLDER = (
    f"mocap_assist.{name}" for name in ("fix_takes", "fix_folder", "submit_folder")
)
MAX_ROWS = 6
"""Rows of the list of takes; more scroll. Chosen by hand for a default sidebar."""
LAST_STEPS = ("plant_feet", "physics")
DETAILS = "mocap_assist_fix_details"
CONTINUE = "Continue"
UNDO = "To revert, undo: the markers are as they were recorded."


class MOCAP_UL_takes(bpy.types.UIList):
    """Takes that are fixed one after another, and the status of each."""

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
        status = Status[item.status]
        row = layout.split(factor=0.65)
        row.label(text=item.name, icon=ICONS[status], translate=False)
        row.label(text=status.value)


class FixPanel(PanelMixin):
    """The buttons, the card, the list of several takes, and the last steps."""

    bl_label = "Fix"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        shown = shows_take(context) or selected_preview(context) is not None
        return operator_exists(FIX) and shown

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        draw_job(layout, context, "fix")
        reason = why_not_fix(context)
        button = layout.row()
        button.scale_y = 2.0
        button.operator(FIX, icon="SHADERFX")
        several = layout.column(align=True)
        if len(selected_takes(context)) > 1:
            several.operator(FIX_TAKES)
        several.operator(FIX_FOLDER, text="Fix Folder...", icon="FILE_FOLDER")
        if preference_value("flamenco_manager"):
            several.operator(SUBMIT_FOLDER, text="Submit Folder...", icon="NETWORK_DRIVE")
        if reason:
            draw_sentence(layout, context, reason, icon="INFO")
        elif card := shown_card(context):
            _draw_card(layout.box(), context, card)
        _draw_queue(layout, context)
        _draw_last_steps(layout, context)


def _draw_queue(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the takes of the last press of Fix Selected Takes or Fix Folder."""
    queue = shown_queue()
    if not len(queue.takes):
        return
    n_done = sum(each.status == Status.DONE.name for each in queue.takes)
    header, body = layout.panel("mocap_assist_fix_queue", default_closed=False)
    shown = translated(f"{n_done} of {len(queue.takes)} Fixed")
    header.label(text=shown, translate=False)
    if body is None:
        return
    rows = min(len(queue.takes), MAX_ROWS)
    body.template_list("MOCAP_UL_takes", "", queue, "takes", queue, "active_take", rows=rows)
    if context.window_manager.mocap_assist_job.running:
        text, icon = (CONTINUE, "PLAY") if queue.paused else ("Pause", "PAUSE")
        body.prop(queue, "paused", text=text, icon=icon, toggle=True)
    if note := queue.takes[min(queue.active_take, len(queue.takes) - 1)].note:
        draw_sentence(body, context, note)


def _draw_last_steps(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the optional last steps, folded: feet, physics and retargeting."""
    header, body = layout.panel("mocap_assist_fix_last_steps", default_closed=True)
    header.label(text="Last Steps")
    if body is None:
        return
    shown = context.scene.mocap_assist.fix
    column = split_column(body)
    for name in LAST_STEPS:
        column.prop(shown, name)
    column.prop_search(shown, "rig", context.scene, "objects", icon="ARMATURE_DATA")


def _draw_card(
    box: bpy.types.UILayout, context: bpy.types.Context, card: Mapping[str, Any]
) -> None:
    """Draw figures, the most important remark, the buttons, and the steps if unfolded."""
    table = box.column(align=True)
    table.scale_y = 0.9
    rows = figure_texts(card["before"], card["after"])
    for label, before, after in (("", "Before", "After"), *rows):
        names = table.split(factor=0.46)
        names.label(text=translated(label), translate=False)
        values = names.split(factor=0.5)
        values.label(text=translated(before), translate=False)
        values.label(text=translated(after), translate=False)
    if headline := str(card.get("headline", "")):
        draw_sentence(box, context, headline, icon="INFO")
    row = box.row(align=True)
    row.operator(ACCEPT)
    row.prop(context.window_manager, DETAILS, text="Details", toggle=True)
    reason = why_not_revert(context)
    if not reason:
        row.operator(REVERT, text="Revert")
    if getattr(context.window_manager, DETAILS):
        for step in card["steps"]:
            draw_sentence(box, context, str(step))
    if reason:
        is_solved = card.get("origin") == TakeOrigin.MARKERS.value
        draw_sentence(box, context, UNDO if is_solved else reason)
