"""Zoom and turn the 3D Views of a window, as gestures ask for."""

from collections.abc import Iterator

import bpy
from mathutils import Quaternion

NEAREST, FARTHEST = 1e-3, 1e6
"""Blender's units from the eye to what it looks at."""
NO_VIEW = "This window has no 3D View."


def zoom_views(window: bpy.types.Window, factor: float) -> str:
    """Bring what is seen nearer by a factor; return the sentence to show."""
    moved = 0
    for view in _free_views(window):
        view.view_distance = min(max(view.view_distance / factor, NEAREST), FARTHEST)
        moved += 1
    return f"Zoom: hands {'apart' if factor > 1.0 else 'together'}." if moved else NO_VIEW


def turn_views(window: bpy.types.Window, angle: float) -> str:
    """Turn what is seen about the vertical; return the sentence to show.

    Counter-clockwise as seen from above, in radians: the scene follows the arm, so that the
    eye goes round it the other way.
    """
    moved = 0
    for view in _free_views(window):
        view.view_rotation = Quaternion((0.0, 0.0, 1.0), -angle) @ view.view_rotation
        moved += 1
    return "Turn: right arm." if moved else NO_VIEW


def _free_views(window: bpy.types.Window | None) -> Iterator[bpy.types.RegionView3D]:
    """Yield the views that do not look through a camera, which is the scene's."""
    areas = [] if window is None else window.screen.areas
    for area in areas:
        if area.type == "VIEW_3D":
            view = area.spaces.active.region_3d
            if view is not None and view.view_perspective != "CAMERA":
                yield view
                area.tag_redraw()
