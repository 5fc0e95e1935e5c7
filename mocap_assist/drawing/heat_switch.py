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
    (Term.COMBINED, "Combined", "How likely each joint is right, all in all"),
    (Term.BEHAVIOUR, "Movement", "Red joints shake to and fro as no limb does"),
    (
        Term.KINEMATICS,
        "Lengths",
        "Red joints are at the ends of bones that are longer or shorter than they should be",
    ),
    (Term.TRACKING, "Sensor", "Red joints are those that the sensor itself lost or guessed"),
)
MISSING = {
    Term.KINEMATICS: (
        "Lengths: an armature's never change; the camera's are known while the imported file is"
        " there and the action unedited."
    ),
    Term.TRACKING: "Sensor: the recording does not tell how well the sensor saw each joint.",
}
OLDER = "Made by an earlier version, which did not tell why. Press Reconstruct again."
NOTHING_TOLD = "This action tells nothing of trust. Press Reconstruct, or choose its result."
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
        name="Trust in Colours",
        description=(
            "Draw the bones of a reconstructed action in the colours of how far their joints"
            " were trusted at the present frame: blue was trusted, red was not"
        ),
        update=_switched,
    )
    bpy.types.WindowManager.mocap_assist_heat_term = bpy.props.EnumProperty(
        name="Sign",
        description="Which sign of trust the colours show",
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
