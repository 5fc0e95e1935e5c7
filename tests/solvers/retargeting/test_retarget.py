"""Another body performs the same motion: directions, paths and contacts, in any rest pose."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from retargeted_motions import min_foot_steps
from rigs import RIGS, mixamo, unreal

from solvers.errors import InvalidMotionError
from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    forward_kinematics,
    leg_length,
)
from solvers.recordings import read_bvh
from solvers.retargeting import RetargetSettings, RootMotion, retarget
from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait

CMU_METERS = 0.0254 / 0.45
DEFAULTS = RetargetSettings()


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=4.0, frame_rate=60.0))


@pytest.mark.parametrize("family", RIGS)
def test_bones_are_parallel_to_the_source(walk, family):
    """Without limb targets, each bone is parallel to its source."""
    rig = RIGS[family]()
    settings = RetargetSettings(keep_feet=False, keep_hands=False)

    result = retargeted(walk, rig, settings)

    for start, stop in (
        ("UpperArm", "LowerArm"),
        ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"),
    ):
        for side in ("left", "right"):
            reference = bone(walk, side + start, side + stop)
            actual = bone(result, side + start, side + stop)
            assert_allclose(actual, reference, atol=1e-9)


def test_same_body_performs_the_same_motion(walk):
    result = retargeted(walk, walk.skeleton)

    assert angle_between(result.rotations, walk.rotations).max() < 1e-6
    shift = result.root_positions - walk.root_positions
    assert np.ptp(shift, axis=0).max() < 1e-6


@pytest.mark.parametrize("family", RIGS)
@pytest.mark.parametrize("size", [0.6, 1.0, 1.5])
def test_feet_and_hands_follow_paths_scaled_by_the_limb(walk, family, size):
    rig = RIGS[family](size)

    result = retargeted(walk, rig)

    growth = leg_length(rig, find_humanoid_map(rig)) / leg_length(
        walk.skeleton, find_humanoid_map(walk.skeleton)
    )
    for side in ("left", "right"):
        reference, actual = (
            role_position(walk, f"{side}Foot"),
            role_position(result, f"{side}Foot"),
        )
        error = (actual - actual[0]) - growth * (reference - reference[0])
        # Feet of other lengths that roll over their balls move their ankles.
        assert np.linalg.norm(error, axis=1).max() < 0.025 * size
        arms = [
            role_position(motion, f"{side}Hand") - role_position(motion, f"{side}UpperArm")
            for motion in (walk, result)
        ]
        arm_growth = arm_length(result, side) / arm_length(walk, side)
        assert_allclose(arms[1], arm_growth * arms[0], atol=2e-4)


@pytest.mark.parametrize("family", RIGS)
def test_bones_without_a_source_stay_at_rest(walk, family):
    rig = RIGS[family]()
    roles = set(find_humanoid_map(rig).joints.values())

    result = retargeted(walk, rig)

    idle = [joint for joint, name in enumerate(rig.names) if name not in roles]
    assert idle
    assert_allclose(result.rotations[:, idle], np.broadcast_to(IDENTITY, (240, len(idle), 4)))


@pytest.mark.parametrize("family", RIGS)
def test_feet_slide_no_more_than_in_a_real_walk(recordings, family):
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh", scale=CMU_METERS)
    walk = walk.slice(1, walk.n_frames)
    rig = RIGS[family]()

    result = retargeted(walk, rig)

    growth = leg_length(rig, find_humanoid_map(rig)) / leg_length(
        walk.skeleton, find_humanoid_map(walk.skeleton)
    )
    contacts = detect_contacts(walk)
    held = contacts[1:] & contacts[:-1]
    reference, actual = (min_foot_steps(motion)[held] for motion in (walk, result))
    assert (actual - growth * reference).max() < 1e-3
    assert actual.mean() < growth * reference.mean()


def test_gaps_remain_and_do_not_spread(walk):
    rotations, positions = walk.rotations.copy(), walk.root_positions.copy()
    rotations[10:20, walk.skeleton.index("LeftForeArm")] = np.nan
    rotations[50:60, walk.skeleton.index("Spine1")] = np.nan
    positions[100:110] = np.nan
    rig = mixamo()

    result = retargeted(walk.with_poses(rotations, positions), rig)

    expected = np.zeros((240, rig.n_joints), dtype=bool)
    expected[10:20, rig.index("mixamorig:LeftForeArm")] = True
    expected[50:60, rig.index("mixamorig:Spine1")] = True
    assert_equal_flags(np.isnan(result.rotations).all(axis=-1), expected)
    assert_equal_flags(np.isnan(result.root_positions[:, 0]), np.isnan(positions[:, 0]))


def test_in_place_removes_the_travel(walk):
    walk = walk.with_poses(root_positions=walk.root_positions + np.array([5.0, -3.0, 0.0]))
    still = retargeted(walk, mixamo(), RetargetSettings(root_motion=RootMotion.IN_PLACE))
    default = retargeted(walk, mixamo())

    assert np.linalg.norm(np.ptp(default.root_positions[:, :2], axis=0)) > 2.0
    assert np.linalg.norm(np.ptp(still.root_positions[60:-60, :2], axis=0)) < 0.1
    assert_allclose(still.root_positions[0], default.root_positions[0], atol=1e-9)
    assert_allclose(still.root_positions[:, 2], default.root_positions[:, 2], atol=1e-12)


def test_a_root_bone_carries_the_body_without_changing_it(walk):
    default = retargeted(walk, unreal())
    carried = retargeted(walk, unreal(), RetargetSettings(root_motion=RootMotion.ROOT_BONE))

    assert_allclose(default.rotations[:, 0], np.tile(IDENTITY, (240, 1)))
    assert angle_between(carried.rotations[:, 0], carried.rotations[0, 0]).max() > 0.01
    assert_allclose(
        forward_kinematics(carried).positions[:, 1:],
        forward_kinematics(default).positions[:, 1:],
        atol=1e-9,
    )


def test_retarget_names_missing_roles(walk):
    roles = find_humanoid_map(walk.skeleton)
    empty_map = HumanoidMap({})

    with pytest.raises(
        InvalidMotionError, match="source's skeleton has the humanoid role hips"
    ):
        retarget(walk, empty_map, mixamo(), find_humanoid_map(mixamo()))
    with pytest.raises(
        InvalidMotionError, match="target's skeleton has the humanoid role hips"
    ):
        retarget(walk, roles, mixamo(), empty_map)
    with pytest.raises(InvalidMotionError, match="no joint above the hips"):
        retargeted(walk, mixamo(), RetargetSettings(root_motion=RootMotion.ROOT_BONE))


def test_hips_are_the_only_required_role():
    box = Skeleton(("hips", "lid"), (-1, 0), np.array([[0, 0, 1.0], [0, 0, 0.5]]))
    rotation = quaternion_from_rotation_vector([[[0, 0, 0.3], [0, 0, 0]]])
    motion = Motion(box, rotation, np.array([[0, 0, 2.0]]), 30.0)

    result = retarget(motion, HumanoidMap({"hips": "hips"}), box, HumanoidMap({"hips": "hips"}))

    assert_allclose(result.rotations, motion.rotations, atol=1e-12)


def retargeted(motion: Motion, rig: Skeleton, settings: RetargetSettings = DEFAULTS) -> Motion:
    source_map, target_map = find_humanoid_map(motion.skeleton), find_humanoid_map(rig)
    return retarget(motion, source_map, rig, target_map, settings=settings)


def role_position(motion: Motion, role: str) -> np.ndarray:
    joint = find_humanoid_map(motion.skeleton).indices(motion.skeleton)[role]
    return forward_kinematics(motion).positions[:, joint]


def bone(motion: Motion, start: str, stop: str) -> np.ndarray:
    direction = role_position(motion, stop) - role_position(motion, start)
    return direction / np.linalg.norm(direction, axis=1, keepdims=True)


def arm_length(motion: Motion, side: str) -> float:
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    roles = [f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"]
    positions = motion.skeleton.rest_positions[[joints[role] for role in roles]]
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())


def assert_equal_flags(found: np.ndarray, expected: np.ndarray) -> None:
    wrong = np.argwhere(found != expected)
    assert not len(wrong), wrong[:5]
