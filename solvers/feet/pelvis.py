"""The surface of the pelvis, on which a body sits or lies."""

import numpy as np

from ..motion import Skeleton
from ..motion.humanoid import HUMAN_LEG_LENGTH_M, HumanoidMap, leg_length
from ..motion_fitting.goals import BonePoint

SURFACE_M = (
    (0.06, 0.02, -0.09), (0.05, 0.12, 0.08), (0.16, 0.02, 0.0), (0.12, -0.06, 0.08),
)  # fmt: skip
"""Meters, for a leg of 0.9 m, of the left half of a pelvis from the middle of the hip joints,
to the left, back and up: seat bone, sacrum, trochanter and the spine of the ilium. Heights and
depths of the second and the last: Harrington et al. (2007). Prediction of the hip joint centre.
Journal of Biomechanics 40. doi:10.1016/j.jbiomech.2006.02.003. Others chosen by hand."""


def pelvis_points(skeleton: Skeleton, humanoid: HumanoidMap) -> tuple[BonePoint, ...]:
    """Return points on the surface of the pelvis, if hips, both legs and head are known.

    A body that sits, lies on its back, a side or its front rests on some of them.
    """
    joints = humanoid.indices(skeleton)
    roles = ("hips", "leftUpperLeg", "rightUpperLeg", "head")
    if any(role not in joints for role in roles):
        return ()
    hips, left, right, head = (joints[role] for role in roles)
    rest = skeleton.rest_positions
    middle, to_left = (rest[left] + rest[right]) / 2.0, rest[left] - rest[right]
    up = rest[head] - middle
    back = np.cross(up, to_left)
    up = np.cross(to_left, back)
    lengths = np.array([np.linalg.norm(axis) for axis in (to_left, back, up)])
    if not lengths.all():
        return ()
    axes = np.array([to_left, back, up]) / lengths[:, None]
    size = leg_length(skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    both_sides = [(sign * x, y, z) for x, y, z in SURFACE_M for sign in (1.0, -1.0)]
    offsets = size * np.array(both_sides) @ axes + middle - rest[hips]
    return tuple(BonePoint(hips, offset) for offset in offsets)
