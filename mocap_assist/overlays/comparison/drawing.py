"""Draw the recorded take and its result over the 3D View; the scene is not changed."""

from collections.abc import Callable
from typing import Any, NamedTuple

import bpy
import gpu
import numpy as np
from bpy.app import handlers
from mathutils import Matrix

from ...actions.markers.holders import holder_of
from ...blender.redrawing import redraw
from ...scene.played_time import played_time
from ..contacts import rings
from ..strip import drawing as strip
from ..view_drawing import Color, ViewDrawing, draw_in_front, draw_lines, visible_active
from . import figures, markers, onion_skin, raw_curves_switch
from .wipe import clipped, draw_wipe_line

EDIT_PAUSE_S = 0.3
"""Seconds without an edit after which keys are read again. It bounds the work while a key is
dragged, which is an edit at each step."""

_drawing: list[ViewDrawing] = []


class Look(NamedTuple):
    """The drawn parts of the raw and the clean take, and their style."""

    colors: tuple[Color, Color]
    width: float
    has_poses: bool
    """Whether the poses at the current frame are drawn."""
    onion: onion_skin.Onion | None
    """Ghosts and trails of armatures, if any."""
    wipe: float | None
    """Position of the line with the raw take to its left, as a fraction of the view's width."""


def start(draw_all: Callable[[bpy.types.Context], None]) -> None:
    """Call `draw_all` whenever a 3D View is drawn."""
    _drawing.append(ViewDrawing(draw_all))
    handlers.depsgraph_update_post.append(_follow_edit)
    for each in _REPLACING:
        each.append(_follow_replacement)


def stop() -> None:
    """Undo `start`."""
    for each in _REPLACING:
        each.remove(_follow_replacement)
    handlers.depsgraph_update_post.remove(_follow_edit)
    if bpy.app.timers.is_registered(refresh):
        bpy.app.timers.unregister(refresh)
    _drawing.pop().close()
    forget()


def forget() -> None:
    """Clear the caches, so that the next drawing reads the actions again."""
    figures.forget()
    onion_skin.forget()
    markers.forget()
    raw_curves_switch.forget()
    strip.forget()
    rings.forget()


def draw(context: bpy.types.Context, look: Look) -> None:
    """Draw the raw and clean poses of the active armature or markers at the current frame."""
    active = visible_active(context)
    holder = holder_of(active)
    if active is not None and active.type == "ARMATURE":
        _draw_figures(active, context.scene.frame_current_final, look)
    elif holder is not None and look.has_poses:
        played = markers.raw_and_clean(holder)
        for each, color, is_raw in zip(played, look.colors, (True, False), strict=True):
            with clipped(look.wipe, left=is_raw):
                lines = markers.lines_at(each, context.scene)
                draw_lines(lines, Matrix.Identity(4), color, look.width)
    else:
        return
    if look.wipe is not None:
        draw_wipe_line(look.wipe, look.width)


def _draw_figures(armature: bpy.types.Object, frame: float, look: Look) -> None:
    sources = figures.raw_and_clean(armature)
    frame = played_time(armature, frame).action_frame(frame)
    for source, color, is_raw in zip(sources, look.colors, (True, False), strict=True):
        if source is None:
            continue
        with clipped(look.wipe, left=is_raw):
            if look.onion is not None:
                faded = onion_skin.onion_at(armature, source, frame, look.onion)
                draw_faded(faded, armature.matrix_world, color, look.width)
            if look.has_poses:
                lines = figures.figures_at(armature, source, frame).segments(frame)
                draw_lines(lines, armature.matrix_world, color, look.width)


def draw_faded(faded: onion_skin.FadedLines, matrix: Any, color: Color, width: float) -> None:
    """Draw lines with their own opacities in one batch, in front of all objects."""
    if not len(faded.lines):
        return
    colors = np.empty((*faded.alphas.shape, 4), np.float32)
    colors[:] = color
    colors[..., 3] *= faded.alphas
    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    content = {"pos": faded.lines.reshape(-1, 3), "color": colors.reshape(-1, 4)}
    draw_in_front(shader, content, matrix, width)


@handlers.persistent
def _follow_edit(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Read keys and rest poses again after an edit, but not while they are dragged."""
    kinds = (bpy.types.Action, bpy.types.Armature)
    if not any(isinstance(update.id, kinds) for update in depsgraph.updates):
        return
    if bpy.app.timers.is_registered(refresh):
        bpy.app.timers.unregister(refresh)
    bpy.app.timers.register(refresh, first_interval=EDIT_PAUSE_S)


def refresh() -> None:
    """Read again, and redraw every editor of motion."""
    forget()
    for editor in ("VIEW_3D", *strip.EDITORS):
        redraw(bpy.context, editor)


@handlers.persistent
def _follow_replacement(*_: object) -> None:
    """Clear the caches because undo, redo or loading replaced the data."""
    forget()


_REPLACING = (handlers.undo_post, handlers.redo_post, handlers.load_post)
