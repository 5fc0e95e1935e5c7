"""Tell of which joints a frame's markers say something."""

import numpy as np
from numpy.typing import NDArray

from .body import Body, Poses
from .fit_poses import wrong_by

Array = NDArray[np.float64]
FRAMES_AT_ONCE = 256
UNSURE = 0.8
"""Radians: the standard deviation from which on a joint's rotation is not known."""
LOST = 0.05
"""Metres, likewise of the hips' position."""
TINY = 1e-9


def known_joints(body: Body, seen: Array, poses: Poses) -> NDArray[np.bool_]:
    """Return whether each joint is known in each frame, shape (n_frames, n_joints).

    A joint is known where a marker on its bone or below is seen, and where the markers, with
    what joints usually do, leave little room for other rotations. Joints that never turn go
    with their parents.
    """
    known = np.zeros(poses.turns.shape[:2], dtype=bool)
    there = np.isfinite(seen).all(axis=-1)
    for joint in range(len(body.joints)):
        below = [
            marker for marker, bone in enumerate(body.bones) if joint in body.path(int(bone))
        ]
        known[:, joint] = there[:, below].any(axis=1)
    for start in range(0, len(seen), FRAMES_AT_ONCE):
        some = slice(start, start + FRAMES_AT_ONCE)
        spread = _spread(body, seen[some], Poses(poses.turns[some], poses.roots[some]))
        known[some, body.turning] &= spread[:, 1:] < UNSURE
        known[some, 0] &= spread[:, 0] < LOST
    for joint, parent in enumerate(body.parents):
        if not body.joints[joint].turns:
            known[:, joint] = known[:, parent]
    return known


def _spread(body: Body, seen: Array, poses: Poses) -> Array:
    """Return standard deviations of the root's place, metres, and of all turns, radians.

    Shape (n_frames, 1 + n_turning_joints); of three coordinates the least known counts.
    """
    slopes = wrong_by(body, seen, poses).slopes
    normal = np.swapaxes(slopes, 1, 2) @ slopes
    np.einsum("fuu->fu", normal)[:] += TINY
    variance = np.einsum("fuu->fu", np.linalg.inv(normal)).clip(min=0.0)
    return np.asarray(np.sqrt(variance.reshape(len(seen), -1, 3).max(axis=-1)))
