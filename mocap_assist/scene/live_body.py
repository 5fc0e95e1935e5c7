"""The body while it is tracked: over the points, and the scene goes along in time."""

from collections.abc import Iterable
from time import monotonic
from typing import Any

import bpy
import numpy as np

from ...solvers.depth_tracking.body_kinematics import segment_frames
from ...solvers.depth_tracking.body_tables import CAPSULE_SEGMENTS
from ...solvers.depth_tracking.capsule_surface import capsule_surface
from ...solvers.depth_tracking.found_pose import FoundPose
from ..jobs.glimpses import Onlooker
from .body_drawing import BodyDrawing, Solid, solid
from .depth_preview import Shown
from .heat import shade

OPAQUE = 0.9
AT_MOST = 0.3
"""Share of the time that going to frames may take, however heavy the scene is."""


class LiveBody:
    """Shows the newest pose until it is closed; then the scene is as it was."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self._scene = scene.session_uid
        self._frame = (scene.frame_current, scene.frame_subframe)
        self._onlooker = Onlooker()
        self.drawn: Solid | None = None
        self._drawing = BodyDrawing(lambda _: self.drawn)
        self._body: Any = None
        self._not_before = 0.0

    def look(
        self, scene: bpy.types.Scene, preview: bpy.types.Object, shown: Iterable[Any]
    ) -> None:
        """Show the last pose of what a solve has shown, if there is any."""
        poses = list(self._onlooker.poses(shown))
        began = monotonic()
        if not poses or began < self._not_before:
            return
        follow(scene, preview, poses[-1].frame)
        self.drawn = self.solid_of(poses[-1], preview)
        self._not_before = monotonic() + (monotonic() - began) * (1.0 / AT_MOST - 1.0)

    def solid_of(self, found: FoundPose, preview: bpy.types.Object) -> Solid:
        """Return a pose as capsules, in the colours of how sure their joints are."""
        if found.body is not self._body:
            self._body, self._surface = found.body, capsule_surface(found.body)
        frames = segment_frames(found.body, found.pose)
        colors = np.array([shade(sure) for sure in found.quality.confidence])
        colors[:, 3] = OPAQUE
        placed = self._surface.placed(frames)
        matrix = np.array(preview.matrix_world)
        return solid(self._surface, *placed, matrix, colors[CAPSULE_SEGMENTS])

    def close(self) -> None:
        """Show nothing more, and go back to the frame of before."""
        self._drawing.close()
        for scene in bpy.data.scenes:
            if scene.session_uid == self._scene:
                scene.frame_set(self._frame[0], subframe=self._frame[1])


def follow(scene: bpy.types.Scene, preview: bpy.types.Object, picture: int) -> None:
    """Go to the frame in which a preview shows a picture."""
    shown = Shown.read(preview.data)
    frame = shown.start + shown.step * picture
    scene.frame_set(int(np.floor(frame)), subframe=float(frame % 1.0))
