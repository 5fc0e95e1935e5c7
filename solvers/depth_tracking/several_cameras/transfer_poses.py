"""Express the poses of one camera in the frame and at the frames of another."""

import numpy as np

from ...arrays import Array
from ..body import COORDINATES, N_ROOT, BodyModel, segment_frames

_ROTATIONS = slice(3, N_ROOT)
_YAW, _ROLL, _PITCH = (COORDINATES.index(name) for name in ("yaw", "roll", "pitch"))


def transfer_poses(body: BodyModel, poses: Array, transform: Array) -> Array:
    """Return poses (n_frames, 36) in another frame.

    Only position and rotation of the hips change: yaw about y, then roll about z, then pitch
    about x. Rotations continue from frame to frame.

    Parameters
    ----------
    body : BodyModel
    poses : shape (n_frames, 36)
    transform : shape (4, 4)
        From the frame of the poses to the other one, meters.
    """
    roots = transform @ segment_frames(body, poses)[:, 0]
    moved = poses.copy()
    moved[:, :3] = roots[:, :3, 3]
    moved[:, _YAW] = np.arctan2(-roots[:, 2, 0], roots[:, 0, 0])
    moved[:, _ROLL] = np.arcsin(np.clip(roots[:, 1, 0], -1.0, 1.0))
    moved[:, _PITCH] = np.arctan2(-roots[:, 1, 2], roots[:, 1, 1])
    return continued(moved)


def poses_at(poses: Array, frames: Array) -> Array:
    """Return poses (n, 36) between frames, linearly interpolated; NaN outside of the take.

    Parameters
    ----------
    poses : shape (n_frames, 36)
    frames : shape (n,)
        Frames, also fractions.
    """
    last = len(poses) - 1
    before = np.clip(np.floor(frames).astype(np.intp), 0, last)
    after = np.minimum(before + 1, last)
    fraction = (frames - before)[:, np.newaxis]
    found = (1.0 - fraction) * poses[before] + fraction * poses[after]
    outside = (frames < 0.0) | (frames > last)
    return np.where(outside[:, np.newaxis], np.nan, found)


def continued(poses: Array) -> Array:
    """Return poses (n_frames, 36) whose rotations of the hips continue from frame to frame."""
    unwrapped = poses.copy()
    unwrapped[:, _ROTATIONS] = np.unwrap(poses[:, _ROTATIONS], axis=0)
    return unwrapped


def continued_rotations(poses: Array, reference: Array) -> Array:
    """Return poses with multiples of 360 degrees added, so that yaw and pitch are near others.

    Parameters
    ----------
    poses, reference : shape (..., 36)
    """
    near = poses.copy()
    for index in (_YAW, _PITCH):
        turns = np.round((reference[..., index] - poses[..., index]) / (2.0 * np.pi))
        near[..., index] += 2.0 * np.pi * np.nan_to_num(turns)
    return near
