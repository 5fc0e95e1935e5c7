"""Spines distribute rotations, heads face as the source's, and feet stand on the ground."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import RIGS, mixamo, unreal

from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.recordings import read_bvh
from solvers.retargeting import RetargetSettings, retarget
from solvers.rotations.representations import (
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait

CMU_METERS = 0.0254 / 0.45
STAGE = np.array([0.0, 0.0, 3.0])
SWINGS = "solvers.retargeting.pose_transfer.leaning_swings"
TRUNK = ("hips", "spine", "chest", "upperChest")


@pytest.mark.parametrize(
    ("missing", "fractions"),
    [
        ((), (0.0, 1 / 3, 2 / 3, 1.0)),
        (("upperChest",), (0.0, 0.5, 1.0)),
        (("chest", "upperChest"), (0.0, 1.0)),
    ],
)
def test_bow_is_distributed_over_the_existing_spine(monkeypatch, missing, fractions):
    """Three vertebrae of the source flex by 20 degrees each; targets have three, two and one.

    This is before the trunk is rotated to lean as the source's.
    """
    monkeypatch.setattr(SWINGS, lambda *nothing: {})
    bow = bowing(20.0)
    target_map = without(find_humanoid_map(mixamo()), missing)

    result = retarget(bow, find_humanoid_map(bow.skeleton), mixamo(), target_map)

    found = [lean_deg(result, target_map, role) for role in TRUNK if role in target_map.joints]
    assert_allclose(found, 60.0 * np.array(fractions), atol=1e-4)


@pytest.mark.parametrize("missing", [("upperChest",), ("chest", "upperChest")])
def test_bow_of_few_vertebrae_is_distributed_over_many(monkeypatch, missing):
    monkeypatch.setattr(SWINGS, lambda *nothing: {})
    bow = bowing(20.0)
    source_map = without(find_humanoid_map(bow.skeleton), missing)
    target_map = find_humanoid_map(mixamo())

    result = retarget(bow, source_map, mixamo(), target_map)

    top = [role for role in TRUNK if role in source_map.joints][-1]
    complete = lean_deg(bow, source_map, top)
    found = [lean_deg(result, target_map, role) for role in TRUNK]
    assert found[-1] == pytest.approx(complete, abs=1e-4)
    assert (np.diff(found) > 0.1 * complete).all()


@pytest.mark.parametrize("family", RIGS)
@pytest.mark.parametrize(
    "missing", [(), ("neck",), ("chest",), ("leftShoulder", "rightShoulder")]
)
def test_chest_head_and_hands_rotate_as_in_the_source(family, missing):
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    source_map = without(find_humanoid_map(walk.skeleton), missing)
    rig = RIGS[family](1.1)
    target_map = find_humanoid_map(rig)

    result = retarget(walk, source_map, rig, target_map)

    for role in ("head", "leftHand", "rightHand", "leftFoot"):
        change = [rotations_since_start(m, roles, role) for m, roles in
                  ((walk, source_map), (result, target_map))]  # fmt: skip
        # A foot turns a little so that its ankle and sole are where they should be.
        assert angle_between(*change).max() < (0.06 if role == "leftFoot" else 1e-6), role


@pytest.mark.parametrize("family", RIGS)
@pytest.mark.parametrize("size", [0.5, 1.0, 2.0])
def test_standing_feet_are_on_the_ground(recordings, family, size):
    """Rigs stand on height 0 in their rest pose; ankles return to that height."""
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh", scale=CMU_METERS)
    walk = walk.slice(1, walk.n_frames)
    rig = RIGS[family](size)
    roles = find_humanoid_map(rig)

    result = retarget(walk, find_humanoid_map(walk.skeleton), rig, roles)

    contacts = detect_contacts(walk)
    joints = roles.indices(rig)
    for side, name in enumerate(("leftFoot", "rightFoot")):
        ankle = forward_kinematics(result).positions[contacts[:, side], joints[name], 2]
        standing = rig.rest_positions[joints[name], 2]
        assert np.percentile(ankle, 20) == pytest.approx(standing, abs=0.02 * size)


def test_body_with_hips_at_the_origin_keeps_its_height(recordings):
    """CMU skeletons have hips at 0 and no soles; a walk keeps its height approximately."""
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh", scale=CMU_METERS)
    walk = walk.slice(1, walk.n_frames)
    roles = find_humanoid_map(walk.skeleton)

    again = retarget(walk, roles, walk.skeleton, roles)

    shift = again.root_positions - walk.root_positions
    assert np.abs(shift).max() < 0.025
    joints = [roles.indices(walk.skeleton)[role] for role in ("leftLowerLeg", "rightLowerArm")]
    assert angle_between(again.rotations, walk.rotations)[:, joints].max() < 1e-3


def test_source_on_a_stage_keeps_its_height():
    """A floor at 3 m remains at 3 m."""
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    raised = walk.with_poses(root_positions=walk.root_positions + STAGE)
    maps = find_humanoid_map(walk.skeleton), find_humanoid_map(unreal())

    low, high = (retarget(motion, maps[0], unreal(), maps[1]) for motion in (walk, raised))
    down = RetargetSettings(to_ground=True)
    put_down = retarget(raised, maps[0], unreal(), maps[1], settings=down)

    shift = (high.root_positions - low.root_positions)[:, 2]
    assert_allclose(shift, 3.0, atol=0.05)
    assert np.ptp(shift) < 1e-9
    assert_allclose(put_down.root_positions, low.root_positions, atol=1e-9)


def bowing(angle: float) -> Motion:
    rig: Skeleton = mixamo()
    rotations = np.zeros((3, rig.n_joints, 3))
    for name in ("Spine", "Spine1", "Spine2"):
        rotations[:, rig.index(f"mixamorig:{name}"), 0] = np.radians(angle)
    positions = np.tile(rig.offsets[0], (3, 1))
    return Motion(rig, quaternion_from_rotation_vector(rotations), positions, 30.0)


def without(humanoid: HumanoidMap, missing: tuple[str, ...]) -> HumanoidMap:
    for role in missing:
        humanoid = humanoid.with_joint(role, None)
    return humanoid


def lean_deg(motion: Motion, humanoid: HumanoidMap, role: str) -> float:
    """Lean of a joint in the world relative to its rest pose in the first frame, degrees."""
    joint = humanoid.indices(motion.skeleton)[role]
    rotation = forward_kinematics(motion).rotations[0, joint]
    return float(np.degrees(2.0 * np.arccos(min(abs(rotation[0]), 1.0))))


def rotations_since_start(motion: Motion, humanoid: HumanoidMap, role: str) -> np.ndarray:
    """World rotations relative to the first frame, about the world's axes."""
    rotations = forward_kinematics(motion).rotations[:, humanoid.indices(motion.skeleton)[role]]
    return multiply(rotations, inverse(rotations[:1]))
