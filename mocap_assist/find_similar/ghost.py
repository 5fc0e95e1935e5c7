"""The ghost: a match as a stick figure in time with the query. Knows nothing of Blender."""

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion.humanoid import PARENTS, resize_postures, rotate_about_vertical
from .solve_finding import Found, QueryPath

BONES = np.array([(parent, joint) for joint, parent in enumerate(PARENTS) if parent >= 0])


def ghost_lines(stage: QueryPath, found: Found, query_frame: float) -> Array:
    """Return the lines of the clip's posture at a frame of the query, at the query's position
    and size.

    Parameters
    ----------
    stage : QueryPath
    found : Found
    query_frame : float
        It stands still before the first and after the last one.

    Returns
    -------
    shape (n_lines, 2, 3), meters
        Without what was not tracked.
    """
    posture = _posture_at(found, clip_frame(found, query_frame))
    row = int(np.clip(round(query_frame), 0, len(stage.positions) - 1))
    heading = np.array([stage.headings[row]])
    body = resize_postures(posture[None], stage.lengths)
    joints = rotate_about_vertical(body, heading)[0] + stage.positions[row]
    lines: Array = joints[BONES]
    observed: NDArray[np.bool_] = np.isfinite(lines).all(axis=(1, 2))
    return lines[observed]


def clip_frame(found: Found, query_frame: float) -> float:
    """Return the frame of the clip that belongs to a frame of the query.

    Where the clip runs on while the query waits, it is the middle of what it does meanwhile.
    """
    ours, where, counts = np.unique(found.pairs[:, 0], return_inverse=True, return_counts=True)
    sums = np.bincount(where.reshape(-1), weights=found.pairs[:, 1])
    return float(np.interp(query_frame, ours, sums / counts))


def _posture_at(found: Found, frame: float) -> Array:
    """Return the joints between two of the postures that are known, shape (20, 3)."""
    first = int(found.match.frames.start * found.rate / found.entry.frame_rate)
    row_position = frame * found.rate / found.entry.frame_rate - first
    row_position = float(np.clip(row_position, 0.0, len(found.postures) - 1.0))
    before = int(row_position)
    after = min(before + 1, len(found.postures) - 1)
    fraction = row_position - before
    return np.asarray(
        (1.0 - fraction) * found.postures[before] + fraction * found.postures[after], np.float64
    )
