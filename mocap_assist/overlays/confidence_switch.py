"""Switch of the confidence colors; it is on the window manager, not in the scene."""

from typing import Any

import bpy
import gpu
import numpy as np

from ..actions.reliability_curves import Term
from ..blender.redrawing import redraw_views
from ..panel_parts.panel_layout import draw_sentence
from ..panel_parts.preference_values import preference_value
from .color_icons import draw_marks
from .confidence_colors import ColoredBones, available_terms, colored_bones_at
from .marked_ranges import MARKS, StripRow
from .view_drawing import ViewDrawing, draw_in_front, visible_active

WIDTH_FACTOR = 2.0
"""Line width relative to the comparison overlay, so that bones do not hide the lines."""
TERMS = (
    (Term.COMBINED, "Combined", "Show the overall probability that each joint is right"),
    (Term.BEHAVIOR, "Movement", "Show in red the joints that vibrate as no limb does"),
    (
        Term.KINEMATICS,
        "Lengths",
        "Show in red the joints of bones whose length differs from the body's",
    ),
    (
        Term.TRACKING,
        "Sensor",
        "Show in red the joints that were missing or inferred by the sensor",
    ),
)
MISSING = {
    Term.KINEMATICS: ("Lengths: needs the imported file and an unedited action."),
    Term.TRACKING: "Sensor: the recording has no tracking state of the joints.",
}
OLDER = "Made by an earlier version without details. Run Reconstruct again."
NO_TERMS = "No confidence data in this action. Run Reconstruct first."
_drawing: list[ViewDrawing] = []


def draw_confidence_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switch and, while it is on, the sources of confidence and missing ones."""
    manager = context.window_manager
    layout.prop(manager, "mocap_assist_confidence", toggle=True, icon="COLOR")
    armature = context.view_layer.objects.active
    if not manager.mocap_assist_confidence or armature is None or armature.type != "ARMATURE":
        return
    available = available_terms(armature)
    grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    for term, _, _ in TERMS:
        cell = grid.row(align=True)
        cell.enabled = term in available
        cell.prop_enum(manager, "mocap_assist_confidence_term", term.name)
    draw_marks(layout, MARKS[StripRow.CONFIDENCE], columns=3)
    for sentence in _describe_missing(available):
        draw_sentence(layout, context, sentence, icon="INFO")


def _describe_missing(available: frozenset[Term]) -> list[str]:
    """Return a message for each missing term."""
    if not available:
        return [NO_TERMS]
    if available == {Term.COMBINED}:
        return [OLDER]
    return [MISSING[term] for term in MISSING if term not in available]


def _draw(context: bpy.types.Context) -> None:
    if not context.window_manager.mocap_assist_confidence:
        return
    armature = visible_active(context)
    if armature is None or armature.type != "ARMATURE":
        return
    term = Term[context.window_manager.mocap_assist_confidence_term]
    bones = colored_bones_at(armature, context.scene.frame_current_final, term)
    if bones is not None:
        _draw_colored_bones(
            bones, armature.matrix_world, WIDTH_FACTOR * preference_value("line_width")
        )


def _draw_colored_bones(bones: ColoredBones, matrix: Any, width: float) -> None:
    points = np.ascontiguousarray(bones.ends.reshape(-1, 3))
    colors = np.ascontiguousarray(bones.colors.reshape(-1, 4))
    lines = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    draw_in_front(lines, {"pos": points, "color": colors}, matrix, width)


def register() -> None:
    """Add the switch, which starts off."""
    bpy.types.WindowManager.mocap_assist_confidence = bpy.props.BoolProperty(
        name="Show Confidence",
        description=(
            "Color bones by the confidence in their joints at this frame; blue is high, red is"
            " low"
        ),
        update=redraw_views,
    )
    bpy.types.WindowManager.mocap_assist_confidence_term = bpy.props.EnumProperty(
        name="Confidence Source",
        description="Measure of confidence to show",
        items=[
            (term.name, label, description, number)
            for number, (term, label, description) in enumerate(TERMS)
        ],
        update=redraw_views,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_confidence_term
    del bpy.types.WindowManager.mocap_assist_confidence
