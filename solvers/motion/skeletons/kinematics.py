"""Forward kinematics: positions and rotations of joints in world space."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...rotations import inverse, multiply, multiply_components, rotate_components
from .motion import Motion
from .skeleton import Skeleton


class WorldPoses(NamedTuple):
    """World-space poses of all joints."""

    rotations: NDArray[np.float64]
    """Unit quaternions w x y z, rest pose to world, shape (n_frames, n_joints, 4)."""
    positions: NDArray[np.float64]
    """Joint centers, shape (n_frames, n_joints, 3), meters."""


def forward_kinematics(motion: Motion) -> WorldPoses:
    """Return world rotations and positions of all joints; NaN propagates to descendants."""
    return world_poses(motion.skeleton, motion.rotations, motion.root_positions)


def world_poses(
    skeleton: Skeleton,
    rotations: NDArray[np.float64],
    root_positions: NDArray[np.float64],
) -> WorldPoses:
    """Compute forward kinematics from arrays.

    Parameters
    ----------
    skeleton : Skeleton
    rotations : shape (..., n_joints, 4)
        Local unit quaternions w x y z.
    root_positions : shape (..., 3), meters

    Returns
    -------
    WorldPoses
        Arrays of shape (..., n_joints, 4) and (..., n_joints, 3).
    """
    if rotations[..., 0, 0].size == 1:
        return _world_pose(skeleton, rotations, root_positions)
    # Components come first and frames last here, so that each step runs over complete arrays.
    local = np.ascontiguousarray(
        np.moveaxis(rotations.reshape(-1, *rotations.shape[-2:]), 0, -1)
    )
    world = np.empty_like(local)
    positions = np.empty((local.shape[0], 3, local.shape[2]))
    world[0] = local[0]
    positions[0] = root_positions.reshape(-1, 3).T
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        world[joint] = multiply_components(world[parent], local[joint])
        positions[joint] = rotate_components(world[parent], skeleton.offsets[joint])
        positions[joint] += positions[parent]
    return WorldPoses(
        np.moveaxis(world, -1, 0).reshape(rotations.shape),
        np.moveaxis(positions, -1, 0).reshape(*rotations.shape[:-1], 3),
    )


def _world_pose(
    skeleton: Skeleton,
    rotations: NDArray[np.float64],
    root_position: NDArray[np.float64],
) -> WorldPoses:
    """Compute one pose with plain numbers, in a tenth of the time of arrays of one number."""
    local = rotations.reshape(-1, 4).tolist()
    world, positions = local[:1], [root_position.ravel().tolist()]
    offsets = skeleton.offsets.tolist()
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        world.append(multiply_components(world[parent], local[joint]))
        x, y, z = rotate_components(world[parent], offsets[joint])
        above = positions[parent]
        positions.append([x + above[0], y + above[1], z + above[2]])
    return WorldPoses(
        np.array(world).reshape(rotations.shape),
        np.array(positions).reshape(*rotations.shape[:-1], 3),
    )


def local_rotations(
    skeleton: Skeleton, world_rotations: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the local rotations of world ones, (..., n_joints, 4); see `world_poses`."""
    local = np.array(world_rotations, dtype=np.float64)
    parents = local[..., list(skeleton.parents[1:]), :]
    local[..., 1:, :] = multiply(inverse(parents), local[..., 1:, :])
    return local
