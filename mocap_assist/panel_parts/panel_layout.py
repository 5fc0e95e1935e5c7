"""Wrapped sentences, progress bars and columns of settings for panels."""

from collections.abc import Container
from dataclasses import fields
from functools import lru_cache

import blf
import bpy

from ...solvers.settings import Settings, research_names
from ..languages import broken_lines, translated
from .preference_values import preference_value

BORDER_WIDTH_PX = 64
"""Width of both borders of a panel, and of a box in it, in pixels at scale 1."""
ICON_WIDTH_PX = 20
"""Width of the icon left of a sentence, in pixels at scale 1: Blender's unit of a widget."""
MIN_WIDE_SIDEBAR_PX = 340
"""Pixels from which a sidebar has space for two columns; Blender's default one is narrower."""
MIN_LINE_PX = 130
"""Width in pixels at scale 1 below which text is not wrapped further."""
MAX_CACHED = 128
"""Number of cached sentences. It bounds the memory."""


def operator_exists(idname: str) -> bool:
    """Whether Blender knows an operator, such as mocap_assist.denoise."""
    family, _, name = idname.partition(".")
    return hasattr(bpy.types, f"{family.upper()}_OT_{name}")


def draw_sentence(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE"
) -> None:
    """Draw a sentence, wrapped to the sidebar's width."""
    draw_lines(layout, text, sidebar_width(context), icon)


def draw_lines(layout: bpy.types.UILayout, text: str, width: float, icon: str = "NONE") -> None:
    """Draw a sentence, wrapped to a width in pixels at scale 1."""
    free = width - BORDER_WIDTH_PX - (ICON_WIDTH_PX if icon != "NONE" else 0)
    lines = column_lines(translated(text), free, letter_size_px())
    column = layout.column(align=True)
    column.scale_y = 0.8
    for index, line in enumerate(lines):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            shown = "BLANK1" if index else icon
            column.label(text=line, translate=False, icon=shown)


@lru_cache(MAX_CACHED)
def column_lines(text: str, width: float, font_size: float) -> tuple[str, ...]:
    """Break a sentence into lines of a width in pixels, in the font of the interface."""
    blf.size(0, font_size)
    limit = max(width, MIN_LINE_PX)
    return tuple(broken_lines(text, lambda line: blf.dimensions(0, line)[0] <= limit))


def letter_size_px() -> float:
    """Return the size of the letters of panels, in pixels at scale 1."""
    return float(bpy.context.preferences.ui_styles[0].widget.points)


def is_wide(context: bpy.types.Context) -> bool:
    """Whether the sidebar has room for another column."""
    return sidebar_width(context) >= MIN_WIDE_SIDEBAR_PX


def sidebar_width(context: bpy.types.Context) -> float:
    """Return the width in pixels at scale 1; 0 where there is no window."""
    scale = context.preferences.system.ui_scale
    return context.region.width / scale if context.region is not None and scale else 0.0


def draw_job(layout: bpy.types.UILayout, context: bpy.types.Context, *owners: str) -> bool:
    """Draw the progress of the running solve, if it is one of these owners'.

    Return whether any runs: settings can wait until it has ended.
    """
    job = context.window_manager.mocap_assist_job
    if job.running and job.owner in owners:
        draw_sentence(layout, context, job.message)  # too long for the bar in some languages
        column = layout.column(align=True)
        if job.fraction < 1.0:  # else it is done, or goes on until Esc
            text = f"{job.fraction:.0%}"
            column.progress(factor=job.fraction, type="BAR", text=text, translate=False)
        column.label(text=translated(job.ending), translate=False)
    return bool(job.running)


def settings_column(
    layout: bpy.types.UILayout, context: bpy.types.Context, *owners: str
) -> bpy.types.UILayout:
    """Draw the running solve of these owners; return a column that is gray while any runs."""
    running = draw_job(layout, context, *owners)
    column = split_column(layout)
    column.enabled = not running
    return column


def split_column(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Return a column with names left of values, and without dots for keys."""
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def folded_settings(
    settings: type[Settings], shown: Container[str], group: bpy.types.PropertyGroup
) -> list[str]:
    """Return the names of the settings that a panel folds away.

    Research settings are left out, unless the preferences show them or their value in `group`
    is not the default: what has an effect is never hidden.
    """
    hidden = frozenset() if preference_value("show_research") else research_names(settings)
    return [
        item.name
        for item in fields(settings)
        if item.name not in shown
        and (item.name not in hidden or not _is_default(group, item.name))
    ]


def _is_default(group: bpy.types.PropertyGroup, name: str) -> bool:
    return bool(getattr(group, name) == group.bl_rna.properties[name].default)
