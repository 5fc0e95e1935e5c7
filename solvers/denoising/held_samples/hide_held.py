"""Treat held samples as missing, and blend them with what was recorded."""

import numpy as np

from ...arrays import Array, Flags
from ...motion import Motion, Tracks
from ...rotations import slerp


def hide_held_samples(recording: Motion | Tracks, held: Flags) -> Motion | Tracks:
    """Return the recording with these samples missing.

    `held` is (n_frames, n_points), or (n_frames, n_joints + 1) with the root's position last.
    """
    if not held.any():
        return recording
    if isinstance(recording, Tracks):
        return recording.with_positions(np.where(held[..., None], np.nan, recording.positions))
    return recording.with_poses(
        np.where(held[:, :-1, None], np.nan, recording.rotations),
        np.where(held[:, -1:], np.nan, recording.root_positions),
    )


def held_joints(recording: Motion | Tracks, held: Flags) -> Flags:
    """Return the held samples of each joint or point, shape (n_frames, n_joints).

    `held` is what `find_held_samples` returns. The first joint's include the root's position.
    """
    if isinstance(recording, Tracks):
        return held
    joints = held[:, :-1].copy()
    joints[:, 0] |= held[:, -1]
    return joints


def describe_held_samples(held: Flags) -> str:
    """Return a sentence on held samples, (n_frames, n_parts); empty if there are none."""
    match int(held.any(axis=1).sum()):
        case 0:
            return ""
        case 1:
            return "In 1 frame the tracker repeated the frame before; this counts as a gap."
        case n_frames:
            return (
                f"In {n_frames} frames the tracker repeated earlier ones; these count as gaps."
            )


def restore_held_samples(
    recording: Motion | Tracks, cleaned: Motion | Tracks, held: Flags, weights: Array
) -> Motion | Tracks:
    """Return the cleaned recording, its held samples blended with what was recorded.

    `weights` are those of the recording, shape (n_joints,), 0 to 1; the position of the root
    has that of the first joint.
    """
    if not (held.any() and weights.any()):
        return cleaned
    if isinstance(recording, Motion) and isinstance(cleaned, Motion):
        turned = slerp(cleaned.rotations, recording.rotations, weights)
        moved = cleaned.root_positions + weights[0] * (
            recording.root_positions - cleaned.root_positions
        )
        return cleaned.with_poses(
            np.where(held[:, :-1, None], turned, cleaned.rotations),
            np.where(held[:, -1:], moved, cleaned.root_positions),
        )
    assert isinstance(recording, Tracks)
    assert isinstance(cleaned, Tracks)
    positions = cleaned.positions + weights[:, None] * (recording.positions - cleaned.positions)
    return cleaned.with_positions(np.where(held[..., None], positions, cleaned.positions))
