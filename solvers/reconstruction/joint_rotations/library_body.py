"""Fit the poses of a library to the body of the recorded actor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Single
from ...motion.humanoid import (
    CHEST,
    HIPS,
    N_JOINTS,
    PARENT_INDICES,
    POSTURE_JOINTS,
    SIDES,
    SPINE,
    positions_from_directions,
)
from ...rotations import cross, nearest_rotations

HEAD = POSTURE_JOINTS.index("head")
ARMS, LEGS, SHINS, TOES = (
    tuple(POSTURE_JOINTS.index(f"{side}{part}") for side in SIDES)
    for part in ("UpperArm", "UpperLeg", "Foot", "Toes")
)
CORRECTED_BONES = (SPINE, CHEST, HEAD, *ARMS, *LEGS, *TOES)
"""Bones whose directions differ between trackers in the same pose."""
HALF_WEIGHT_COUNT = 20.0
"""Number of observations at which a measured offset of bone axes gets half its weight. It
guards bones that are observed in a few frames only
(`test_bone_axis_corrections_recover_known_rotations`)."""


@dataclass(frozen=True, eq=False)
class BodyPostures:
    """The poses of a library with the recorded actor's bone lengths.

    Attributes
    ----------
    positions : float32, shape (n_postures, 20, 3), meters
        Relative to the hips.
    speeds : float32, shape (n_postures, 20, 3), meters per second
    lengths : shape (20,), meters
    twists : complex64, shape (n_postures, 4), optional
        Of upper arms and thighs (`LimbTwists.vectors`).
    """

    positions: Single
    speeds: Single
    lengths: Array
    twists: NDArray[np.complex64] | None = None


def build_body_postures(
    directions: Single, changes: Single, lengths: Array, corrections: Array | None = None
) -> BodyPostures:
    """Apply an actor's bone lengths and bone axis corrections to bone directions.

    Parameters
    ----------
    directions, changes : shape (n_postures, 20, 3)
    lengths : shape (20,), meters
    corrections : shape (20, 3, 3), optional
        Correction of each bone's direction, expressed in its frame (`bone_frames`).
    """
    if corrections is not None:
        directions, changes = directions.copy(), changes.copy()
        frames = bone_frames(positions_from_directions(directions.astype(np.float64), lengths))
        for bone in CORRECTED_BONES:
            frame = frames[bone].astype(np.float32)
            rotation = frame @ corrections[bone].astype(np.float32) @ frame.swapaxes(-1, -2)
            directions[:, bone] = np.einsum("nij,nj->ni", rotation, directions[:, bone])
            changes[:, bone] = np.einsum("nij,nj->ni", rotation, changes[:, bone])
    single = lengths.astype(np.float32)
    return BodyPostures(
        positions_from_directions(directions, single),
        positions_from_directions(changes, single),
        lengths,
    )


def bone_frames(postures: Array) -> dict[int, Array]:
    """Return the axes (columns) in which the direction of each corrected bone is expressed.

    For bones of the trunk: up from hips to chest, and left along the shoulders or the hips. For
    a foot: the axes of its shin. NaN where a joint is NaN. Each has the shape (n_frames, 3, 3),
    of postures (n_frames, 20, 3).
    """
    up = postures[:, CHEST] - postures[:, HIPS]
    across = {
        joints: postures[:, joints[0]] - postures[:, joints[1]] for joints in (ARMS, LEGS)
    }
    upper, lower = _axes(up, across[ARMS]), _axes(up, across[LEGS])
    frames = dict.fromkeys((CHEST, HEAD, *ARMS), upper)
    frames |= dict.fromkeys((SPINE, *LEGS), lower)
    for ankle, toes in zip(SHINS, TOES, strict=True):
        shin = postures[:, PARENT_INDICES[ankle]] - postures[:, ankle]
        frames[toes] = _axes(shin, across[LEGS])
    return frames


def bone_axis_corrections(
    observed: Array, reliability: Array, directions: Array, lengths: Array
) -> Array:
    """Return the rotations of the tracker's bone directions relative to the library's.

    Parameters
    ----------
    observed : shape (n_frames, 20, 3), meters
    reliability : shape (n_frames, 20)
    directions : shape (n_frames, 20, 3)
        Directions of the library pose that matches each observed pose.
    lengths : shape (20,), meters

    Returns
    -------
    shape (20, 3, 3)
        The best-fit rotations over all frames (Kabsch), regularized toward identity where
        observations are rare.
    """
    corrections = np.tile(np.eye(3), (N_JOINTS, 1, 1))
    observed_frames = bone_frames(observed)
    library_frames = bone_frames(positions_from_directions(directions, lengths))
    for bone in CORRECTED_BONES:
        above = PARENT_INDICES[bone]
        direction = observed[:, bone] - observed[:, above]
        size = np.linalg.norm(direction, axis=-1, keepdims=True)
        observed_local = np.einsum(
            "fji,fj->fi", observed_frames[bone], direction / np.maximum(size, 1e-6)
        )
        library_local = np.einsum("fji,fj->fi", library_frames[bone], directions[:, bone])
        weight = np.minimum(reliability[:, bone], reliability[:, above])
        is_known = np.isfinite(observed_local).all(axis=-1) & np.isfinite(library_local).all(
            axis=-1
        )
        weight = np.where(is_known, weight, 0.0)
        covariance = np.einsum(
            "f,fi,fj->ij", weight[is_known], observed_local[is_known], library_local[is_known]
        )
        corrections[bone], _ = nearest_rotations(covariance + HALF_WEIGHT_COUNT * np.eye(3))
    return corrections


def _axes(up: Array, left: Array) -> Array:
    """Right-handed axes as columns (left, back, up), shape (n, 3, 3)."""
    z = up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-6)
    y = cross(z, left)
    y /= np.maximum(np.linalg.norm(y, axis=-1, keepdims=True), 1e-6)
    return np.stack([cross(y, z), y, z], axis=-1)
