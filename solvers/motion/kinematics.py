"""Where the joints of a motion are in the world."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .motion import Motion
from .rotations import multiply, rotate
from .skeleton import Skeleton


class WorldPoses(NamedTuple):
    """Every joint in the world."""

    rotations: NDArray[np.float64]
    """Unit quaternions w x y z, rest pose to world, shape (n_frames, n_joints, 4)."""
    positions: NDArray[np.float64]
    """Rotation centres, shape (n_frames, n_joints, 3), metres."""


def forward_kinematics(motion: Motion) -> WorldPoses:
    """Return world rotations and positions of all joints and frames; NaN spreads downwards."""
    return world_poses(motion.skeleton, motion.rotations, motion.root_positions)


def world_poses(
    skeleton: Skeleton,
    rotations: NDArray[np.float64],
    root_positions: NDArray[np.float64],
) -> WorldPoses:
    """Forward kinematics of bare arrays.

    Parameters
    ----------
    skeleton : Skeleton
    rotations : shape (..., n_joints, 4)
        Local unit quaternions w x y z.
    root_positions : shape (..., 3), metres

    Returns
    -------
    WorldPoses
        Arrays of shape (..., n_joints, 4) and (..., n_joints, 3).
    """
    world = np.empty_like(rotations)
    positions = np.empty((*rotations.shape[:-1], 3))
    world[..., 0, :] = rotations[..., 0, :]
    positions[..., 0, :] = root_positions
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        world[..., joint, :] = multiply(world[..., parent, :], rotations[..., joint, :])
        arm = rotate(world[..., parent, :], skeleton.offsets[joint])
        positions[..., joint, :] = positions[..., parent, :] + arm
    return WorldPoses(world, positions)


def local_rotations(
    skeleton: Skeleton, world_rotations: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return local rotations from world ones, both (..., n_joints, 4): undoes `world_poses`."""
    local = np.array(world_rotations, dtype=np.float64)
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        up = world_rotations[..., parent, :] * (1.0, -1.0, -1.0, -1.0)
        local[..., joint, :] = multiply(up, world_rotations[..., joint, :])
    return local
