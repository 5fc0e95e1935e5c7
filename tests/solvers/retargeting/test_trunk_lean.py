"""In a bow the neck moves as the source's, for any positions of the vertebrae."""

import numpy as np
import pytest
from rigs import RIGS, mixamo, rigify_deform

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.retargeting import retarget
from solvers.rotations.representations import (
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.mark.parametrize("family", RIGS)
def test_deep_bow_leans_as_the_source(family):
    """Most of it is in the lowest vertebra, at another position in the rigs.

    In between, the error may be slightly larger, since the correction is blended in.
    """
    bow = bowing(mixamo(), 70.0)

    result = retargeted(bow, RIGS[family]())

    reference, actual = (lean_deg(motion) for motion in (bow, result))
    assert reference[-1] - reference[0] > 50.0
    errors = np.abs((actual - actual[0]) - (reference - reference[0]))
    assert errors.max() < 4.0
    assert errors[-1] < 3.0


def test_deep_bow_leans_differently_without_the_correction(monkeypatch):
    """Rigify's spine leans by 9 degrees more or less."""
    monkeypatch.setattr("solvers.retargeting.pose_transfer.leaning_swings", lambda *nothing: {})
    bow = bowing(mixamo(), 70.0)

    reference, result = (lean_deg(motion) for motion in (bow, retargeted(bow, rigify_deform())))

    assert np.abs((result - result[0]) - (reference - reference[0])).max() > 3.0


@pytest.mark.parametrize("family", RIGS)
def test_segment_of_a_take_leans_as_within_the_take(family):
    """Also where the segment is only the bow, or a single frame."""
    bow = bowing(mixamo(), 70.0)
    complete = lean_deg(retargeted(bow, RIGS[family]()))

    for first, last in ((40, 60), (0, 35), (59, 60)):
        cut = retargeted(bow.slice(first, last), RIGS[family]())
        assert lean_deg(cut) == pytest.approx(complete[first:last], abs=1e-6)


def test_heads_and_arms_keep_their_rotations():
    bow = bowing(mixamo(), 70.0)
    rig = rigify_deform()

    result = retargeted(bow, rig)

    reference, actual = (world_rotations(motion) for motion in (bow, result))
    for role in ("head", "leftHand", "rightHand"):
        assert angle_between(
            rotations_since(actual[role]), rotations_since(reference[role])
        ).max() == pytest.approx(0.0, abs=1e-6)


def test_walk_hardly_changes(monkeypatch):
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    result = retargeted(walk, rigify_deform())
    monkeypatch.setattr("solvers.retargeting.pose_transfer.leaning_swings", lambda *nothing: {})

    default = retargeted(walk, rigify_deform())

    positions = [forward_kinematics(motion).positions for motion in (result, default)]
    assert np.abs(positions[0] - positions[1]).max() < 0.01


def bowing(rig: Skeleton, degrees: float) -> Motion:
    """Upright for a second, then a bow, mostly in the lower spine."""
    angle = np.radians(degrees) * np.clip(np.linspace(-1.0, 1.0, 60), 0.0, 1.0)
    vectors = np.zeros((60, rig.n_joints, 3))
    for name, fraction in (("Spine", 0.8), ("Spine1", 0.1), ("Spine2", 0.1)):
        vectors[:, rig.index(f"mixamorig:{name}"), 0] = fraction * angle
    positions = np.tile(rig.offsets[0], (60, 1))
    return Motion(rig, quaternion_from_rotation_vector(vectors), positions, 30.0)


def lean_deg(motion: Motion) -> np.ndarray:
    """Forward lean of the line from hips to neck, degrees."""
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions
    direction = positions[:, joints["neck"]] - positions[:, joints["hips"]]
    return np.degrees(np.arctan2(-direction[:, 1], direction[:, 2]))


def world_rotations(motion: Motion) -> dict[str, np.ndarray]:
    rotations = forward_kinematics(motion).rotations
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return {role: rotations[:, joint] for role, joint in joints.items()}


def rotations_since(rotations: np.ndarray) -> np.ndarray:
    return multiply(rotations, inverse(rotations[:1]))


def retargeted(motion: Motion, rig: Skeleton) -> Motion:
    return retarget(motion, find_humanoid_map(motion.skeleton), rig, find_humanoid_map(rig))
