"""Live preview of the tracked body over the points; the scene follows in time."""

from collections.abc import Callable, Iterable
from time import monotonic
from typing import Any, NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.depth_tracking.body import CAPSULE_SEGMENTS, capsule_surface, segment_frames
from ...solvers.depth_tracking.tracking import PosePreview
from ..depth.depth_preview import Shown, shown_by
from ..overlays.body_drawing import Solid, draw_solid, place_capsules
from ..overlays.confidence_colors import color_from_reliability
from ..overlays.view_drawing import ViewDrawing
from .pose_previews import PosePreviewReceiver

OPACITY = 0.9
MAX_TIME_FRACTION = 0.3
"""Maximum fraction of the time for frame changes. It guards heavy scenes, which would slow down
tracking."""


class BodyDisplay(NamedTuple):
    """Position and timing of the displayed body."""

    scene_from_camera: Array
    """Shape (4, 4)."""
    shown: Shown


StageOf = Callable[[bpy.types.Object], BodyDisplay]
"""Return the stage of the subject in its current state."""


def stage_of_preview(preview: bpy.types.Object) -> BodyDisplay:
    """Return the stage of a recording's points; raises MocapAssistError if there are none."""
    return BodyDisplay(np.array(preview.matrix_world), shown_by(preview.data))


class DrawnBody:
    """A body that is drawn over the 3D View until it is closed."""

    def __init__(self) -> None:
        self._receiver = PosePreviewReceiver()
        self.drawn: Solid | None = None
        self._drawing = ViewDrawing(self._draw)
        self._body: Any = None

    def _draw(self, context: bpy.types.Context) -> None:
        if self.drawn is not None:
            draw_solid(self.drawn, context.region_data)

    def solid_of(self, preview: PosePreview, scene_from_camera: Array) -> Solid:
        """Return a pose as capsules in the confidence colors of their joints."""
        if preview.body is not self._body:
            self._body, self._surface = preview.body, capsule_surface(preview.body)
        frames = segment_frames(preview.body, preview.pose)
        colors = np.array([
            color_from_reliability(confidence) for confidence in preview.quality.confidence
        ])
        colors[:, 3] = OPACITY
        placed = self._surface.at_pose(frames)
        return place_capsules(
            self._surface, *placed, scene_from_camera, colors[CAPSULE_SEGMENTS]
        )

    def close(self) -> None:
        """Remove the body."""
        self._drawing.close()


class LiveBody(DrawnBody):
    """Shows the newest pose until it is closed; then restores the scene's frame.

    As with any change of the frame, unkeyed changes of animated properties are lost.
    """

    def __init__(self, scene: bpy.types.Scene, stage_of: StageOf) -> None:
        super().__init__()
        self._scene, self._stage_of = scene.session_uid, stage_of
        self._frame = (scene.frame_current, scene.frame_subframe)
        self._not_before = 0.0

    def show(
        self, scene: bpy.types.Scene, target: bpy.types.Object, previews: Iterable[Any]
    ) -> None:
        """Show the last pose of the previews, if there is one."""
        poses = list(self._receiver.poses(previews))
        began = monotonic()
        if not poses or began < self._not_before:
            return
        stage = self._stage_of(target)
        frame = stage.shown.frame(poses[-1].frame)
        scene.frame_set(int(np.floor(frame)), subframe=float(frame % 1.0))
        self.drawn = self.solid_of(poses[-1], stage.scene_from_camera)
        self._not_before = monotonic() + (monotonic() - began) * (1.0 / MAX_TIME_FRACTION - 1.0)

    def close(self) -> None:
        """Remove the body, and restore the frame."""
        super().close()
        for scene in bpy.data.scenes:
            if scene.session_uid == self._scene:
                scene.frame_set(self._frame[0], subframe=self._frame[1])
