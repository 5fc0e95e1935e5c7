"""In a bow the neck is where the source's is, wherever the vertebrae lie."""

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
def test_a_deep_bow_leans_as_the_sources(family):
    """Most of it in the lowest vertebra, which the rigs have elsewhere.

    On its way it may be off by a little more, as the swing comes gradually.
    """
    bow = bowing(mixamo(), 70.0)

    result = given_to(bow, RIGS[family]())

    theirs, ours = (lean(motion) for motion in (bow, result))
    assert theirs[-1] - theirs[0] > 50.0
    off = np.abs((ours - ours[0]) - (theirs - theirs[0]))
    assert off.max() < 4.0
    assert off[-1] < 3.0


def test_without_the_swing_it_would_not(monkeypatch):
    """The bow is deep enough to tell: Rigify's spine leans by 9 degrees more or less."""
    monkeypatch.setattr("solvers.retargeting.pose_transfer.leaning_swings", lambda *nothing: {})
    bow = bowing(mixamo(), 70.0)

    theirs, ours = (lean(motion) for motion in (bow, given_to(bow, rigify_deform())))

    assert np.abs((ours - ours[0]) - (theirs - theirs[0])).max() > 3.0


@pytest.mark.parametrize("family", RIGS)
def test_a_cut_of_a_take_leans_as_within_it(family):
    """Even where all that is left of it is the bow, and where it is a single frame."""
    bow = bowing(mixamo(), 70.0)
    whole = lean(given_to(bow, RIGS[family]()))

    for first, last in ((40, 60), (0, 35), (59, 60)):
        cut = given_to(bow.slice(first, last), RIGS[family]())
        assert lean(cut) == pytest.approx(whole[first:last], abs=1e-6)


def test_heads_and_arms_keep_their_turns():
    bow = bowing(mixamo(), 70.0)
    rig = rigify_deform()

    result = given_to(bow, rig)

    theirs, ours = (turns(motion) for motion in (bow, result))
    for role in ("head", "leftHand", "rightHand"):
        assert angle_between(
            turned_since(ours[role]), turned_since(theirs[role])
        ).max() == pytest.approx(0.0, abs=1e-6)


def test_a_walk_is_hardly_touched(monkeypatch):
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    result = given_to(walk, rigify_deform())
    monkeypatch.setattr("solvers.retargeting.pose_transfer.leaning_swings", lambda *nothing: {})

    usual = given_to(walk, rigify_deform())

    places = [forward_kinematics(motion).positions for motion in (result, usual)]
    assert np.abs(places[0] - places[1]).max() < 0.01


def bowing(rig: Skeleton, degrees: float) -> Motion:
    """Upright for a second, then a bow: most of it low down."""
    angle = np.radians(degrees) * np.clip(np.linspace(-1.0, 1.0, 60), 0.0, 1.0)
    vectors = np.zeros((60, rig.n_joints, 3))
    for name, share in (("Spine", 0.8), ("Spine1", 0.1), ("Spine2", 0.1)):
        vectors[:, rig.index(f"mixamorig:{name}"), 0] = share * angle
    places = np.tile(rig.offsets[0], (60, 1))
    return Motion(rig, quaternion_from_rotation_vector(vectors), places, 30.0)


def lean(motion: Motion) -> np.ndarray:
    """Degrees by which the line from hips to neck leans forward."""
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    places = forward_kinematics(motion).positions
    way = places[:, joints["neck"]] - places[:, joints["hips"]]
    return np.degrees(np.arctan2(-way[:, 1], way[:, 2]))


def turns(motion: Motion) -> dict[str, np.ndarray]:
    rotations = forward_kinematics(motion).rotations
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return {role: rotations[:, joint] for role, joint in joints.items()}


def turned_since(rotations: np.ndarray) -> np.ndarray:
    return multiply(rotations, inverse(rotations[:1]))


def given_to(motion: Motion, rig: Skeleton) -> Motion:
    return retarget(motion, find_humanoid_map(motion.skeleton), rig, find_humanoid_map(rig))
