"""Legs that a sensor measured unequally long bend no knee of a body whose legs are equal."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import mixamo

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.motion import motion_from_points as from_points
from solvers.recordings import read_recording
from solvers.retargeting import RetargetSettings, retarget
from solvers.retargeting.leg_lengths import Leg, level_ankles
from solvers.samples import GaitSettings, walking_gait

STANDS = np.ones(1, dtype=np.bool_)
AS_EVER = RetargetSettings()


def test_ankles_differ_by_what_the_legs_explain():
    """Hips 1 m high, legs 1 m long and straight; the left ankle floats by 3 cm."""
    left = standing_leg(ankle=0.03, excess=-0.01)
    right = standing_leg(ankle=0.0, excess=0.01)

    lower, higher = level_ankles(left, right)

    assert_allclose([lower[0, 2], higher[0, 2]], [0.02, 0.01])


def test_a_step_in_the_ground_is_left_as_it_is():
    """The longer leg's foot is the higher one: it stands on something, with a bent knee."""
    left = standing_leg(ankle=0.0, excess=-0.01)
    right = standing_leg(ankle=0.2, excess=0.01)

    assert_allclose([ankle[0, 2] for ankle in level_ankles(left, right)], [0.0, 0.2])


@pytest.mark.parametrize("shorter", [1.01, 1.02, 1.03])
def test_knees_bend_as_the_sources_though_its_left_leg_is_shorter(shorter):
    """Before, two per cent bent the knee by up to 12 degrees more."""
    rig = mixamo()
    walk = given_to(walking_gait(GaitSettings(duration=2.0, frame_rate=60.0)), rig)
    uneven = walk_of(shortened(rig, shorter), walk)

    result = given_to(uneven, rig)

    for side in ("left", "right"):
        more = knee(result, side) - knee(uneven, side)
        assert np.abs(more).mean() < 1.0
        assert np.abs(more).max() < 4.5
    for name in ("LeftFoot", "RightFoot"):
        joint = rig.index(f"mixamorig:{name}")
        theirs, ours = (
            np.diff(forward_kinematics(motion).positions[:, joint], axis=0)
            for motion in (uneven, result)
        )
        growth = 2.0 / (1.0 + 1.0 / shorter)
        # The source's feet are not shortened with its leg: its ball goes a little farther.
        assert_allclose(ours, growth * theirs, atol=3e-4)


@pytest.mark.parametrize(
    ("file", "most"),
    [("kimore/JointPositionExercise1.csv", 6.0), ("laban/Ges01_wavehand.csv", 2.0)],
)
def test_who_stands_before_a_kinect_keeps_straight_knees(recordings, file, most):
    """Before, 18 and 10 degrees more than in the recording."""
    points = read_recording(recordings / "kinect" / file)
    motion = from_points(points.tracks, points.parents)

    result = given_to(motion, mixamo(), RetargetSettings(to_ground=True))

    for side in ("left", "right"):
        assert np.nanmedian(knee(result, side)) - np.nanmedian(knee(motion, side)) < most


def standing_leg(*, ankle: float, excess: float) -> Leg:
    hip = np.array([[0.0, 0.0, 1.0]])
    return Leg(hip, np.array([[0.0, 0.0, ankle]]), np.ones(1), STANDS, excess)


def shortened(rig: Skeleton, divisor: float) -> Skeleton:
    offsets = rig.offsets.copy()
    for name in ("LeftLeg", "LeftFoot"):
        offsets[rig.index(f"mixamorig:{name}")] /= divisor
    return Skeleton(rig.names, rig.parents, offsets)


def walk_of(rig: Skeleton, walk: Motion) -> Motion:
    return Motion(rig, walk.rotations, walk.root_positions, walk.frame_rate)


def given_to(motion: Motion, rig: Skeleton, settings: RetargetSettings = AS_EVER) -> Motion:
    maps = find_humanoid_map(motion.skeleton), find_humanoid_map(rig)
    return retarget(motion, maps[0], rig, maps[1], settings=settings)


def knee(motion: Motion, side: str) -> np.ndarray:
    """Degrees by which a knee is bent."""
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
    places = forward_kinematics(motion).positions[:, [joints[role] for role in roles]]
    thigh, shin = np.moveaxis(np.diff(places, axis=1), 1, 0)
    cosine = (
        (thigh * shin).sum(1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
    )
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
