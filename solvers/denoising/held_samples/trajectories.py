"""Joints and points as curves whose distances can be compared."""

import numpy as np

from ...arrays import Array
from ...motion import Motion, Tracks
from ...rotations import unroll

METERS_PER_RADIAN = 0.3
"""Displacement in meters that counts like a rotation by one radian. Chosen by hand: 0.3 m is
the length of a limb's bone, so that both move its end as far."""


def part_trajectories(recording: Motion | Tracks) -> Array:
    """Return rotations and positions whose distances are radians, (n_frames, n_parts, 3 or 4).

    The last part of a motion is the position of its root. NaN where missing.
    """
    if isinstance(recording, Tracks):
        return recording.positions / METERS_PER_RADIAN
    root = np.pad(recording.root_positions / METERS_PER_RADIAN, ((0, 0), (0, 1)))
    # Twice the quaternion: the distance of neighbors is then their angle in radians.
    return np.concatenate([2.0 * unroll(recording.rotations), root[:, None]], axis=1)
