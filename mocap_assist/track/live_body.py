"""The body while it is tracked: over the points, and the scene goes along in time."""

from collections.abc import Callable, Iterable
from time import monotonic
from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.depth_tracking.body import CAPSULE_SEGMENTS, capsule_surface, segment_frames
from ...solvers.depth_tracking.tracking import PosePreview
from ..depth.depth_preview import Shown, shown_by
from ..drawing.body_drawing import Solid, draw_solid, solid
from ..drawing.heat import shade
from ..drawing.view_drawing import ViewDrawing
from .pose_previews import Onlooker

Array = NDArray[np.float64]

OPAQUE = 0.9
AT_MOST = 0.3
"""Share of the time that going to frames may take, however heavy the scene is."""


class Stage(NamedTuple):
    """Where the body is shown, and when."""

    scene_from_camera: Array
    """Shape (4, 4)."""
    shown: Shown


StageOf = Callable[[bpy.types.Object], Stage]
"""From what is solved for, as it is at the time."""


def stage_of_preview(preview: bpy.types.Object) -> Stage:
    """Return where the points of a recording are; raises MocapAssistError if nowhere."""
    return Stage(np.array(preview.matrix_world), shown_by(preview.data))


class LiveBody:
    """Shows the newest pose until it is closed; then the scene is at the frame of before.

    As with any change of the frame, what was changed without keys on animated things is lost.
    """

    def __init__(self, scene: bpy.types.Scene, stage_of: StageOf) -> None:
        self._scene, self._stage_of = scene.session_uid, stage_of
        self._frame = (scene.frame_current, scene.frame_subframe)
        self._onlooker = Onlooker()
        self.drawn: Solid | None = None
        self._drawing = ViewDrawing(self._draw)
        self._body: Any = None
        self._not_before = 0.0

    def _draw(self, context: bpy.types.Context) -> None:
        if self.drawn is not None:
            draw_solid(self.drawn, context.region_data)

    def look(
        self, scene: bpy.types.Scene, thing: bpy.types.Object, shown: Iterable[Any]
    ) -> None:
        """Show the last pose of what a solve has shown, if there is any."""
        poses = list(self._onlooker.poses(shown))
        began = monotonic()
        if not poses or began < self._not_before:
            return
        stage = self._stage_of(thing)
        frame = stage.shown.frame(poses[-1].frame)
        scene.frame_set(int(np.floor(frame)), subframe=float(frame % 1.0))
        self.drawn = self.solid_of(poses[-1], stage.scene_from_camera)
        self._not_before = monotonic() + (monotonic() - began) * (1.0 / AT_MOST - 1.0)

    def solid_of(self, found: PosePreview, scene_from_camera: Array) -> Solid:
        """Return a pose as capsules, in the colours of how sure their joints are."""
        if found.body is not self._body:
            self._body, self._surface = found.body, capsule_surface(found.body)
        frames = segment_frames(found.body, found.pose)
        colors = np.array([shade(sure) for sure in found.quality.confidence])
        colors[:, 3] = OPAQUE
        placed = self._surface.at_pose(frames)
        return solid(self._surface, *placed, scene_from_camera, colors[CAPSULE_SEGMENTS])

    def close(self) -> None:
        """Show nothing more, and go back to the frame of before."""
        self._drawing.close()
        for scene in bpy.data.scenes:
            if scene.session_uid == self._scene:
                scene.frame_set(self._frame[0], subframe=self._frame[1])
