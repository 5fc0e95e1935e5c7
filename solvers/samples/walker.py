"""Define the skeleton of the built-in sample: an adult of 1.79 m in T-pose, facing -Y."""

import numpy as np

from ..motion import Skeleton

# Name, parent, offset in meters. The left side is +X; sides are added below.
TRUNK_JOINTS = (
    ("Hips", "", (0.0, 0.0, 0.96)),
    ("Spine", "Hips", (0.0, 0.01, 0.10)),
    ("Spine1", "Spine", (0.0, 0.01, 0.12)),
    ("Spine2", "Spine1", (0.0, 0.0, 0.13)),
    ("Neck", "Spine2", (0.0, 0.0, 0.20)),
    ("Head", "Neck", (0.0, -0.02, 0.10)),
    ("Head_end", "Head", (0.0, 0.0, 0.18)),
)
SIDE_JOINTS = (
    ("Shoulder", "Spine2", (0.04, -0.01, 0.15)),
    ("Arm", "Shoulder", (0.14, 0.0, 0.0)),
    ("ForeArm", "Arm", (0.28, 0.0, 0.0)),
    ("Hand", "ForeArm", (0.25, 0.0, 0.0)),
    ("Hand_end", "Hand", (0.17, 0.0, 0.0)),
    ("UpLeg", "Hips", (0.09, 0.0, -0.05)),
    ("Leg", "UpLeg", (0.0, 0.0, -0.43)),
    ("Foot", "Leg", (0.0, 0.0, -0.40)),
    ("ToeBase", "Foot", (0.0, -0.14, -0.06)),
    ("ToeBase_end", "ToeBase", (0.0, -0.065, 0.0)),
)
ANKLE_HEIGHT_M = 0.08
"""Height of the ankle above the sole in the T-pose."""


def walker_skeleton() -> Skeleton:
    """Return 22 joints and 5 end sites with the names that most capture software uses."""
    trunk = {name for name, _, _ in TRUNK_JOINTS}
    rows = list(TRUNK_JOINTS)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for name, parent, (x, y, z) in SIDE_JOINTS:
            parent_name = parent if parent in trunk else side + parent
            rows.append((side + name, parent_name, (sign * x, y, z)))
    names = tuple(name for name, _, _ in rows)
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _ in rows)
    return Skeleton(names, parents, np.array([offset for _, _, offset in rows]))
