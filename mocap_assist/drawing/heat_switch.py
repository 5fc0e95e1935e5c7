"""The switch of the heat colours: on the window manager, so that the scene stays as it is."""

from typing import Any

import bpy
import gpu
import numpy as np

from ..actions.reliability_curves import Term
from ..panels.drawing import draw_sentence
from ..panels.preferred import preferred
from .heat import Heat, heat_at, terms_told
from .view_drawing import ViewDrawing, redraw, seen_active

WIDER = 2.0
"""Times as wide as the lines of the overlay, for they lie upon the bones."""
TERMS = (
    (Term.COMBINED, "Combined", "Overall probability that each joint is right"),
    (Term.BEHAVIOUR, "Movement", "Red joints vibrate in a way that no limb does"),
    (
        Term.KINEMATICS,
        "Lengths",
        "Red joints are at bones whose length differs from the body's",
    ),
    (Term.TRACKING, "Sensor", "Red joints were missing or inferred by the sensor"),
)
MISSING = {
    Term.KINEMATICS: ("Lengths: needs the imported file and an unedited action."),
    Term.TRACKING: "Sensor: the recording has no tracking state of the joints.",
}
OLDER = "Made by an earlier version without details. Run Reconstruct again."
NOTHING_TOLD = "No confidence data in this action. Run Reconstruct first."
_drawing: list[ViewDrawing] = []


def draw_heat_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switch and, while it is on, whose trust is shown and what is not known."""
    manager = context.window_manager
    layout.prop(manager, "mocap_assist_heat", toggle=True, icon="COLOR")
    armature = context.view_layer.objects.active
    if not manager.mocap_assist_heat or armature is None or armature.type != "ARMATURE":
        return
    told = terms_told(armature)
    signs = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
    for term, _, _ in TERMS:
        cell = signs.row(align=True)
        cell.enabled = term in told
        cell.prop_enum(manager, "mocap_assist_heat_term", term.name)
    for sentence in _missing(told):
        draw_sentence(layout, context, sentence, icon="INFO")


def _missing(told: frozenset[Term]) -> list[str]:
    """Say what cannot be shown, and why."""
    if not told:
        return [NOTHING_TOLD]
    if told == {Term.COMBINED}:
        return [OLDER]
    return [MISSING[term] for term in MISSING if term not in told]


def _switched(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    redraw(context, "VIEW_3D")


def _draw(context: bpy.types.Context) -> None:
    if not context.window_manager.mocap_assist_heat:
        return
    armature = seen_active(context)
    if armature is None or armature.type != "ARMATURE":
        return
    term = Term[context.window_manager.mocap_assist_heat_term]
    heat = heat_at(armature, context.scene.frame_current_final, term)
    if heat is not None:
        _draw_heat(heat, armature.matrix_world, WIDER * preferred("line_width"))


def _draw_heat(heat: Heat, matrix: Any, width: float) -> None:
    """Draw bones and joints in front of everything."""
    from gpu_extras.batch import batch_for_shader

    points = np.ascontiguousarray(heat.ends.reshape(-1, 3))
    colors = np.ascontiguousarray(heat.colors.reshape(-1, 4))
    lines = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    batch = batch_for_shader(lines, "LINES", {"pos": points, "color": colors})
    lines.bind()
    lines.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    lines.uniform_float("lineWidth", width)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix)
        batch.draw(lines)
    gpu.state.blend_set("NONE")


def register() -> None:
    """Add the switch; nothing is drawn until it is on."""
    bpy.types.WindowManager.mocap_assist_heat = bpy.props.BoolProperty(
        name="Show Confidence",
        description=(
            "Color the bones by the confidence in their joints at the current frame: blue is"
            " high, red is low"
        ),
        update=_switched,
    )
    bpy.types.WindowManager.mocap_assist_heat_term = bpy.props.EnumProperty(
        name="Confidence Source",
        description="Measure of confidence to show",
        items=[
            (term.name, label, description, number)
            for number, (term, label, description) in enumerate(TERMS)
        ],
        update=_switched,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Take the switch and the drawing away."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_heat_term
    del bpy.types.WindowManager.mocap_assist_heat
