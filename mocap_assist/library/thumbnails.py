"""Thumbnails of clips: a few figures side by side on a square card."""

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion.humanoid import PARENTS, POSTURE_JOINTS
from ...solvers.pictures import SERIES, Canvas, ViewDirection, lighten_color, project_to_view

Pixels = NDArray[np.uint8]

CARD_SIZE_PX = 128
"""Pixels per side: the size in which Blender stores an asset's preview."""
N_FIGURES = 3
MARGIN_PX = 6.0
"""Pixels between the figures and the border of the card."""
CARD_HEIGHT_M = 2.3
"""Height of a card in meters: a standing body with a raised hand."""
FLOOR_DISTANCE_M = 1.05
"""Meters from the hips, the origin of each figure, down to the floor."""
LEFT = np.array([name.startswith("left") for name in POSTURE_JOINTS])


def thumbnail(postures: Array) -> Pixels:
    """Draw postures at evenly spaced moments, shape (128, 128, 3).

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
        Relative to the hips, facing -Y; NaN where not tracked.
    """
    canvas = Canvas(CARD_SIZE_PX, CARD_SIZE_PX)
    frames = np.linspace(0, len(postures) - 1, 2 * N_FIGURES + 1).round().astype(int)[1::2]
    scale = (CARD_SIZE_PX - 2.0 * MARGIN_PX) / CARD_HEIGHT_M
    figures = project_to_view(postures[frames], np.zeros(len(frames)), ViewDirection.QUARTER)
    color = SERIES[1]
    for index, figure in enumerate(figures):
        middle = CARD_SIZE_PX * (index + 0.5) / N_FIGURES
        points_2d = figure[:, :2] * (scale, -scale) + (
            middle,
            CARD_SIZE_PX - MARGIN_PX - FLOOR_DISTANCE_M * scale,
        )
        for joint, parent in enumerate(PARENTS):
            if parent >= 0:
                shade = lighten_color(color, 0.5) if LEFT[joint] else color
                canvas.line(points_2d[[parent, joint]], shade, 2.0)
        canvas.dot(points_2d[POSTURE_JOINTS.index("head")], color, 4.0)
    return canvas.picture().pixels
