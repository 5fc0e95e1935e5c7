"""Pieces that several panels draw."""

from textwrap import wrap

import bpy

LETTER = 6.2  # width of a letter of the interface, in pixels at scale 1, on average
BORDER = 50  # of a panel, likewise
FEWEST_LETTERS = 24  # in a line


def exists(idname: str) -> bool:
    """Whether Blender knows an operator, such as mocap_assist.denoise."""
    family, _, name = idname.partition(".")
    return hasattr(bpy.types, f"{family.upper()}_OT_{name}")


def draw_sentence(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE"
) -> None:
    """Draw a sentence over as many lines as the sidebar's width asks for."""
    width = context.region.width if context.region is not None else 0
    lines = column_lines(text, width, context.preferences.system.ui_scale)
    column = layout.column(align=True)
    column.scale_y = 0.8
    for index, line in enumerate(lines):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            shown = "BLANK1" if index else icon
            column.label(text=line, translate=False, icon=shown)


def column_lines(text: str, width: float, scale: float) -> list[str]:
    """Break a sentence into lines for a region of that many pixels.

    `scale` is the interface's; it is 0 where there is no window.
    """
    return wrap(text, max(int((width / (scale or 1.0) - BORDER) / LETTER), FEWEST_LETTERS))


def draw_job(layout: bpy.types.UILayout, context: bpy.types.Context) -> bool:
    """Draw how far the running solve is; return whether there is one."""
    job = context.window_manager.mocap_assist_job
    if job.running:
        column = layout.column(align=True)
        text = f"{job.message} {job.fraction:.0%}"
        column.progress(factor=job.fraction, type="BAR", text=text, translate=False)
        column.label(text="Esc cancels")
    return bool(job.running)
