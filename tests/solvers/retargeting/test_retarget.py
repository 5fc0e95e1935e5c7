"""Another body makes the same motion: directions, paths and contacts, in any rest pose."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import RIGS, mixamo, unreal

from solvers.errors import InvalidMotionError
from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    foot_points,
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

CMU_METRES = 0.0254 / 0.45
AS_EVER = RetargetSettings()


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=4.0, frame_rate=60.0))


@pytest.mark.parametrize("family", RIGS)
def test_bones_point_where_the_sources_do(walk, family):
    """Without limbs being brought anywhere, each bone is parallel to its model."""
    rig = RIGS[family]()
    settings = RetargetSettings(keep_feet=False, keep_hands=False)

    result = given_to(walk, rig, settings)

    for start, stop in (
        ("UpperArm", "LowerArm"),
        ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"),
    ):
        for side in ("left", "right"):
            theirs = bone(walk, side + start, side + stop)
            ours = bone(result, side + start, side + stop)
            assert_allclose(ours, theirs, atol=1e-9)


def test_the_same_body_makes_the_same_motion(walk):
    result = given_to(walk, walk.skeleton)

    assert angle_between(result.rotations, walk.rotations).max() < 1e-6
    shift = result.root_positions - walk.root_positions
    assert np.ptp(shift, axis=0).max() < 1e-6


@pytest.mark.parametrize("family", RIGS)
@pytest.mark.parametrize("size", [0.6, 1.0, 1.5])
def test_feet_and_hands_follow_paths_scaled_by_the_limb(walk, family, size):
    rig = RIGS[family](size)

    result = given_to(walk, rig)

    growth = leg_length(rig, find_humanoid_map(rig)) / leg_length(
        walk.skeleton, find_humanoid_map(walk.skeleton)
    )
    for side in ("left", "right"):
        theirs, ours = place(walk, f"{side}Foot"), place(result, f"{side}Foot")
        error = (ours - ours[0]) - growth * (theirs - theirs[0])
        # Feet of other lengths that roll over their balls take their ankles along.
        assert np.linalg.norm(error, axis=1).max() < 0.025 * size
        arms = [
            place(motion, f"{side}Hand") - place(motion, f"{side}UpperArm")
            for motion in (walk, result)
        ]
        arm_growth = arm_length(result, side) / arm_length(walk, side)
        assert_allclose(arms[1], arm_growth * arms[0], atol=1e-6)


@pytest.mark.parametrize("family", RIGS)
def test_twist_bones_and_fingers_without_a_model_stay_at_rest(walk, family):
    rig = RIGS[family]()
    roles = set(find_humanoid_map(rig).joints.values())

    result = given_to(walk, rig)

    idle = [joint for joint, name in enumerate(rig.names) if name not in roles]
    assert idle
    assert_allclose(result.rotations[:, idle], np.broadcast_to(IDENTITY, (240, len(idle), 4)))


@pytest.mark.parametrize("family", RIGS)
def test_no_foot_slides_more_than_in_a_real_walk(recordings, family):
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh", scale=CMU_METRES)
    walk = walk.slice(1, walk.n_frames)
    rig = RIGS[family]()

    result = given_to(walk, rig)

    growth = leg_length(rig, find_humanoid_map(rig)) / leg_length(
        walk.skeleton, find_humanoid_map(walk.skeleton)
    )
    contacts = detect_contacts(walk)
    held = contacts[1:] & contacts[:-1]
    theirs, ours = (slower_steps(motion)[held] for motion in (walk, result))
    assert (ours - growth * theirs).max() < 1e-3
    assert ours.mean() < growth * theirs.mean()


def test_gaps_stay_gaps_and_spread_to_nothing_else(walk):
    rotations, places = walk.rotations.copy(), walk.root_positions.copy()
    rotations[10:20, walk.skeleton.index("LeftForeArm")] = np.nan
    rotations[50:60, walk.skeleton.index("Spine1")] = np.nan
    places[100:110] = np.nan
    rig = mixamo()

    result = given_to(walk.with_poses(rotations, places), rig)

    expected = np.zeros((240, rig.n_joints), dtype=bool)
    expected[10:20, rig.index("mixamorig:LeftForeArm")] = True
    expected[50:60, rig.index("mixamorig:Spine1")] = True
    assert_equal_flags(np.isnan(result.rotations).all(axis=-1), expected)
    assert_equal_flags(np.isnan(result.root_positions[:, 0]), np.isnan(places[:, 0]))


def test_in_place_takes_the_travel_out(walk):
    still = given_to(walk, mixamo(), RetargetSettings(root_motion=RootMotion.IN_PLACE))
    kept = given_to(walk, mixamo())

    assert np.linalg.norm(np.ptp(kept.root_positions[:, :2], axis=0)) > 2.0
    assert np.linalg.norm(np.ptp(still.root_positions[60:-60, :2], axis=0)) < 0.1
    assert_allclose(still.root_positions[:, 2], kept.root_positions[:, 2], atol=1e-12)


def test_a_root_bone_carries_the_body_without_changing_it(walk):
    kept = given_to(walk, unreal())
    carried = given_to(walk, unreal(), RetargetSettings(root_motion=RootMotion.ROOT_BONE))

    assert_allclose(kept.rotations[:, 0], np.tile(IDENTITY, (240, 1)))
    assert angle_between(carried.rotations[:, 0], carried.rotations[0, 0]).max() > 0.01
    assert_allclose(
        forward_kinematics(carried).positions[:, 1:],
        forward_kinematics(kept).positions[:, 1:],
        atol=1e-9,
    )


def test_says_what_is_missing(walk):
    roles = find_humanoid_map(walk.skeleton)
    nobody = HumanoidMap({})

    with pytest.raises(
        InvalidMotionError, match="source's skeleton has the humanoid role hips"
    ):
        retarget(walk, nobody, mixamo(), find_humanoid_map(mixamo()))
    with pytest.raises(
        InvalidMotionError, match="target's skeleton has the humanoid role hips"
    ):
        retarget(walk, roles, mixamo(), nobody)
    with pytest.raises(InvalidMotionError, match="no joint above the hips"):
        given_to(walk, mixamo(), RetargetSettings(root_motion=RootMotion.ROOT_BONE))


def test_hips_alone_are_enough():
    box = Skeleton(("hips", "lid"), (-1, 0), np.array([[0, 0, 1.0], [0, 0, 0.5]]))
    turn = quaternion_from_rotation_vector([[[0, 0, 0.3], [0, 0, 0]]])
    motion = Motion(box, turn, np.array([[0, 0, 2.0]]), 30.0)

    result = retarget(motion, HumanoidMap({"hips": "hips"}), box, HumanoidMap({"hips": "hips"}))

    assert_allclose(result.rotations, motion.rotations, atol=1e-12)


def given_to(motion: Motion, rig: Skeleton, settings: RetargetSettings = AS_EVER) -> Motion:
    source_map, target_map = find_humanoid_map(motion.skeleton), find_humanoid_map(rig)
    return retarget(motion, source_map, rig, target_map, settings=settings)


def place(motion: Motion, role: str) -> np.ndarray:
    joint = find_humanoid_map(motion.skeleton).indices(motion.skeleton)[role]
    return forward_kinematics(motion).positions[:, joint]


def bone(motion: Motion, start: str, stop: str) -> np.ndarray:
    way = place(motion, stop) - place(motion, start)
    return way / np.linalg.norm(way, axis=1, keepdims=True)


def arm_length(motion: Motion, side: str) -> float:
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    roles = [f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"]
    places = motion.skeleton.rest_positions[[joints[role] for role in roles]]
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def assert_equal_flags(found: np.ndarray, expected: np.ndarray) -> None:
    wrong = np.argwhere(found != expected)
    assert not len(wrong), wrong[:5]


def slower_steps(motion: Motion) -> np.ndarray:
    """How far the slower of ankle and ball goes, level, (n_frames - 1, 2), metres."""
    feet = foot_points(motion.skeleton, find_humanoid_map(motion.skeleton))
    steps = np.diff(forward_kinematics(motion).positions[:, feet, :2], axis=0)
    return np.linalg.norm(steps, axis=-1).min(axis=-1)
