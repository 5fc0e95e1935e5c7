"""Relate a cleaned recording to the observed samples of its joints or points."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import Motion, Tracks
from .channels import Channels


def observed_mask(recording: Motion | Tracks) -> NDArray[np.bool_]:
    """Return where each joint or point was observed, shape (n_frames, n_joints)."""
    return recording.observed if isinstance(recording, Motion) else recording.visible


def restore_observed(
    recording: Motion | Tracks, cleaned: Motion | Tracks, joints: NDArray[np.bool_]
) -> Motion | Tracks:
    """Return the cleaned recording with the observed samples of some joints or points.

    They are the recording's to the last bit. `joints` has the shape (n_joints,); the path of
    the root belongs to the first joint.
    """
    if not joints.any():
        return cleaned
    if isinstance(recording, Motion) and isinstance(cleaned, Motion):
        rotations, roots = recording.rotations, recording.root_positions
        return recording.with_poses(
            np.where(np.isfinite(rotations) & joints[:, None], rotations, cleaned.rotations),
            np.where(np.isfinite(roots) & joints[0], roots, cleaned.root_positions),
        )
    assert isinstance(recording, Tracks)
    assert isinstance(cleaned, Tracks)
    positions = recording.positions
    return recording.with_positions(
        np.where(np.isfinite(positions) & joints[:, None], positions, cleaned.positions)
    )


def max_per_joint(
    recording: Motion | Tracks, channels: Channels, values: NDArray[np.generic]
) -> Array:
    """Return the maximum over each joint's channels, shape (n_frames, n_joints)."""
    per_part = values.reshape(channels.values.shape).max(axis=2)
    result = np.zeros(observed_mask(recording).shape)
    for part, joint in enumerate(channels.joints):
        result[:, joint] = np.maximum(result[:, joint], per_part[:, part])
    return result
