"""Switch of the body overlay; it is on the window manager, not in the scene."""

from functools import lru_cache

import bpy
import numpy as np

from ...solvers.depth_tracking.body import CAPSULE_SEGMENTS, SEGMENTS, capsule_surface
from ...solvers.errors import MocapAssistError
from ..actions.reliability_curves import reliability_at
from ..blender.redrawing import redraw_views
from ..overlays.body_drawing import Solid, draw_solid, place_capsules
from ..overlays.confidence_colors import color_from_reliability, reliability_source
from ..overlays.view_drawing import ViewDrawing, visible_active
from ..scene.played_time import played_time
from .tracked_armature.body import TrackedBody, bones_of, is_tracked, posed_frames

NEUTRAL_COLOR = np.array([0.62, 0.72, 0.85, 1.0])
"""Color of a joint without a confidence."""
OPACITY = 0.65
"""Low enough to show bones and points inside the body."""
N_BODIES = 8
"""Number of bodies whose surface is kept. It bounds the memory."""

_drawing: list[ViewDrawing] = []
_surface = lru_cache(maxsize=N_BODIES)(capsule_surface)


def body_at(armature: bpy.types.Object | None, frame: float) -> Solid | None:
    """Return the capsules of a tracked body in its armature's pose, in confidence colors.

    None for other armatures, and if its bones no longer match the body.
    """
    if armature is None or not is_tracked(armature):
        return None
    try:
        body = TrackedBody.read(armature).body
        frames, bones = posed_frames(armature, body), bones_of(armature)
    except MocapAssistError:
        return None
    names = [bones[name] for name in SEGMENTS]
    source = reliability_source(armature)
    played = played_time(armature, frame).action_frame(frame)
    confidence = {} if source is None else reliability_at(source, names, played)
    colors = np.array([
        color_from_reliability(confidence[name]) if name in confidence else NEUTRAL_COLOR
        for name in names
    ])
    colors[:, 3] = OPACITY
    surface = _surface(body)
    matrix = np.array(armature.matrix_world)
    return place_capsules(surface, *surface.at_pose(frames), matrix, colors[CAPSULE_SEGMENTS])


def body_to_draw(context: bpy.types.Context) -> Solid | None:
    """Return the body to draw in this 3D View; None while a solve shows its own body."""
    manager = context.window_manager
    job = manager.mocap_assist_job
    if not manager.mocap_assist_body or (job.running and job.owner in {"track", "retrack"}):
        return None
    return body_at(visible_active(context), context.scene.frame_current_final)


def _draw(context: bpy.types.Context) -> None:
    drawn = body_to_draw(context)
    if drawn is not None:
        draw_solid(drawn, context.region_data)


def register() -> None:
    """Add the switch, which starts off."""
    bpy.types.WindowManager.mocap_assist_body = bpy.props.BoolProperty(
        name="Body Overlay",
        description=(
            "Draw the tracked body in the armature's pose; blue is high confidence, red is low"
        ),
        update=redraw_views,
    )
    _drawing.append(ViewDrawing(_draw))


def unregister() -> None:
    """Remove the switch and the drawing."""
    _drawing.pop().close()
    del bpy.types.WindowManager.mocap_assist_body
