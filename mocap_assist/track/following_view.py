"""The actor and the tracked body over the 3D View, while a recording is followed."""

from collections.abc import Iterable
from typing import Any

import bpy
import gpu
import numpy as np

from ...solvers.arrays import Array, Single
from ...solvers.depth_scene import LEVEL
from ..blender.redrawing import redraw
from ..overlays.view_drawing import ViewDrawing
from ..scene.units import unit_of
from .live_body import DrawnBody
from .solve_following import PointsPreview

POINT_COLOR = (0.75, 0.78, 0.82, 0.8)
POINT_SIZE_PX = 2.0


class FollowingView(DrawnBody):
    """Shows the newest image as points, and the newest pose, until it is closed.

    Before the floor is known, the camera is taken to be level at the origin.
    """

    def __init__(self, scene: bpy.types.Scene) -> None:
        self.points: Single | None = None
        self._points_drawing = ViewDrawing(self._draw_points)
        super().__init__()
        self._scale = 1.0 / unit_of(scene)

    def show(
        self, scene: bpy.types.Scene, target: bpy.types.Scene, previews: Iterable[Any]
    ) -> None:
        """Show the last pose and the last image of the previews, if there are any."""
        points, others = None, []
        for preview in previews:
            if isinstance(preview, PointsPreview):
                points = preview.points
            else:
                others.append(preview)
        poses = list(self._receiver.poses(others))
        if points is None and not poses:
            return
        matrix = self._scene_from_camera()
        if points is not None:
            self.points = (points @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
        if poses:
            self.drawn = self.solid_of(poses[-1], matrix)
        redraw(bpy.context, "VIEW_3D")

    def close(self) -> None:
        """Remove the body and the points."""
        self._points_drawing.close()
        super().close()
        redraw(bpy.context, "VIEW_3D")

    def _scene_from_camera(self) -> Array:
        rotation, translation = (self._receiver.floor or LEVEL).world_from_camera()
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self._scale * rotation, self._scale * translation
        return matrix

    def _draw_points(self, context: bpy.types.Context) -> None:
        if self.points is None or not len(self.points):
            return
        from gpu_extras.batch import batch_for_shader

        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        batch = batch_for_shader(shader, "POINTS", {"pos": self.points})
        gpu.state.point_size_set(POINT_SIZE_PX)
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set("LESS_EQUAL")
        shader.bind()
        shader.uniform_float("color", POINT_COLOR)
        batch.draw(shader)
        gpu.state.point_size_set(1.0)
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")
