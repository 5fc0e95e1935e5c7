"""Grid of the good matches as key poses; a search without any says so."""

from typing import ClassVar

import bpy

from ..blender.mixins import OperatorMixin
from ..panel_parts.panel_layout import draw_sentence, is_wide
from .previews import icon_of
from .searches import Search

CHOOSE = "mocap_assist.choose_match"
GOOD_SCORE = 0.2
"""Score, as a fraction, from which a match is good. Measured: it is between 0.17 and 0.26 on 30
development clips of five kinds: no clip of another kind had more than the first, and the best
clip of the same kind never less than the second."""
MAX_CELLS = 6
"""Number of cells that are drawn. It bounds the height of the panel."""
NARROW_COLUMNS, WIDE_COLUMNS = 2, 3
PICTURE_BUTTON_HEIGHTS = 4.5
"""Size of a picture, in heights of a button."""


class MOCAP_OT_choose_match(OperatorMixin, bpy.types.Operator):
    bl_idname = CHOOSE
    bl_label = "Select Match"
    bl_description = "Show this clip, and use it for the buttons below"
    bl_options: ClassVar = {"INTERNAL"}  # the window manager has no undo

    index: bpy.props.IntProperty(name="Match", options={"SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        listed = context.window_manager.mocap_assist_matches
        if not 0 <= self.index < len(listed.rows):
            return {"CANCELLED"}
        listed.active = self.index
        return {"FINISHED"}


def count_good(scores: list[float]) -> int:
    """Return how many of the scores, the highest first, are of good matches."""
    return sum(score >= GOOD_SCORE for score in scores)


def draw_match_grid(
    layout: bpy.types.UILayout, context: bpy.types.Context, search: Search
) -> int:
    """Draw a cell for each good match, up to a maximum; return the number of good matches."""
    listed = context.window_manager.mocap_assist_matches
    n_good = count_good([row.score for row in listed.rows])
    if not n_good:
        best = listed.rows[0]
        text = f"No good match. The best is {best.name}, with a score of {best.score:.0%}."
        draw_sentence(layout, context, text, icon="INFO")
    columns = WIDE_COLUMNS if is_wide(context) else NARROW_COLUMNS
    grid = layout.grid_flow(row_major=True, columns=columns, even_columns=True, align=True)
    for index in range(min(n_good, MAX_CELLS)):
        row, cell = listed.rows[index], grid.column(align=True)
        cell.template_icon(icon_of(search, index), scale=PICTURE_BUTTON_HEIGHTS)
        is_shown = index == listed.active
        text = f"{row.score:.0%} {row.name}" if search.is_ranked else row.name
        cell.operator(CHOOSE, text=text, translate=False, depress=is_shown).index = index
    return n_good


register, unregister = bpy.utils.register_classes_factory((MOCAP_OT_choose_match,))
