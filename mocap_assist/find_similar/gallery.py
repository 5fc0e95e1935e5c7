"""Layout of matches as a grid over a view, and their figures, as plain arrays."""

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion.humanoid import POSTURE_JOINTS
from ...solvers.pictures import ViewDirection, project_to_view
from ..overlays.pixel_drawing import Box
from .ghost import BONES
from .solve_finding import Found

CELL_PX, LABEL_PX, GAP_PX = 190, 34, 8
"""Size of the largest cell, height of its label, and distance between cells, in pixels at scale
1."""
MAX_CELLS = 24
"""Number of matches that are shown. It bounds the time of a drawing."""
FIGURE_HEIGHT_M, FLOOR_M = 2.3, 1.05
"""Height of a cell without its label: a standing body with a raised hand; and meters from the
floor to the hips."""
LEFT = np.array([POSTURE_JOINTS[joint].startswith("left") for _, joint in BONES])
"""Which of the bones are of the left arm and leg, shape (n_bones,)."""


def cells_in(space: Box, n_matches: int, scale: float) -> list[Box]:
    """Return a cell for each match that fits, row by row from the top left.

    All have the same size: the largest up to `CELL_PX` with which all matches fit.
    """
    n_cells = min(n_matches, MAX_CELLS)
    gap = GAP_PX * scale
    for n_columns in range(1, n_cells + 1):
        n_rows = -(-n_cells // n_columns)
        across = (space.width - gap) / n_columns - gap
        along = (space.height - gap) / n_rows - gap - LABEL_PX * scale
        size = min(across, along, CELL_PX * scale)
        if size >= min(across, CELL_PX * scale):  # the width limits it from here on
            break
    size, height = max(size, 1.0), max(size, 1.0) + LABEL_PX * scale
    top = space.y + space.height
    return [
        Box(
            space.x + gap + column * (size + gap),
            top - (row + 1) * (height + gap),
            size,
            height,
        )
        for row, column in (divmod(index, n_columns) for index in range(n_cells))
    ]


def cell_at(cells: list[Box], x: float, y: float) -> int:
    """Return the number of the cell at a point; -1 where there is none."""
    return next((index for index, cell in enumerate(cells) if cell.has(x, y)), -1)


def posture_row(found: Found, seconds: float | None) -> int:
    """Return the row of the posture that is shown after some seconds; the clip repeats.

    Without a time it is the key pose: in the middle half of the clip, since many clips begin
    and end in a pose for calibration, the posture that is the farthest from the mean.
    """
    n_postures = len(found.postures)
    if seconds is not None:
        return int(seconds * found.rate) % n_postures
    first = n_postures // 4
    middle = found.postures[first : max(n_postures - first, first + 1)]
    distances = np.linalg.norm(middle - middle.mean(axis=0), axis=2)
    return first + int(np.argmax(np.nansum(distances, axis=1)))


def figure_lines(found: Found, row: int, cell: Box) -> tuple[Array, NDArray[np.bool_]]:
    """Return the bones of a posture in a cell, in pixels, and which are left.

    Returns
    -------
    lines : shape (n_lines, 2, 2)
        Without what was not tracked.
    left : shape (n_lines,)
    """
    posture = np.asarray(found.postures[row : row + 1], np.float64)
    joints = project_to_view(posture, np.zeros(1), ViewDirection.QUARTER)[0, :, :2]
    label_height = cell.height - cell.width
    scale = cell.width / FIGURE_HEIGHT_M
    hips = cell.x + 0.5 * cell.width, cell.y + label_height + FLOOR_M * scale
    lines = (scale * joints + np.array(hips))[BONES]
    observed = np.isfinite(lines).all(axis=(1, 2))
    return lines[observed], LEFT[observed]
