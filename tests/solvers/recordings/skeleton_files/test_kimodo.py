"""Results of Kimodo as it saves them: positions and world rotations, without names or rate."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import read_recording
from solvers.recordings.skeleton_files.kimodo import JOINTS
from solvers.rotations import (
    matrix_from_quaternion,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)

F = 50
NAMES = [name for name, _ in JOINTS]
BONES = {
    "Spine": (0.0, 0.12, 0.0), "Chest": (0.0, 0.12, 0.0), "Neck": (0.0, 0.1, 0.0),
    "Head": (0.0, 0.1, 0.02), "Shoulder": (0.05, 0.08, 0.0), "Arm": (0.12, 0.0, 0.0),
    "ForeArm": (0.28, 0.0, 0.0), "Hand": (0.25, 0.0, 0.0), "Leg": (0.1, -0.05, 0.0),
    "Shin": (0.0, -0.42, 0.0), "Foot": (0.0, -0.4, -0.03), "ToeBase": (0.0, -0.06, 0.14),
}  # fmt: skip
"""Y up, facing +Z, meters, by the end of the name; of the left side."""


def saved(path, rng):
    """Write a body that walks 2 m along +Z; return its joints, and the path."""
    vectors = (
        rng.normal(scale=0.15, size=(1, len(JOINTS), 3))
        * np.sin(np.arange(F) / 6.0)[:, None, None]
    )
    local = quaternion_from_rotation_vector(vectors)
    world, joints = np.zeros_like(local), np.zeros((F, len(JOINTS), 3))
    for joint, (name, parent) in enumerate(JOINTS):
        if not parent:
            world[:, joint] = local[:, joint]
            joints[:, joint] = np.linspace((0.0, 1.0, 0.0), (0.0, 1.0, 2.0), F)
            continue
        above = NAMES.index(parent)
        longest = max(
            (end for end in BONES if name.rstrip("12").endswith(end)), key=len, default=""
        )
        offset = np.array(BONES.get(longest, (0.03, 0.02, 0.05)))
        offset *= (-1.0 if name.startswith("Right") else 1.0, 1.0, 1.0)
        world[:, joint] = multiply(world[:, above], local[:, joint])
        joints[:, joint] = joints[:, above] + rotate(world[:, above], offset)
    np.savez(
        path, posed_joints=joints, global_rot_mats=matrix_from_quaternion(world),
        foot_contacts=np.ones((F, 4), bool),
    )  # fmt: skip
    return joints


def test_positions_and_rotations_alone_give_the_same_joints_standing(tmp_path, rng):
    messages = []
    theirs = saved(tmp_path / "take.npz", rng)

    motion = read_recording(
        tmp_path / "take.npz", progress=lambda _, message="": messages.append(message)
    )

    ours = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    standing = np.stack([theirs[..., 0], -theirs[..., 2], theirs[..., 1]], axis=-1)
    assert np.abs(ours - standing).max() == pytest.approx(0.0, abs=1e-6)
    assert motion.frame_rate == 30.0
    assert "The file has no frame rate; 30 Hz is assumed" in messages
    found = find_humanoid_map(motion.skeleton)
    assert found.joint("leftUpperLeg") == "LeftLeg"
    assert found.joint("leftLowerLeg") == "LeftShin"


@pytest.mark.parametrize(
    ("member", "factor", "sentence"),
    [
        ("global_rot_mats", 0.0, "that are not rotations"),
        ("global_rot_mats", -1.0, "that are not rotations"),
        ("global_rot_mats", 1e300, "damaged"),
        ("posed_joints", 1e300, "damaged"),
    ],
)
def test_numbers_that_are_no_motion_are_refused(tmp_path, rng, member, factor, sentence):
    saved(tmp_path / "take.npz", rng)
    with np.load(tmp_path / "take.npz") as archive:
        arrays = dict(archive)
    arrays[member][3] *= factor
    np.savez(tmp_path / "take.npz", **arrays)

    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(tmp_path / "take.npz")
