"""A library's postures on the body of whoever was recorded."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import ABOVE, CHEST, HIPS, N_JOINTS, POSTURE_JOINTS, SPINE, along_bones

Array = NDArray[np.float64]
Single = NDArray[np.float32]

HEAD = POSTURE_JOINTS.index("head")
ARMS, LEGS, SHINS, TOES = (
    tuple(POSTURE_JOINTS.index(f"{side}{part}") for side in ("left", "right"))
    for part in ("UpperArm", "UpperLeg", "Foot", "Toes")
)
CORRECTED_BONES = (SPINE, CHEST, HEAD, *ARMS, *LEGS, *TOES)
"""Bones that lead elsewhere in each tracker's idea of a body, in the very same posture."""
HALF_WEIGHT_COUNT = 20.0
"""Sightings of a bone at which half of what they tell is believed."""


@dataclass(frozen=True, eq=False)
class BodyPostures:
    """The postures of a library, as the recorded actor would take them.

    Attributes
    ----------
    positions : float32, shape (n_postures, 20, 3), metres
        Relative to the hips.
    speeds : float32, shape (n_postures, 20, 3), metres per second
    lengths : shape (20,), metres
    twists : complex64, shape (n_postures, 4), optional
        Of upper arms and thighs (`LimbTwists.vectors`).
    """

    positions: Single
    speeds: Single
    lengths: Array
    twists: NDArray[np.complex64] | None = None


def build_body_postures(
    directions: Single, changes: Single, lengths: Array, turns: Array | None = None
) -> BodyPostures:
    """Give directions of bones the lengths and the anatomy of an actor.

    Parameters
    ----------
    directions, changes : shape (n_postures, 20, 3)
    lengths : shape (20,), metres
    turns : shape (20, 3, 3), optional
        How each bone's direction is turned in the frame that it is told in (`bone_frames`).
    """
    if turns is not None:
        directions, changes = directions.copy(), changes.copy()
        frames = bone_frames(along_bones(directions.astype(np.float64), lengths))
        for bone in CORRECTED_BONES:
            frame = frames[bone].astype(np.float32)
            turn = frame @ turns[bone].astype(np.float32) @ frame.swapaxes(-1, -2)
            directions[:, bone] = np.einsum("nij,nj->ni", turn, directions[:, bone])
            changes[:, bone] = np.einsum("nij,nj->ni", turn, changes[:, bone])
    single = lengths.astype(np.float32)
    return BodyPostures(along_bones(directions, single), along_bones(changes, single), lengths)


def bone_frames(postures: Array) -> dict[int, Array]:
    """Return the axes (columns) that the direction of each bone of `ANATOMY` is told in.

    Those of the trunk: up from hips to chest, and left along the shoulders or the hips; those
    of the shin for a foot. NaN where a joint is.
    """
    up = postures[:, CHEST] - postures[:, HIPS]
    across = {
        joints: postures[:, joints[0]] - postures[:, joints[1]] for joints in (ARMS, LEGS)
    }
    upper, lower = _axes(up, across[ARMS]), _axes(up, across[LEGS])
    frames = dict.fromkeys((CHEST, HEAD, *ARMS), upper)
    frames |= dict.fromkeys((SPINE, *LEGS), lower)
    for ankle, toes in zip(SHINS, TOES, strict=True):
        shin = postures[:, ABOVE[ankle]] - postures[:, ankle]
        frames[toes] = _axes(shin, across[LEGS])
    return frames


def bone_axis_corrections(
    observed: Array, trust: Array, directions: Array, lengths: Array
) -> Array:
    """Return how the bones of the tracker lie differently from those of the library.

    Parameters
    ----------
    observed : shape (n_frames, 20, 3), metres
    trust : shape (n_frames, 20)
    directions : shape (n_frames, 20, 3)
        Of a posture of the library that is like each observed one.
    lengths : shape (20,), metres

    Returns
    -------
    shape (20, 3, 3)
        The rotation that lays one onto the other best, all frames together (Kabsch), drawn to
        none where little was seen.
    """
    turns = np.tile(np.eye(3), (N_JOINTS, 1, 1))
    seen = bone_frames(observed)
    known = bone_frames(along_bones(directions, lengths))
    for bone in CORRECTED_BONES:
        above = ABOVE[bone]
        way = observed[:, bone] - observed[:, above]
        size = np.linalg.norm(way, axis=-1, keepdims=True)
        told = np.einsum("fji,fj->fi", seen[bone], way / np.maximum(size, 1e-6))
        usual = np.einsum("fji,fj->fi", known[bone], directions[:, bone])
        weight = np.minimum(trust[:, bone], trust[:, above])
        good = np.isfinite(told).all(axis=-1) & np.isfinite(usual).all(axis=-1)
        weight = np.where(good, weight, 0.0)
        both = np.einsum("f,fi,fj->ij", weight[good], told[good], usual[good])
        u, _, v = np.linalg.svd(both + HALF_WEIGHT_COUNT * np.eye(3))
        flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))])
        turns[bone] = u @ flip @ v
    return turns


def _axes(up: Array, left: Array) -> Array:
    """Right-handed axes as columns (left, back, up), shape (n, 3, 3)."""
    z = up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-6)
    y = np.cross(z, left)
    y /= np.maximum(np.linalg.norm(y, axis=-1, keepdims=True), 1e-6)
    return np.stack([np.cross(y, z), y, z], axis=-1)
