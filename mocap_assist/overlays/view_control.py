"""Zoom and rotate the 3D Views of a window by gestures."""

from collections.abc import Iterator

import bpy
from mathutils import Matrix, Quaternion, Vector

MIN_DISTANCE, MAX_DISTANCE = 1e-3, 1e6
"""View distance in Blender's units."""
MAX_OFF_CENTER = 0.9
"""Distance from the middle of a view, as a fraction of half its size, up to which a point is
seen."""
NO_VIEW = "This window has no 3D View."


def zoom_views(window: bpy.types.Window, factor: float) -> str:
    """Zoom in by a factor; return the message to show."""
    n_views = 0
    for view in _free_views(window):
        view.view_distance = min(max(view.view_distance / factor, MIN_DISTANCE), MAX_DISTANCE)
        n_views += 1
    zoomed = "Zoom: hands apart." if factor > 1.0 else "Zoom: hands together."
    return zoomed if n_views else NO_VIEW


def rotate_views(window: bpy.types.Window, angle: float) -> str:
    """Rotate the scene in the view about the vertical; return the message to show.

    The angle is counter-clockwise from above, in radians. The scene follows the arm, so the
    eye orbits in the opposite direction.
    """
    n_views = 0
    for view in _free_views(window):
        view.view_rotation = Quaternion((0.0, 0.0, 1.0), -angle) @ view.view_rotation
        n_views += 1
    return "Turn: right arm." if n_views else NO_VIEW


def show_point(manager: bpy.types.WindowManager, point: Vector) -> None:
    """Move the 3D Views that do not show a point of the scene, so that it is in the middle."""
    for window in manager.windows:
        for view in _free_views(window):
            if not is_in_view(view.perspective_matrix, point):
                view.view_location = point


def is_in_view(perspective: Matrix, point: Vector) -> bool:
    """Whether a point is well within the borders of a view."""
    x, y, _, w = perspective @ point.to_4d()
    return bool(w > 0.0 and max(abs(x), abs(y)) <= MAX_OFF_CENTER * w)


def _free_views(window: bpy.types.Window | None) -> Iterator[bpy.types.RegionView3D]:
    """Yield the views that do not look through a camera."""
    areas = [] if window is None else window.screen.areas
    for area in areas:
        if area.type == "VIEW_3D":
            view = area.spaces.active.region_3d
            if view is not None and view.view_perspective != "CAMERA":
                yield view
                area.tag_redraw()
