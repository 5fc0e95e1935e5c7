"""Results of Kimodo as it saves them: positions and world rotations, without names or rate."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import list_bodies, read_recording
from solvers.recordings.skeleton_files.kimodo import JOINTS, TREES
from solvers.rotations import (
    matrix_from_quaternion,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)

F = 50
BONES = {
    "Spine": (0.0, 0.12, 0.0), "Chest": (0.0, 0.12, 0.0), "Neck": (0.0, 0.1, 0.0),
    "Head": (0.0, 0.1, 0.02), "Shoulder": (0.05, 0.08, 0.0), "Arm": (0.12, 0.0, 0.0),
    "ForeArm": (0.28, 0.0, 0.0), "Hand": (0.25, 0.0, 0.0), "Leg": (0.1, -0.05, 0.0),
    "Shin": (0.0, -0.42, 0.0), "Foot": (0.0, -0.4, -0.03), "ToeBase": (0.0, -0.06, 0.14),
    "hip_pitch": (0.064, -0.103, 0.0), "hip_roll": (0.052, -0.03, 0.0),
    "hip_yaw": (0.0, -0.124, 0.025), "knee": (0.002, -0.177, -0.078),
    "ankle_pitch": (0.0, -0.3, 0.0), "ankle_roll": (0.0, -0.018, 0.0),
    "toe_base": (0.0, -0.035, 0.14), "waist_yaw": (0.0, 0.0, 0.0),
    "waist_roll": (0.0, 0.044, -0.004), "waist_pitch": (0.0, 0.0, 0.0),
    "shoulder_pitch": (0.1, 0.248, 0.004), "shoulder_roll": (0.038, -0.014, 0.0),
    "shoulder_yaw": (0.006, -0.103, 0.0), "elbow": (0.0, -0.081, 0.016),
    "wrist_roll": (0.002, -0.01, 0.1), "wrist_pitch": (0.0, 0.0, 0.038),
    "wrist_yaw": (0.0, 0.0, 0.046), "hand_roll": (0.0, 0.0, 0.1),
}  # fmt: skip
"""Y up, facing +Z, meters, by the end of the name, left side."""


def walking(rng, tree=JOINTS):
    """Return joints and world rotations of a body that walks 2 m along +Z."""
    vectors = (
        rng.normal(scale=0.15, size=(1, len(tree), 3))
        * np.sin(np.arange(F) / 6.0)[:, None, None]
    )
    local = quaternion_from_rotation_vector(vectors)
    world, joints = np.zeros_like(local), np.zeros((F, len(tree), 3))
    names = [name for name, _ in tree]
    for joint, (name, parent) in enumerate(tree):
        if not parent:
            world[:, joint] = local[:, joint]
            joints[:, joint] = np.linspace((0.0, 1.0, 0.0), (0.0, 1.0, 2.0), F)
            continue
        above = names.index(parent)
        longest = max(
            (end for end in BONES if name.rstrip("12").endswith(end)), key=len, default=""
        )
        offset = np.array(BONES.get(longest, (0.03, 0.02, 0.05)))
        offset *= (-1.0 if name.lower().startswith("right") else 1.0, 1.0, 1.0)
        world[:, joint] = multiply(world[:, above], local[:, joint])
        joints[:, joint] = joints[:, above] + rotate(world[:, above], offset)
    return joints, matrix_from_quaternion(world)


def saved(path, rng):
    """Write such a body; return its joints."""
    joints, matrices = walking(rng)
    np.savez(
        path, posed_joints=joints, global_rot_mats=matrices, foot_contacts=np.ones((F, 4), bool)
    )
    return joints


def test_the_full_skeleton_with_fingers_is_read(tmp_path, rng):
    joints, matrices = walking(rng, TREES[77])
    np.savez(tmp_path / "take.npz", posed_joints=joints, global_rot_mats=matrices, fps=30.0)

    motion = read_recording(tmp_path / "take.npz")

    assert motion.skeleton.n_joints == 77
    names = motion.skeleton.names
    assert names.index("LeftHandPinkyEnd") == 38 and names.index("RightToeEnd") == 76
    found = find_humanoid_map(motion.skeleton)
    assert found.joint("leftHand") == "LeftHand" and found.joint("rightToes") == "RightToeBase"


def test_a_robot_is_read_with_the_joints_that_carry_its_limbs(tmp_path, rng):
    """Unitree's G1 has one joint for each axis; the last of them moves the limb."""
    joints, matrices = walking(rng, TREES[34])
    np.savez(tmp_path / "take.npz", posed_joints=joints, global_rot_mats=matrices)

    motion = read_recording(tmp_path / "take.npz")

    found = find_humanoid_map(motion.skeleton)
    assert found.score > 0.9
    for role, name in {
        "UpperLeg": "hip_yaw", "LowerLeg": "knee", "Foot": "ankle_roll",
        "UpperArm": "shoulder_yaw", "LowerArm": "elbow", "Hand": "wrist_yaw",
    }.items():  # fmt: skip
        assert found.joint(f"left{role}") == f"left_{name}"
        assert found.joint(f"right{role}") == f"right_{name}"
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    x, y, z = np.moveaxis(joints, -1, 0)
    assert_allclose(poses.positions, np.stack([x, -z, y], axis=-1), atol=1e-6)


def test_samples_of_one_text_are_bodies(tmp_path, rng):
    one, other = walking(rng), walking(rng)
    np.savez(
        tmp_path / "take.npz",
        foot_contacts=np.ones((2, F, 4), bool),
        fps=30.0,
        posed_joints=np.stack([one[0], other[0]]),
        global_rot_mats=np.stack([one[1], other[1]]),
    )
    np.savez(tmp_path / "second.npz", posed_joints=other[0], global_rot_mats=other[1], fps=30.0)

    assert [body.name for body in list_bodies(tmp_path / "take.npz")] == ["1", "2"]
    second = read_recording(tmp_path / "take.npz", body="2")
    alone = read_recording(tmp_path / "second.npz")
    assert_allclose(second.rotations, alone.rotations)
    assert_allclose(second.root_positions, alone.root_positions)


def test_a_remark_is_made_once_for_the_sample_that_is_read(tmp_path, rng, collected_messages):
    messages, progress = collected_messages
    samples = [walking(rng) for _ in range(3)]
    np.savez(
        tmp_path / "take.npz",
        posed_joints=np.stack([joints for joints, _ in samples]),
        global_rot_mats=np.stack([matrices for _, matrices in samples]),
    )

    read_recording(tmp_path / "take.npz", body="3", progress=progress)

    assert sum("no frame rate" in message for message in messages) == 1


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
