"""Thumbnails of clips: a few figures side by side on a square card."""

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion.humanoid import PARENTS, POSTURE_JOINTS
from ...solvers.pictures import SERIES, Canvas, ViewDirection, lighten_color, project_to_view

Pixels = NDArray[np.uint8]

SIZE = 128
"""Pixels of a side: what Blender keeps of an asset's preview."""
N_FIGURES = 3
MARGIN = 6.0
TALL = 2.3
"""Meters that a card is high: a standing body with a raised hand."""
FOOT = 1.05
"""Meters from the middle of the card's body, the hips, down to the floor."""
LEFT = np.array([name.startswith("left") for name in POSTURE_JOINTS])


def thumbnail(postures: Array) -> Pixels:
    """Draw postures at evenly spaced moments, shape (128, 128, 3).

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
        Relative to the hips, facing -Y; NaN where not tracked.
    """
    canvas = Canvas(SIZE, SIZE)
    moments = np.linspace(0, len(postures) - 1, 2 * N_FIGURES + 1).round().astype(int)[1::2]
    scale = (SIZE - 2.0 * MARGIN) / TALL
    figures = project_to_view(postures[moments], np.zeros(len(moments)), ViewDirection.QUARTER)
    color = SERIES[1]
    for index, figure in enumerate(figures):
        middle = SIZE * (index + 0.5) / N_FIGURES
        points_2d = figure[:, :2] * (scale, -scale) + (middle, SIZE - MARGIN - FOOT * scale)
        for joint, parent in enumerate(PARENTS):
            if parent >= 0:
                shade = lighten_color(color, 0.5) if LEFT[joint] else color
                canvas.line(points_2d[[parent, joint]], shade, 2.0)
        canvas.dot(points_2d[POSTURE_JOINTS.index("head")], color, 4.0)
    return canvas.picture().pixels
