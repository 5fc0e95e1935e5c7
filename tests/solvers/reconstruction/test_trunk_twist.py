"""Axial rotation of limbs relative to the trunk does not depend on the rig of a clip."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidFileError
from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.motion.humanoid.canonical import canonical_rotations, from_canonical
from solvers.motion.humanoid.posture_heading import mirror_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.reconstruction.joint_rotations.limb_angles import axial_angles
from solvers.reconstruction.joint_rotations.trunk_twist import (
    TWISTED_LIMBS,
    LimbTwists,
    flexion_normals,
    hinges_from_twists,
    mean_twists,
    mirror_twists,
    untwisted_hinges,
)
from solvers.reconstruction.pose_library.clip_twists import (
    combine_clip_twists,
    read_clip_twists,
)
from solvers.reconstruction.pose_library.posture_library import (
    LAYOUT,
    build_posture_library,
    load_posture_library,
    merge_posture_libraries,
)
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

LEFT_ARM = 0


@pytest.fixture(scope="module")
def gait() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


def standing(rng, n_frames=40) -> np.ndarray:
    """Bodies with random trunk lean and limbs in any direction except far back."""
    postures = np.zeros((n_frames, 20, 3))
    default = {
        "chest": (0, 0, 0.5), "spine": (0, 0, 0.25), "head": (0, 0, 0.7),
        "leftUpperArm": (0.2, 0, 0.5), "rightUpperArm": (-0.2, 0, 0.5),
        "leftUpperLeg": (0.1, 0, -0.05), "rightUpperLeg": (-0.1, 0, -0.05),
    }  # fmt: skip
    for name, position in default.items():
        postures[:, POSTURE_JOINTS.index(name)] = position
    for limb in TWISTED_LIMBS:
        upper, lower = (
            Rotation.from_rotvec(rng.normal(scale=0.8, size=(n_frames, 3))).apply(limb.along)
            for _ in range(2)
        )
        postures[:, limb.lower] = postures[:, limb.upper] + 0.3 * upper
        postures[:, limb.end] = postures[:, limb.lower] + 0.3 * lower
    lean = Rotation.from_rotvec(rng.normal(scale=0.4, size=(n_frames, 3)))
    return np.stack([lean.apply(postures[:, joint]) for joint in range(20)], axis=1)


def test_untwisted_hinges_use_the_shortest_rotation_from_the_trunk():
    """Compare with the shortest rotation by axis and angle in the trunk's axes."""
    postures = standing(np.random.default_rng(1))

    directions, hinges = untwisted_hinges(postures)

    positions = {name: postures[:, index] for index, name in enumerate(POSTURE_JOINTS)}
    for row, limb in enumerate(TWISTED_LIMBS):
        part = POSTURE_JOINTS[limb.upper].removeprefix("left").removeprefix("right")
        across = positions[f"left{part}"] - positions[f"right{part}"]
        for frame, up in enumerate(positions["chest"] - positions["hips"]):
            z = up / np.linalg.norm(up)
            y = np.cross(z, across[frame])
            y /= np.linalg.norm(y)
            trunk = np.stack([np.cross(y, z), y, z], axis=-1)
            goal = trunk.T @ directions[frame, row]
            axis = np.cross(limb.along, goal)
            angle = np.arctan2(np.linalg.norm(axis), np.dot(limb.along, goal))
            rotation = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
            assert_allclose(hinges[frame, row], trunk @ rotation.apply(limb.hinge), atol=1e-9)


def test_twists_ignore_heading_and_position():
    postures = standing(np.random.default_rng(2))
    normals, _ = flexion_normals(postures)
    moved = rotate_about_vertical(postures, np.full(len(postures), 2.0)) + np.array([
        3.0,
        1.0,
        0.5,
    ])

    moved_angles = axial_angles(*untwisted_hinges(moved), flexion_normals(moved)[0])

    assert_allclose(moved_angles, axial_angles(*untwisted_hinges(postures), normals), atol=1e-9)


def test_mirror_swaps_sides_and_negates_twists():
    postures = standing(np.random.default_rng(3))
    image = mirror_postures(postures)

    observed = axial_angles(*untwisted_hinges(image), flexion_normals(image)[0])

    own = axial_angles(*untwisted_hinges(postures), flexion_normals(postures)[0])
    assert_allclose(observed, mirror_twists(own), atol=1e-9)


def test_hinges_match_the_twists():
    rng = np.random.default_rng(4)
    postures = standing(rng)
    twists = 0.7 * np.exp(1j * rng.uniform(-2.0, 2.0, (len(postures), 4)))

    hinges = hinges_from_twists(postures, LimbTwists(twists))

    directions = np.stack(
        [hinges[POSTURE_JOINTS[limb.upper]].vectors for limb in TWISTED_LIMBS], axis=1
    )
    assert_allclose(np.linalg.norm(directions, axis=-1), 0.7)
    assert_allclose(
        axial_angles(*untwisted_hinges(postures), directions), twists / 0.7, atol=1e-9
    )


def with_twisted_arm(gait: Motion, angles: np.ndarray, maker: float = 0.0) -> Motion:
    """A walk with an axial rotation of the left upper arm and its flexion plane.

    In all frames, the bone also has the constant rotation `maker` of the rig's rest pose.
    """
    joints = find_humanoid_map(gait.skeleton).indices(gait.skeleton)
    upper, lower = joints["leftUpperArm"], joints["leftLowerArm"]
    along = gait.skeleton.offsets[lower] / np.linalg.norm(gait.skeleton.offsets[lower])
    rotations = gait.rotations.copy()

    def about(angle: np.ndarray) -> np.ndarray:
        return quaternion_from_rotation_vector(np.multiply.outer(angle, along))

    rotations[:, upper] = multiply(rotations[:, upper], about(angles + maker))
    rotations[:, lower] = multiply(about(np.full(len(rotations), -maker)), rotations[:, lower])
    return gait.with_poses(rotations, gait.root_positions)


def twists_of(motion: Motion) -> np.ndarray:
    return combine_clip_twists(
        [motion.skeleton], [read_clip_twists(motion, postures_from_motion(motion))]
    )[0]


def test_twist_of_a_bone_matches_its_clip(gait):
    angles = np.linspace(-0.8, 0.8, gait.n_frames)

    before, after = twists_of(gait), twists_of(with_twisted_arm(gait, angles))

    rotation_angles = np.angle(after[:, LEFT_ARM] * np.conj(before[:, LEFT_ARM]))
    assert_allclose(rotation_angles, angles, atol=0.02)
    assert_allclose(after[:, 1:], before[:, 1:], atol=1e-9)


@pytest.mark.parametrize("maker", [-0.5, 0.6])
def test_rigs_with_other_bone_axes_agree(gait, maker):
    """Arm axes differ by 30 degrees in CMU and HDM05: elbows rotate about another bone axis."""
    angles = np.linspace(-0.5, 0.5, gait.n_frames)

    plain, reference = (
        twists_of(with_twisted_arm(gait, angles, each)) for each in (0.0, maker)
    )

    assert np.abs(np.angle(reference * np.conj(plain))).max() < 0.15
    assert np.abs(reference).min() > 0.5


def test_rig_is_recognized_with_rounded_offsets(gait):
    """One walk shows the bone axes of the rig; another walk of this rig does not."""
    skeleton = gait.skeleton
    rounded = replace(skeleton, offsets=skeleton.offsets - 1e-6)
    clip = read_clip_twists(gait, postures_from_motion(gait))
    straight = clip._replace(flexion_fractions=np.zeros_like(clip.flexion_fractions))

    same, again = (
        combine_clip_twists([skeleton, each], [clip, straight])[1]
        for each in (skeleton, rounded)
    )

    assert np.abs(same[:, LEFT_ARM]).max() > 0.5
    assert_allclose(again, same)


def test_rigs_with_other_rest_poses_agree(gait):
    """The same walk, on a rig whose rest pose has lowered arms."""
    skeleton = gait.skeleton
    humanoid = find_humanoid_map(skeleton)
    arm = humanoid.indices(skeleton)["leftUpperArm"]
    lowered = skeleton.offsets.copy()
    below = skeleton.subtree(arm)[1:]
    lowered[below] = Rotation.from_rotvec((0.0, 0.9, 0.0)).apply(lowered[below])
    rig = Skeleton(skeleton.names, skeleton.parents, lowered)
    rotations = from_canonical(canonical_rotations(gait, humanoid), rig, humanoid)
    moved = Motion(rig, rotations, gait.root_positions, gait.frame_rate)
    assert np.abs(moved.rotations - gait.rotations).max() > 0.3

    assert_allclose(twists_of(moved), twists_of(gait), atol=1e-6)


def test_rotations_that_contradict_flexion_get_a_low_weight(gait):
    """Joint positions define no twist: an upper arm with random axial rotation has no
    information.
    """
    rng = np.random.default_rng(5)
    clip = read_clip_twists(gait, postures_from_motion(gait))
    wild = clip._replace(
        from_rotations=np.exp(1j * rng.uniform(-np.pi, np.pi, clip.from_rotations.shape))
    )
    straight = wild._replace(
        flexion_fractions=np.where(np.arange(len(wild.flexion_fractions))[:, None] < 60, 1.0, 0)
    )

    combined = combine_clip_twists([gait.skeleton], [straight])[0]

    assert np.abs(combined[:60]).min() > 0.99
    assert np.abs(combined[60:]).max() < 0.35


def test_mean_twist_is_weighted_by_similarity():
    """Neighbors at 1 and 2 cm of one joint have weights 4 to 1."""
    neighbors = np.zeros((1, 2, 60))
    neighbors[0, :, 9] = (0.01, 0.02)
    twists = np.tile(np.array([1.0, 1j])[None, :, None], (1, 1, 4))

    mean = mean_twists(twists, np.zeros((1, 20, 3)), neighbors, np.ones((1, 20)))

    assert_allclose(mean / np.abs(mean), np.full((1, 4), (0.8 + 0.2j) / np.hypot(0.8, 0.2)))


def test_unreliable_joints_select_no_neighbor():
    neighbors = np.zeros((1, 2, 60))
    neighbors[0, 0, 9] = 0.3
    neighbors[0, 1, 12] = 0.1
    reliability = np.ones((1, 20))
    reliability[0, 3] = 0.0
    twists = np.tile(np.array([1.0, 1j])[None, :, None], (1, 1, 4))

    mean = mean_twists(twists, np.zeros((1, 20, 3)), neighbors, reliability)

    assert np.abs(np.angle(mean)).max() < 0.05


def test_library_stores_twists_and_their_mirror_images(gait, tmp_path):
    angles = np.full(gait.n_frames, 0.6)
    library = build_posture_library([with_twisted_arm(gait, angles)])
    plain = build_posture_library([gait])
    assert (
        np.angle(library.twists_or_zero[:, 0]).mean()
        > 0.1 + np.angle(plain.twists_or_zero[:, 0]).mean()
    )
    sides = np.sort(np.angle(library.twists_or_zero[:, :2]), axis=0)
    assert_allclose(sides[:, 0], -sides[::-1, 1], atol=0.05)

    library.save(tmp_path / "kept.npz")
    read = load_posture_library(tmp_path / "kept.npz")

    assert_allclose(read.twists_or_zero, library.twists_or_zero, atol=0.006)
    both = merge_posture_libraries(library, replace(library, twists=None))
    assert_allclose(both.twists_or_zero[: library.n_postures], library.twists_or_zero)
    assert not both.twists_or_zero[library.n_postures :].any()


def test_libraries_without_twists_merge_to_one_without(gait):
    old = replace(build_posture_library([gait]), twists=None)

    assert merge_posture_libraries(old, old).twists is None


def test_load_reads_older_files_and_raises_for_damaged_ones(gait, tmp_path):
    path = tmp_path / "postures.npz"
    library = build_posture_library([gait])
    library.save(path)
    arrays = LAYOUT.read(path)

    LAYOUT.write(path, {**arrays, "twists": arrays["twists"][:-1]})
    with pytest.raises(InvalidFileError, match="shapes do not fit"):
        load_posture_library(path)
    del arrays["twists"]
    LAYOUT.write(path, arrays)
    old = load_posture_library(path)

    assert old.twists is None
    assert not old.twists_or_zero.any()
    assert_allclose(old.directions, library.directions, atol=2e-3)
