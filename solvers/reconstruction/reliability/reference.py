"""How long the segments of a body are, from frames that can be trusted."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import joints_of_names
from .terms import vector_lengths

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

OUT, DOWN = (1.0, 0.0), (0.0, -1.0)
ARMS = (("UpperArm", "LowerArm"), ("LowerArm", "Hand"))
LEGS = (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"))
MAX_ANGLE_DEG = 30.0
"""Degrees that each limb may be off a reference posture."""
MIN_FRAMES = 5
"""Frames; fewer tell no length."""
MIN_RELIABILITY = 0.6


def parent_distances(positions: Array, parents: NDArray[np.intp]) -> Array:
    """Return how far each joint is from its parent, (n_frames, n_joints); NaN for roots."""
    lengths = vector_lengths(positions - positions[:, np.maximum(parents, 0)])
    return np.where(parents >= 0, lengths, np.nan)


def reference_lengths(lengths: Array, postures: Flags, trust: Array) -> Array:
    """Return the length that each segment should have, shape (n_joints,), metres.

    The median over reference postures; where these are few, over frames in which the segment is
    reliable; where these are few too, over all.

    Parameters
    ----------
    lengths : shape (n_frames, n_joints), metres
    postures : shape (n_frames,)
        Frames in which the body is in a reference posture.
    trust : shape (n_frames, n_joints)
        How far each segment can be trusted without knowing its length.
    """
    chosen = np.broadcast_to(postures[:, None], lengths.shape) & (trust > MIN_RELIABILITY)
    for wider in (trust > MIN_RELIABILITY, np.ones_like(chosen)):
        few = (chosen & np.isfinite(lengths)).sum(axis=0) < MIN_FRAMES
        chosen = np.where(few, wider, chosen)
    reference = np.full(lengths.shape[1], np.nan)
    given = np.where(chosen, lengths, np.nan)
    seen = np.isfinite(given).any(axis=0)
    reference[seen] = np.nanmedian(given[:, seen], axis=0)
    return reference


def find_reference_postures(names: Sequence[str], positions: Array, tracked: Flags) -> Flags:
    """Tell in which frames a body stands with arms down, or in a T-pose [SHJT13, IV-B].

    Limbs are compared in the plane of the body, whose up is the way from the hips to between
    the shoulders: neither heading nor a tilted camera counts. All joints must be tracked.

    Parameters
    ----------
    names : of the joints
    positions : shape (n_frames, n_joints, 3), metres
    tracked : shape (n_frames, n_joints)
    """
    places = joints_of_names(names)
    needed = {"hips", "chest"} | {
        f"{side}{part}"
        for side in ("left", "right")
        for bone in (*ARMS, *LEGS)
        for part in bone
    }
    if not needed <= places.keys():
        return np.zeros(len(positions), bool)
    body = {role: positions[:, place] for role, place in places.items()}
    up = _unit_vectors(body["chest"] - body["hips"])
    left = body["leftUpperArm"] - body["rightUpperArm"]
    left = _unit_vectors(left - (left * up).sum(axis=-1, keepdims=True) * up)
    standing = _matches_posture(body, up, left, DOWN)
    t_pose = _matches_posture(body, up, left, OUT)
    return np.asarray((standing | t_pose) & tracked.all(axis=1))


def _matches_posture(
    body: dict[str, Array], up: Array, left: Array, arms: tuple[float, float]
) -> Flags:
    """Tell in which frames all limbs go the way they should: legs down, arms as told."""
    similar = np.ones(len(up), bool)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for bones, (out, rise) in ((ARMS, arms), (LEGS, DOWN)):
            way = sign * out * left + rise * up
            for start, stop in bones:
                bone = _unit_vectors(body[side + stop] - body[side + start])
                similar &= (bone * way).sum(axis=-1) > np.cos(np.radians(MAX_ANGLE_DEG))
    return similar


def _unit_vectors(vectors: Array) -> Array:
    lengths = vector_lengths(vectors)[:, None]
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, np.nan))
