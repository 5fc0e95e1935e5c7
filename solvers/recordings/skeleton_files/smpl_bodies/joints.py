"""The joints of SMPL, SMPL-H and SMPL-X, and an adult's bones for them.

The licensed body models are neither read nor shipped. Their parameter files hold rotations,
which are exact, and the shape of the actor, which only the models can turn into bones. The
bones here are those of an adult of 1.75 m by Drillis and Contini (1966), scaled to a height.
"""

import numpy as np
from numpy.typing import NDArray

from ....motion.humanoid import ADULT_STATURE_M

FINGERS = ("index", "middle", "pinky", "ring", "thumb")

BODY: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("pelvis", "", (0.0, 0.96, 0.0)),
    ("left_hip", "pelvis", (0.09, -0.07, 0.0)),
    ("right_hip", "pelvis", (-0.09, -0.07, 0.0)),
    ("spine1", "pelvis", (0.0, 0.11, -0.02)),
    ("left_knee", "left_hip", (0.0, -0.42, 0.0)),
    ("right_knee", "right_hip", (0.0, -0.42, 0.0)),
    ("spine2", "spine1", (0.0, 0.13, 0.0)),
    ("left_ankle", "left_knee", (0.0, -0.40, -0.02)),
    ("right_ankle", "right_knee", (0.0, -0.40, -0.02)),
    ("spine3", "spine2", (0.0, 0.06, 0.02)),
    ("left_foot", "left_ankle", (0.0, -0.05, 0.13)),
    ("right_foot", "right_ankle", (0.0, -0.05, 0.13)),
    ("neck", "spine3", (0.0, 0.21, -0.03)),
    ("left_collar", "spine3", (0.07, 0.11, -0.02)),
    ("right_collar", "spine3", (-0.07, 0.11, -0.02)),
    ("head", "neck", (0.0, 0.09, 0.04)),
    ("left_shoulder", "left_collar", (0.11, 0.04, -0.01)),
    ("right_shoulder", "right_collar", (-0.11, 0.04, -0.01)),
    ("left_elbow", "left_shoulder", (0.28, 0.0, 0.0)),
    ("right_elbow", "right_shoulder", (-0.28, 0.0, 0.0)),
    ("left_wrist", "left_elbow", (0.25, 0.0, 0.0)),
    ("right_wrist", "right_elbow", (-0.25, 0.0, 0.0)),
)
"""Name, parent and offset of the 22 joints that all models share, in their order: meters, Y up,
facing +Z, in the T-pose that they call zero."""

_KNUCKLES = {
    "index": ((0.1, 0.0, 0.025), (0.035, 0.0, 0.0), (0.022, 0.0, 0.0)),
    "middle": ((0.1, 0.0, 0.0), (0.04, 0.0, 0.0), (0.025, 0.0, 0.0)),
    "pinky": ((0.085, 0.0, -0.045), (0.025, 0.0, 0.0), (0.018, 0.0, 0.0)),
    "ring": ((0.095, 0.0, -0.022), (0.035, 0.0, 0.0), (0.023, 0.0, 0.0)),
    "thumb": ((0.03, -0.01, 0.03), (0.03, 0.0, 0.025), (0.025, 0.0, 0.015)),
}


def smpl_joints(
    hands: bool, height: float = ADULT_STATURE_M
) -> tuple[tuple[str, ...], tuple[int, ...], NDArray[np.float64]]:
    """Return names, parents and offsets, shape (n_joints, 3), of a body in meters, Y up."""
    rows = list(BODY)
    for side, sign in (("left", 1.0), ("right", -1.0)) if hands else ():
        for finger in FINGERS:
            parent = f"{side}_wrist"
            for number, (x, y, z) in enumerate(_KNUCKLES[finger], start=1):
                name = f"{side}_{finger}{number}"
                rows.append((name, parent, (sign * x, y, z)))
                parent = name
    names = tuple(name for name, _, _ in rows)
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _ in rows)
    offsets = np.array([offset for _, _, offset in rows]) * (height / ADULT_STATURE_M)
    return names, parents, offsets
