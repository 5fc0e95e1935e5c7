"""The switch of the body over the points, on the window manager: the scene stays as it is."""

from functools import lru_cache

import bpy
import numpy as np

from ...solvers.depth_tracking.body import CAPSULE_SEGMENTS, SEGMENTS, capsule_surface
from ...solvers.errors import MocapAssistError
from ..actions.reliability_curves import reliability_at
from ..drawing.body_drawing import Solid, draw_solid, solid
from ..drawing.heat import shade, trusted_source
from ..drawing.view_drawing import ViewDrawing, redraw, seen_active
from .tracked_body import TrackedBody, bones_of, is_tracked, posed_frames

PLAIN = np.array([0.62, 0.72, 0.85, 1.0])
"""Colour of a joint whose trust is not told."""
OPAQUE = 0.65
"""So that bones and points within are seen, to be posed."""
N_BODIES = 8

_drawing: list[ViewDrawing] = []
_surface = lru_cache(maxsize=N_BODIES)(capsule_surface)


def body_now(armature: bpy.types.Object | None, frame: float) -> Solid | None:
    """Return the capsules of a tracked body as its armature is posed, in colours of trust.

    None for other armatures, and where its bones are no longer those of the body.
    """
    if armature is None or not is_tracked(armature):
        return None
    try:
        body = TrackedBody.read(armature).body
        frames, bones = posed_frames(armature, body), bones_of(armature)
    except MocapAssistError:
        return None
    names = [bones[name] for name in SEGMENTS]
    source = trusted_source(armature)
    told = {} if source is None else reliability_at(source, names, frame)
    colors = np.array([shade(told[name]) if name in told else PLAIN for name in names])
    colors[:, 3] = OPAQUE
    surface = _surface(body)
    matrix = np.array(armature.matrix_world)
    return solid(surface, *surface.placed(frames), matrix, colors[CAPSULE_SEGMENTS])


def wanted(context: bpy.types.Context) -> Solid | None:
    """Return what is to be drawn in this 3D View; not while a solve shows its own body."""
    manager = context.window_manager
    job = manager.mocap_assist_job
    if not manager.mocap_assist_body or (job.running and job.owner in {"track", "retrack"}):
        return None
    return body_now(seen_active(context), context.scene.frame_current_final)


def _draw(context: bpy.types.Context) -> None:
    drawn = wanted(context)
    if drawn is not None:
        draw_solid(drawn, context.region_data)


def _switched(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    redraw(context, "VIEW_3D")


def register() -> None:
    """Add the switch; nothing is drawn until it is on."""
    bpy.types.WindowManager.mocap_assist_body = bpy.props.BoolProperty(
        name="Body Overlay",
        description=(
            "Draw the tracked body in the pose of the armature; blue joints have high"
            " confidence, red ones low"
        ),
        update=_switched,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Take the switch and the drawing away."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_body
