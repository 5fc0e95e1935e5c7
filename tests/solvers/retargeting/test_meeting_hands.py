"""Hands that meet in the source meet on other bodies, as far as their arms reach."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from retargeted_motions import flexion_axis, given_to, role_positions
from rigs import RIGS, mixamo

from solvers.motion import HumanoidMap, Motion, Skeleton, find_humanoid_map
from solvers.retargeting import RetargetSettings
from solvers.retargeting.hand_paths import HandPath, Meeting
from solvers.rotations.representations import quaternion_from_rotation_vector

ARM = ("UpperArm", "LowerArm", "Hand")
DEFAULTS = RetargetSettings()


@pytest.mark.parametrize("family", RIGS)
def test_hands_that_meet_in_the_source_meet(family):
    """Clapping in front of the chest, on a rig with broad shoulders."""
    body, rig = mixamo(), with_broad_shoulders(RIGS[family](1.1))
    clapping = claps(body)

    result = given_to(clapping, rig)
    separate = given_to(clapping, rig, RetargetSettings(keep_hands=False))

    distances, actual, without = (
        hand_distance(motion) for motion in (clapping, result, separate)
    )
    closed, open_ = distances < 0.08, distances > 0.6
    growth = arm_length(rig) / arm_length(body)
    assert closed.sum() >= 5 and open_.sum() >= 5
    assert np.abs(actual - growth * distances)[closed].max() < 0.005
    assert np.abs(without - growth * distances)[closed].min() > 0.03
    assert actual[open_].min() > 0.6


def test_arms_too_short_for_hands_to_meet_do_not_snap():
    """Shoulders half a meter too far apart: the hands come nearer, with elbows still bent."""
    body, rig = mixamo(), with_broad_shoulders(mixamo(1.0), 0.25)
    clapping = claps(body, flexion=0.8)

    result = given_to(clapping, rig)
    separate = given_to(clapping, rig, RetargetSettings(keep_hands=False))

    assert hand_distance(result).min() < hand_distance(separate).min() - 0.2
    for side in ("left", "right"):
        bend = np.linalg.norm(flexion_axis(result, side, ARM), axis=1)
        assert np.degrees(np.arcsin(bend)).min() > 3.0
        assert np.degrees(np.abs(np.diff(np.arcsin(bend)))).max() < 5.0


def test_hands_that_only_come_near_each_other_keep_their_paths():
    """At a third of an arm from each other, with a tenth of the weight of hands that meet."""
    free, wanted = np.array([[0.20, 0.0, 0.0]]), np.array([[0.10, 0.0, 0.0]])
    paths = [
        HandPath(side, (0, 1, 2), 0.5, path, None)
        for side, path in (("left", free), ("right", 0.0 * free))
    ]

    found = Meeting(wanted, np.array([0.1])).wanted(*paths)

    assert_allclose(found, [[0.19, 0.0, 0.0]])


def hand_distance(motion: Motion) -> np.ndarray:
    positions = role_positions(motion)
    return np.linalg.norm(positions["leftHand"] - positions["rightHand"], axis=1)


def with_broad_shoulders(rig: Skeleton, by: float = 0.05) -> Skeleton:
    joints = find_humanoid_map(rig).indices(rig)
    offsets = rig.offsets.copy()
    for role, offset in (("leftUpperArm", by), ("rightUpperArm", -by)):
        offsets[joints[role], 0] += offset
    return Skeleton(rig.names, rig.parents, offsets)


def arm_length(rig: Skeleton) -> float:
    joints = find_humanoid_map(rig).indices(rig)
    positions = rig.rest_positions[[joints[f"left{part}"] for part in ARM]]
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())


def claps(body: Skeleton, flexion: float = 0.0) -> Motion:
    """Level arms that swing together until the wrists touch, and open; bent by an angle."""
    joints = HumanoidMap(find_humanoid_map(body).joints).indices(body)
    half_width = body.rest_positions[joints["leftUpperArm"], 0]
    arm = body.rest_positions[joints["leftHand"], 0] - half_width
    arm *= np.cos(0.5 * flexion)
    inwards = np.arcsin((half_width - 0.02) / arm)
    openness = 0.5 - 0.5 * np.cos(np.linspace(0, 4 * np.pi, 121))
    angle = np.pi / 2 + inwards - (inwards + 0.6) * openness
    vectors = np.zeros((121, body.n_joints, 3))
    for side, sign in (("left", -1.0), ("right", 1.0)):
        vectors[:, joints[f"{side}UpperArm"], 2] = sign * (angle - 0.5 * flexion)
        vectors[:, joints[f"{side}LowerArm"], 2] = sign * flexion
    rotations = quaternion_from_rotation_vector(vectors)
    return Motion(body, rotations, np.tile(body.offsets[0], (121, 1)), 60.0)
