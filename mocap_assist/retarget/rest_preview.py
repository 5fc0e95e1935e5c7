"""Draw both rigs of the bone list in their rest poses, side by side; no rig is posed for it."""

from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ..blender.redrawing import redraw_views
from ..overlays.color_icons import square_icon
from ..overlays.confidence_colors import UNKNOWN
from ..overlays.marked_ranges import COLORS, confidence_mark
from ..overlays.pixel_drawing import (
    TEXT_COLOR,
    Box,
    draw_boxes,
    draw_colored_lines,
    free_space,
    write,
)
from ..overlays.view_drawing import Color, ViewDrawing
from ..panel_parts.preference_values import preference_value
from .bone_highlight import COLOR as HIGHLIGHT
from .bone_map import LISTED_ARMATURES, listed_armature

SWITCH = "mocap_assist_rest_poses"
UNMAPPED: Color = tuple(UNKNOWN.tolist())
BACKGROUND: Color = (0.05, 0.05, 0.05, 0.75)
SIZE_PX, MARGIN_PX = 240, 8
"""Size of the box of a rig, and its distance from others, in pixels at scale 1."""
MIN_REACH = 1e-9
"""Distance of bones from their middle below which a rig has no size. It guards a division."""
_drawing: list[ViewDrawing] = []


class RestFigure(NamedTuple):
    """Bones of a rig in its rest pose, and their colors."""

    name: str
    lines: Array
    """Shape (n_bones, 2, 3), in the scene's units."""
    colors: tuple[Color, ...]


def draw_rest_switch(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switch and, while it is on, the color that the bars do not explain."""
    layout.prop(context.window_manager, SWITCH, toggle=True, icon="ARMATURE_DATA")
    if getattr(context.window_manager, SWITCH):
        layout.label(text="Not Mapped", icon_value=square_icon(UNMAPPED))


def rest_figures(context: bpy.types.Context) -> list[RestFigure]:
    """Return the source and the target.

    None while another armature is active, so that an old list draws nothing, or where a rig has
    no bone to draw.
    """
    listed = context.scene.mocap_assist.bone_map
    armatures = [listed_armature(listed, side) for side in LISTED_ARMATURES]
    if not len(listed.rows) or context.view_layer.objects.active not in armatures:
        return []
    figures = []
    for side, armature in zip(LISTED_ARMATURES, armatures, strict=True):
        figure = None if armature is None else _rest_figure(listed, side, armature)
        if figure is None or not len(figure.lines):
            return []
        figures.append(figure)
    return figures


def _rest_figure(
    listed: bpy.types.PropertyGroup, side: str, armature: bpy.types.Object
) -> RestFigure:
    """Return mapped bones in the color of their confidence, and others that deform in gray."""
    active = listed.rows[min(max(listed.active_row, 0), len(listed.rows) - 1)]
    rated = {
        getattr(row, side): COLORS[confidence_mark(getattr(row, f"{side}_confidence"))]
        for row in listed.rows
        if getattr(row, side)
    }
    if getattr(active, side):
        rated[getattr(active, side)] = HIGHLIGHT
    bones = [bone for bone in armature.data.bones if bone.use_deform or bone.name in rated]
    ends = np.array([[bone.head_local, bone.tail_local] for bone in bones]).reshape(-1, 2, 3)
    matrix = np.array(armature.matrix_world)
    lines = ends @ matrix[:3, :3].T + matrix[:3, 3]
    return RestFigure(
        armature.name, lines, tuple(rated.get(bone.name, UNMAPPED) for bone in bones)
    )


def lines_in_box(lines: Array, rotation: Array, box: Box) -> Array:
    """Return bones as seen from a direction, in a box: shape (n_lines, 2, 2), in pixels.

    Rigs are drawn as large as the box allows in any direction, whatever their own size.

    Parameters
    ----------
    lines : shape (n_lines, 2, 3)
    rotation : shape (3, 3)
        From the space of the view to the scene.
    box : Box
    """
    points = lines.reshape(-1, 3)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    reach = max(float(np.linalg.norm(points - middle, axis=1).max()), MIN_REACH)
    scale = 0.5 * min(box.width, box.height) / reach
    center = np.array([box.x + 0.5 * box.width, box.y + 0.5 * box.height])
    return np.asarray(scale * ((lines - middle) @ rotation)[..., :2] + center)


def _draw(context: bpy.types.Context) -> None:
    figures = rest_figures(context) if getattr(context.window_manager, SWITCH) else []
    scale = context.preferences.system.ui_scale
    space, rotation = free_space(context.area), context.region_data.view_rotation.to_matrix()
    size, margin = min(SIZE_PX * scale, 0.5 * space.width, space.height), MARGIN_PX * scale
    for index, figure in enumerate(figures):
        box = Box(space.x + margin + index * (size + margin), space.y + margin, size, size)
        draw_boxes([(box, BACKGROUND)])
        lines = lines_in_box(figure.lines, np.array(rotation), box)
        draw_colored_lines(lines, np.array(figure.colors), preference_value("line_width"))
        corner = box.x + margin, box.y + margin
        write(figure.name, corner, size - 2 * margin, TEXT_COLOR)


def register() -> None:
    """Add the switch, which starts off."""
    described = bpy.props.BoolProperty(
        name="Rest Poses",
        description=(
            "Draw both rigs in their rest poses at the bottom of 3D Views, in these colors"
        ),
        update=redraw_views,
    )
    setattr(bpy.types.WindowManager, SWITCH, described)
    _drawing.append(ViewDrawing(_draw, in_pixels=True))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    delattr(bpy.types.WindowManager, SWITCH)
