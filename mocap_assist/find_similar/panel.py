"""Panel: a library of clips, the matches of a search, and what to do with them."""

from typing import Any, ClassVar

import bpy

from ...solvers.retrieval import FindSettings
from ..blender.mixins import PanelMixin
from ..languages import translated
from ..library.auto_update_list import choices_are_kept
from ..library.source_list import draw_sources
from ..overlays.color_icons import square_icon
from ..panel_parts.figure_rows import frames_text
from ..panel_parts.panel_layout import (
    draw_sentence,
    folded_settings,
    is_wide,
    operator_exists,
    settings_column,
    split_column,
)
from ..panel_parts.visibility import shows_take
from ..runtime.selection import Bones
from . import searches
from .ghost_drawing import COLOR
from .match_grid import draw_match_grid
from .previews import icon_of
from .scene_finding import why_not_find

KEEP = "mocap_assist.keep_current"
INDEX, FIND = "mocap_assist.index_library", "mocap_assist.find_similar"
LOAD, LINK = "mocap_assist.load_match", "mocap_assist.link_match"
LEARN, MARK = "mocap_assist.learn_from_matches", "mocap_assist.mark_asset"
USE_OPERATOR, BROWSE = "mocap_assist.use_matches", "mocap_assist.browse_matches"
PARTS = (("trunk",), ("left_arm", "right_arm"), ("left_leg", "right_leg"))
SEPARATE_SETTINGS = {"n_matches", "n_aligned", *(name for row in PARTS for name in row)}
MIN_ROWS, MAX_ROWS = 3, 6
ROW, LARGE = 1.6, 7.0  # sizes of the pictures


class MOCAP_UL_matches(bpy.types.UIList):
    """Clips that are similar to the query, best first."""

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
        search = searches.listed_search(context)
        row = layout.row()
        if search is not None and index < len(search.finding.found):
            row.template_icon(icon_of(search, index), scale=ROW)
        texts = row.split(factor=0.5 if is_wide(context) else 0.75)
        texts.label(text=item.name, translate=False)
        if is_wide(context):
            texts = texts.split(factor=0.4)
        is_ranked = search is None or search.is_ranked
        texts.label(text=f"{item.score:.0%}" if is_ranked else "", translate=False)
        if is_wide(context):
            texts.label(text=frames_text(item.start, item.stop), translate=False)


class LibraryPanel(PanelMixin):
    """The library, the search, and its matches."""

    bl_label = "Library"
    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_listing = bool(context.window_manager.mocap_assist_matches.rows)
        return operator_exists(FIND) and (is_listing or shows_take(context))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        _draw_library(layout, context)
        column = settings_column(layout, context, "find", "load", "use")
        _draw_query(column, context)
        listed = context.window_manager.mocap_assist_matches
        if listed.rows:
            _draw_matches(column, context)


def _draw_library(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    library = context.scene.mocap_assist.library
    state = context.window_manager.mocap_assist_indexing
    header, body = layout.panel("mocap_assist_library_sources", default_closed=False)
    header.label(text="Sources")
    if body is not None:
        body.use_property_decorate = False
        draw_sources(body, library)
        _draw_source_settings(body, library)
        buttons = body.column(align=True)
        buttons.operator(INDEX, icon="FILE_REFRESH")
        kept = choices_are_kept(library.settings().choices)
        buttons.operator(KEEP, icon="RECOVER_LAST", depress=kept)
    if state.running:
        text = f"{translated(state.message)} {state.fraction:.0%}"
        layout.progress(factor=state.fraction, type="BAR", text=text, translate=False)
    elif state.report:
        draw_sentence(layout, context, state.report)


def _draw_source_settings(layout: bpy.types.UILayout, library: bpy.types.PropertyGroup) -> None:
    """Draw what few need, folded."""
    header, body = layout.panel("mocap_assist_library_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is not None:
        column = split_column(body)
        for name in ("tags", "rig_file", "library_file"):
            column.prop(library, name)


def _draw_query(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    find = context.scene.mocap_assist.find
    column.prop(find, "frame_range")
    column.row().prop(find, "bones", text="Compare", expand=True)
    if find.bones == Bones.ALL.name:
        parts = column.column(align=True)
        parts.use_property_split = False
        for names in PARTS:
            row = parts.row(align=True)
            for name in names:
                row.prop(find, name, toggle=True)
    header, body = column.panel("mocap_assist_find_advanced", default_closed=True)
    header.label(text="Advanced")
    if body is not None:
        for name in ("n_matches", *folded_settings(FindSettings, SEPARATE_SETTINGS, find)):
            body.prop(find, name)
    button = column.row()
    button.scale_y = 1.6
    button.operator(FIND, icon="VIEWZOOM")
    if reason := why_not_find(context):
        draw_sentence(column, context, reason, icon="INFO")


def _draw_matches(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    listed = context.window_manager.mocap_assist_matches
    search = searches.listed_search(context)
    if search is None:
        draw_sentence(column, context, "Outdated. Press Find Similar again.", icon="INFO")
        return
    if search.is_ranked:
        draw_sentence(column, context, f'Similar to "{listed.query}"')
    else:
        draw_sentence(column, context, "Clips of the library")
    column.operator(BROWSE, icon="PLAY")
    n_good = draw_match_grid(column, context, search)
    header, body = column.panel("mocap_assist_all_matches", default_closed=True)
    header.label(text="All Matches")
    if body is not None:
        rows = min(max(len(listed.rows), MIN_ROWS), MAX_ROWS)
        body.template_list(
            "MOCAP_UL_matches", "", listed, "rows", listed, "active", rows=rows, maxrows=rows
        )
    is_visible = listed.active < n_good or body is not None
    if is_visible and 0 <= listed.active < len(search.finding.found):
        _draw_chosen(column, context, search, listed.active)


def _draw_chosen(
    column: bpy.types.UILayout, context: bpy.types.Context, search: searches.Search, index: int
) -> None:
    found = search.finding.found[index]
    column.template_icon(icon_of(search, index), scale=LARGE)
    entry, frames = found.entry, found.match.frames
    tags = f" Tags: {', '.join(entry.tags)}." if entry.tags else ""
    draw_sentence(
        column,
        context,
        f"{entry.name}: frames {frames.start + 1}–{frames.stop} of {entry.n_frames},"
        f" {entry.frame_rate:g} Hz.{tags}",
    )
    switch = column.row()
    switch.use_property_split = False
    color = square_icon(COLOR)
    switch.prop(context.window_manager, "mocap_assist_ghost", toggle=True, icon_value=color)
    load = context.scene.mocap_assist.load
    column.prop(load, "part")
    column.prop(load, "at_query")
    block = column.column(align=True)
    row = block.row(align=True)
    row.operator(LOAD, text="Append", icon="ACTION").result_as = "ACTION"
    row.operator(LOAD, text="Add to NLA", icon="NLA").result_as = "NLA_TRACK"
    block.operator(LINK, text="Link", icon="LINKED")
    if search.is_ranked:
        _draw_uses(column, context)
    column.operator(MARK, icon="ASSET_MANAGER")


def _draw_uses(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column.label(text="Use Best Matches in:")
    row = column.row(align=True)
    row.operator(LEARN, text="Clean", icon="BRUSH_DATA").group = "clean"
    row.operator(LEARN, text="Reconstruct", icon="ARMATURE_DATA").group = "reconstruct"
    column.label(text="Use Best Matches in Vary:")
    row = column.row(align=True)
    row.operator(USE_OPERATOR, icon="MOD_ARRAY")
    row.prop(context.scene.mocap_assist.use, "n_best", text="")


register, unregister = bpy.utils.register_classes_factory((MOCAP_UL_matches,))
