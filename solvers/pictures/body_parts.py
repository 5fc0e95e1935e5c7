"""Find the parts of a body that figures show in their own way: left limbs and the head."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton

MIN_SIDE_OFFSET = 0.02
"""Joints farther than this fraction of the stature from the median plane belong to a side."""
MIN_BODY_JOINTS = 15
"""A skeleton with at least as many joints counts as a body, and gets a head."""


def left_joints(skeleton: Skeleton, roles: Mapping[str, int]) -> NDArray[np.bool_]:
    """Return whether joints, (n_joints,), are of left limbs; by the rest pose if of no body.

    Parameters
    ----------
    skeleton : Skeleton
    roles : index of each humanoid role
    """
    limbs = {joint: role for role, joint in roles.items()}
    if not any(role.startswith("left") for role in limbs.values()):
        return np.asarray(skeleton.rest_positions[:, 0] > MIN_SIDE_OFFSET * skeleton.extent)
    is_left = np.zeros(skeleton.n_joints, dtype=np.bool_)
    for joint, parent in enumerate(skeleton.parents):
        inherited = parent >= 0 and bool(is_left[parent])
        is_left[joint] = limbs[joint].startswith("left") if joint in limbs else inherited
    return is_left


def head_bone(skeleton: Skeleton, roles: Mapping[str, int]) -> tuple[int, int] | None:
    """Return both ends of the head, or of the highest bone of an unknown body.

    None for few joints, which do not form a body.
    """
    if "head" in roles:
        head, lengths = roles["head"], np.linalg.norm(skeleton.offsets, axis=1)
        below = [joint for joint, parent in enumerate(skeleton.parents) if parent == head]
        return max(below, key=lambda joint: float(lengths[joint]), default=head), head
    if skeleton.n_joints < MIN_BODY_JOINTS:
        return None
    top = int(np.argmax(skeleton.rest_positions[:, 2]))
    return top, skeleton.parents[top]
