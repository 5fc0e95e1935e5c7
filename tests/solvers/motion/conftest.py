"""Fixtures: a complete body in an exact T-pose, and a motion of it."""

import numpy as np
import pytest

from solvers.motion import Motion, Skeleton
from solvers.rotations.representations import quaternion_from_rotation_vector

SIDE = (
    ("UpLeg", "Hips", (0.09, 0.0, -0.05)),
    ("Leg", "UpLeg", (0.0, 0.0, -0.43)),
    ("Foot", "Leg", (0.0, 0.0, -0.42)),
    ("ToeBase", "Foot", (0.0, -0.13, -0.07)),
    ("ToeBase_end", "ToeBase", (0.0, -0.07, 0.0)),
    ("Shoulder", "Spine2", (0.03, 0.0, 0.12)),
    ("Arm", "Shoulder", (0.14, 0.0, 0.02)),
    ("ForeArm", "Arm", (0.3, 0.0, 0.0)),
    ("Hand", "ForeArm", (0.26, 0.0, 0.0)),
    ("Hand_end", "Hand", (0.18, 0.0, 0.0)),
)
CENTRAL_JOINTS = (
    ("Hips", "", (0.0, 0.0, 0.98)),
    ("Spine", "Hips", (0.0, 0.01, 0.1)),
    ("Spine1", "Spine", (0.0, 0.01, 0.12)),
    ("Spine2", "Spine1", (0.0, 0.0, 0.12)),
    ("Neck", "Spine2", (0.0, 0.0, 0.16)),
    ("Head", "Neck", (0.0, -0.02, 0.09)),
    ("Head_end", "Head", (0.0, 0.0, 0.18)),
)
CENTRAL = {"Hips", "Spine2"}


@pytest.fixture
def body() -> Skeleton:
    """A Mixamo body of 1.75 m: 27 joints, exact T-pose, flat feet."""
    rows = list(CENTRAL_JOINTS)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for name, parent, (x, y, z) in SIDE:
            above = parent if parent in CENTRAL else side + parent
            rows.append((side + name, above, (sign * x, y, z)))
    names = [name for name, _, _ in rows]
    parents = [names.index(parent) if parent else -1 for _, parent, _ in rows]
    return Skeleton(tuple(names), tuple(parents), np.array([offset for *_, offset in rows]))


@pytest.fixture
def lively(body, rng) -> Motion:
    """Ninety frames at 30 Hz; every joint rotates smoothly by small angles."""
    time = np.arange(90) / 30.0
    phase = rng.uniform(0, 2 * np.pi, (body.n_joints, 3))
    swing = 0.4 * np.sin(2 * np.pi * 0.7 * time[:, None, None] + phase)
    ends = [body.is_end_site(joint) for joint in range(body.n_joints)]
    swing[:, ends] = 0.0
    root_positions = np.stack([0.05 * np.sin(3 * time), -0.8 * time, 0.98 + 0 * time], axis=-1)
    return Motion(body, quaternion_from_rotation_vector(swing), root_positions, 30.0)
