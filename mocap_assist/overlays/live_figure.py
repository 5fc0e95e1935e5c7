"""Live figure of the actor, drawn over the 3D View; the scene is not changed."""

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...solvers.motion import joint_parents
from ...solvers.recordings.streams import LiveFrame
from ..scene.units import unit_of
from .view_drawing import Color, ViewDrawing, draw_lines

MIN_CONFIDENCE = 0.25
"""Bones below this confidence are not drawn."""
ANKLE_HEIGHT_M = 0.05
"""Approximate height of the lowest joint over the ground."""


class LiveFigure:
    """Figure that stands at the world's origin in its first frame."""

    def __init__(self, color: Color, width: float) -> None:
        self._color, self._width = color, width
        self._frame: LiveFrame | None = None
        self._origin: NDArray[np.float64] | None = None
        self._drawing = ViewDrawing(self._draw)

    def show(self, frame: LiveFrame) -> None:
        """Draw this frame until the next call."""
        if self._origin is None and np.isfinite(frame.positions).any():
            middle = np.nanmean(frame.positions, axis=0)
            ground = np.nanmin(frame.positions[:, 2]) - ANKLE_HEIGHT_M
            self._origin = np.array([middle[0], middle[1], ground])
        self._frame = frame

    def lines(self) -> NDArray[np.float64]:
        """Return the observed bones, shape (n_bones, 2, 3), meters."""
        frame, origin = self._frame, self._origin
        if frame is None or origin is None:
            return np.zeros((0, 2, 3))
        parents = np.array(joint_parents(frame.names))
        ends = np.stack([frame.positions[parents], frame.positions], axis=1) - origin
        observed = np.isfinite(ends).all(axis=(1, 2)) & (frame.confidence >= MIN_CONFIDENCE)
        return np.asarray(ends[observed & (parents >= 0)])

    def remove(self) -> None:
        """Remove the figure; a second call has no effect."""
        self._drawing.close()

    def _draw(self, context: bpy.types.Context) -> None:
        lines = self.lines()
        if len(lines):
            in_units = Matrix.Scale(1.0 / unit_of(context.scene), 4)
            draw_lines(lines, in_units, self._color, self._width)
