"""Skinned bodies: parts of vertices, and their positions in poses."""

import numpy as np
import pytest
from box_person import box_person

from solvers.depth_tracking.forest.parts import (
    MIRRORED_PARTS,
    N_PARTS,
    PARTS,
    mirrored_part,
    part_of_role,
)
from solvers.depth_tracking.forest_training.skinned_body import load_skinned_body
from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import HUMANOID_ROLES, Motion, find_humanoid_map, forward_kinematics
from solvers.recordings import read_bvh
from solvers.rotations.representations import (
    IDENTITY,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

CMU_METERS = 0.0254 / 0.45
BODIES = ("female_average", "female_slim", "male_average", "male_heavy")


@pytest.fixture(scope="module")
def person():
    return box_person()


def test_every_part_has_a_mirrored_part():
    assert len(set(PARTS)) == N_PARTS == 23
    np.testing.assert_array_equal(MIRRORED_PARTS[MIRRORED_PARTS], np.arange(N_PARTS))
    assert mirrored_part("leftUpperLegEnd") == "rightUpperLegEnd"
    assert mirrored_part("chest") == "chest"


def test_every_role_except_fingers_jaw_and_eyes_has_a_part():
    others = {role for role in HUMANOID_ROLES if part_of_role(role) not in PARTS}
    assert all(
        role.endswith(("Proximal", "Intermediate", "Distal", "Metacarpal", "Eye", "jaw"))
        for role in others
    )


def test_vertices_have_the_parts_of_their_boxes(person):
    parts = np.array(PARTS)[person.vertex_parts]
    x, _, z = person.vertices.T
    assert set(parts) == set(PARTS)
    assert (z[parts == "head"].min() > z[parts == "chest"].max()).all()
    assert (x[parts == "leftHand"] > 0.7).all()
    assert (x[parts == "rightLowerArm"] < 0).all()
    knee = 0.95 - 0.02 - 0.43
    assert (z[parts == "leftUpperLeg"] >= knee + 0.43 / 2 - 0.03).all()
    assert (z[parts == "leftUpperLegEnd"] <= knee + 0.43 / 2 + 0.03).all()


def test_rest_pose_does_not_change_the_mesh(person):
    n_joints = person.skeleton.n_joints
    vertices, joints = person.pose(np.tile(IDENTITY, (n_joints, 1)), np.array([0, 0, 0.95]))
    np.testing.assert_allclose(vertices, person.vertices, atol=1e-12)
    np.testing.assert_allclose(joints, person.skeleton.rest_positions, atol=1e-12)


def test_vertices_move_with_the_mean_of_their_joints(person, rng):
    """One vertex of two joints, computed manually from forward kinematics."""
    weights = person.weights.copy()
    elbow, arm = (person.skeleton.index(name) for name in ("LeftForeArm", "LeftArm"))
    vertex = int(np.flatnonzero(weights[:, elbow])[0])
    weights[vertex] = 0.0
    weights[vertex, [arm, elbow]] = 0.3, 0.9
    uniform = type(person)(person.skeleton, person.vertices, person.triangles, weights)
    rotations = quaternion_from_rotation_vector(rng.normal(size=(person.skeleton.n_joints, 3)))
    root = np.array([1.0, 2.0, 3.0])
    moved, _ = uniform.pose(rotations, root)
    world = forward_kinematics(Motion(person.skeleton, rotations[None], root[None], 30.0))
    rest = person.vertices[vertex] - person.skeleton.rest_positions[[arm, elbow]]
    ends = world.positions[0, [arm, elbow]] + rotate(world.rotations[0, [arm, elbow]], rest)
    np.testing.assert_allclose(moved[vertex], 0.25 * ends[0] + 0.75 * ends[1], atol=1e-12)


def test_rotating_the_root_rotates_all_vertices(person, rng):
    rotations = quaternion_from_rotation_vector(rng.normal(size=(person.skeleton.n_joints, 3)))
    before, _ = person.pose(rotations, np.zeros(3))
    offset = quaternion_from_rotation_vector([0.3, -0.5, 2.0])
    rotations[0] = multiply(offset, rotations[0])
    after, _ = person.pose(rotations, np.zeros(3))
    np.testing.assert_allclose(after, rotate(offset, before), atol=1e-12)


def test_poses_of_another_skeleton_are_matched_by_role(person):
    gait = walking_gait(GaitSettings(duration=1.0, frame_rate=10.0))
    poses = person.rotations_of(gait)
    assert poses.shape == (gait.n_frames, person.skeleton.n_joints, 4)
    reference = forward_kinematics(gait).positions
    names = gait.skeleton.names
    motion = Motion(person.skeleton, poses, gait.root_positions, 10.0)
    result = forward_kinematics(motion).positions
    humanoid = person.humanoid.joints
    for upper, lower in (("leftUpperLeg", "leftLowerLeg"), ("rightUpperArm", "rightLowerArm")):
        mine = [person.skeleton.index(humanoid[role]) for role in (upper, lower)]
        found = find_humanoid_map(gait.skeleton).joints
        other = [names.index(found[role]) for role in (upper, lower)]
        a = result[:, mine[1]] - result[:, mine[0]]
        b = reference[:, other[1]] - reference[:, other[0]]
        cosines = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        assert cosines.min() > 0.99


@pytest.mark.parametrize(
    ("take", "clip", "first", "body"),
    [
        ("walk_front_clean", "cmu_walk/07_01", 13, "male_average"),
        ("jump", "cmu_hop/49_03", 241, "male_average"),
        ("walk_diagonal", "cmu_walk/07_05", 13, "male_heavy"),
    ],
)
def test_joints_equal_those_of_another_implementation(recordings, take, clip, first, body):
    """Other code posed the takes of depth/truth from the same clips and bodies."""
    skinned = load_skinned_body(recordings / "body" / f"{body}.npz")
    poses = skinned.rotations_of(read_bvh(recordings / f"mocap/{clip}.bvh", scale=CMU_METERS))
    with np.load(recordings / "depth" / "truth" / f"{take}.npz") as truth:
        joints = truth["joints"].astype(float)
    for frame in (0, 40, 70):
        _, result = skinned.pose(poses[first + 4 * frame], np.zeros(3))
        distances = np.linalg.norm(_aligned_to(result, joints[frame]) - joints[frame], axis=1)
        assert distances.mean() < 0.015


def _aligned_to(points, onto):
    """Rigid alignment by Kabsch, without mirroring."""
    start, stop = points.mean(axis=0), onto.mean(axis=0)
    left, _, right = np.linalg.svd((points - start).T @ (onto - stop))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    return (points - start) @ (left @ flip @ right) + stop


@pytest.mark.parametrize("name", BODIES)
def test_real_bodies_have_every_part(recordings, name):
    body = load_skinned_body(recordings / "body" / f"{name}.npz")
    assert set(body.vertex_parts) == set(range(N_PARTS))
    assert body.name == name


def test_skinned_body_raises_for_invalid_files(person, tmp_path):
    with pytest.raises(InvalidMotionError, match="corners of triangles"):
        type(person)(person.skeleton, person.vertices[:9], person.triangles, person.weights[:9])
    with pytest.raises(InvalidMotionError, match="weights do not fit"):
        type(person)(person.skeleton, person.vertices, person.triangles, person.weights[:, 1:])
    with pytest.raises(InvalidMotionError, match="follows no joint"):
        nothing = 0.0 * person.weights
        type(person)(person.skeleton, person.vertices, person.triangles, nothing)
    with pytest.raises(InvalidFileError, match="no file"):
        load_skinned_body(tmp_path / "body.npz")
    (tmp_path / "body.npz").write_bytes(b"PK not an archive")
    with pytest.raises(InvalidFileError, match="no skinned body"):
        load_skinned_body(tmp_path / "body.npz")
