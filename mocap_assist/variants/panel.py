"""Panel: make many new actions from a few, and use them."""

from typing import Any, ClassVar

import bpy

from ...solvers.denoising import PlantSettings
from ...solvers.variation import VarySettings
from ..blender.mixins import PanelMixin
from ..find_similar import searches
from ..languages import translated
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    operator_exists,
    settings_column,
)
from ..panel_parts.presets import draw_presets
from ..panel_parts.visibility import shows_armature
from ..retarget.action_ticks import draw_ticks
from ..runtime.selection import selected_armature
from .listing import chosen_variants
from .reading import candidate_actions, why_not_vary
from .tags import short_name

VARY, KEEP, SHEET, STACK, MARK, ASSIGN = (
    f"mocap_assist.{name}"
    for name in (
        "vary", "keep_variants", "draw_variants", "stack_variants", "mark_variants",
        "assign_variants",
    )
)  # fmt: skip
USE_OPERATOR = "mocap_assist.use_matches"
MAIN = ("amount", "timing", "length")
PARTS = ("trunk", "left_arm", "right_arm", "left_leg", "right_leg")
OTHERS = ("seed", "pin_start", "pin_end")
SEPARATE_SETTINGS = {*MAIN, *OTHERS, *PARTS}
CROWD = ("delay", "spread", "turn", "crowd_seed")
HINT = "Tick similar actions, or none to vary the current one."
MIN_ROWS, MAX_ROWS = 3, 7  # rows of the list
ROW, LARGE = 1.8, 7.0  # sizes of the pictures


class MOCAP_UL_variants(bpy.types.UIList):
    """Variants, each with a picture and a tick."""

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
        row = layout.row()
        if item.action is None:
            row.label(text="Deleted", icon="ORPHAN_DATA")
            return
        row.template_icon(picture_of(item.action), scale=ROW)
        row.label(text=short_name(item.action), translate=False)
        star = "SOLO_ON" if item.picked else "SOLO_OFF"
        row.prop(item, "picked", text="", icon=star, emboss=False)


class VaryPanel(PanelMixin):
    """Examples, settings, the button Vary, and the list of variants."""

    bl_label = "Vary"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        has_variants = bool(context.scene.mocap_assist.variants.rows)
        return operator_exists(VARY) and (has_variants or shows_armature(context))

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        draw_presets(self.layout, "vary")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = settings_column(layout, context, "vary", "use")
        _draw_actions(column, context)
        _draw_settings(column, context.scene.mocap_assist.vary)
        button = column.row()
        button.scale_y = 1.6
        button.operator(VARY, icon="MOD_ARRAY")
        if reason := why_not_vary(context):
            draw_sentence(column, context, reason, icon="INFO")
        if context.scene.mocap_assist.variants.rows:
            _draw_variants(column, context)


def picture_of(action: bpy.types.Action) -> int:
    """Return the number of the icon with the picture of an action."""
    return int(action.preview.icon_id) if action.preview is not None else 0


def _draw_actions(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    armature = selected_armature(context)
    found = [] if armature is None else candidate_actions(armature)
    if len(found) > 1:
        draw_sentence(column, context, HINT)
    draw_ticks(column, context, found, "vary")
    if search := searches.listed_search(context):
        text = translated(f"Best Matches of {search.query}")
        column.operator(USE_OPERATOR, text=text, translate=False, icon="VIEWZOOM")


def _draw_settings(column: bpy.types.UILayout, vary: bpy.types.PropertyGroup) -> None:
    column.prop(vary, "n_variants", text="Variants")
    for name in MAIN:
        column.prop(vary, name, slider=name != "length")
    column.prop(vary, "plant_feet")
    header, body = column.panel("mocap_assist_vary_parts", default_closed=True)
    header.label(text="Body Parts")
    for name in PARTS if body else ():
        body.prop(vary, name, slider=True)
    _draw_folded(column, vary)


def _draw_folded(column: bpy.types.UILayout, vary: bpy.types.PropertyGroup) -> None:
    header, body = column.panel("mocap_assist_vary_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is None:
        return
    for name in OTHERS:
        body.prop(vary, name)
    for name in folded_settings(VarySettings, SEPARATE_SETTINGS, vary):
        body.prop(vary, name)
    feet = body.column()
    feet.active = vary.plant_feet
    for name in folded_settings(PlantSettings, (), vary):
        feet.prop(vary, name)


def _draw_variants(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    variants = context.scene.mocap_assist.variants
    rows = min(max(len(variants.rows), MIN_ROWS), MAX_ROWS)
    column.template_list(
        "MOCAP_UL_variants", "", variants, "rows", variants, "active", rows=rows, maxrows=rows
    )
    if 0 <= variants.active < len(variants.rows):
        action = variants.rows[variants.active].action
        if action is not None:
            column.template_icon(picture_of(action), scale=LARGE)
    picked = any(row.picked for row in variants.rows)
    n_chosen = len(chosen_variants(context.scene))
    draw_sentence(
        column,
        context,
        f"Apply to {n_chosen} picked:" if picked else f"Apply to all {n_chosen}:",
    )
    column.operator(KEEP, icon="SOLO_ON")
    row = column.row(align=True)
    row.operator(STACK, icon="NLA")
    row.operator(SHEET, icon="IMAGE_DATA")
    column.operator(MARK, text="Mark as Assets", icon="ASSET_MANAGER")
    header, body = column.panel("mocap_assist_vary_crowd", default_closed=True)
    header.label(text="Crowd")
    if body is not None:
        for name in CROWD:
            body.prop(context.scene.mocap_assist.crowd, name)
        body.operator(ASSIGN, icon="COMMUNITY")


register, unregister = bpy.utils.register_classes_factory((MOCAP_UL_variants,))
