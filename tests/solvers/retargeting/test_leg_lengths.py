"""Legs measured with unequal lengths flex no knee of a target with equal legs."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import mixamo

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.motion import motion_from_points as from_points
from solvers.recordings import read_recording
from solvers.retargeting import RetargetSettings, retarget
from solvers.retargeting.leg_lengths import TargetLeg, level_ankles
from solvers.samples import GaitSettings, walking_gait

STANDS = np.ones(1, dtype=np.bool_)
DEFAULTS = RetargetSettings()


def test_ankle_heights_are_corrected_by_the_leg_difference():
    """Hips at 1 m, straight legs of 1 m; the left ankle floats by 3 cm."""
    left = standing_leg(ankle=0.03, excess=-0.01)
    right = standing_leg(ankle=0.0, excess=0.01)

    lower, higher = level_ankles(left, right)

    assert_allclose([lower[0, 2], higher[0, 2]], [0.02, 0.01])


def test_step_in_the_ground_is_not_corrected():
    """The longer leg's foot is higher: it stands on an object with a flexed knee."""
    left = standing_leg(ankle=0.0, excess=-0.01)
    right = standing_leg(ankle=0.2, excess=0.01)

    assert_allclose([ankle[0, 2] for ankle in level_ankles(left, right)], [0.0, 0.2])


@pytest.mark.parametrize("shorter", [1.01, 1.02, 1.03])
def test_knee_flexion_ignores_a_shorter_left_leg_of_the_source(shorter):
    """Without correction, two percent flexed the knee by up to 12 degrees more."""
    rig = mixamo()
    walk = retargeted(walking_gait(GaitSettings(duration=2.0, frame_rate=60.0)), rig)
    uneven = walk_of(shortened(rig, shorter), walk)

    result = retargeted(uneven, rig)

    for side in ("left", "right"):
        more = knee_flexion_deg(result, side) - knee_flexion_deg(uneven, side)
        assert np.abs(more).mean() < 1.0
        assert np.abs(more).max() < 4.5
    for name in ("LeftFoot", "RightFoot"):
        joint = rig.index(f"mixamorig:{name}")
        reference, actual = (
            np.diff(forward_kinematics(motion).positions[:, joint], axis=0)
            for motion in (uneven, result)
        )
        growth = 2.0 / (1.0 + 1.0 / shorter)
        # The source's feet are not shortened with its leg, so its ball moves slightly farther.
        assert_allclose(actual, growth * reference, atol=4e-4)


@pytest.mark.parametrize(
    ("file", "maximum"),
    [("kimore/JointPositionExercise1.csv", 6.0), ("laban/Ges01_wavehand.csv", 2.0)],
)
def test_standing_kinect_actor_keeps_straight_knees(recordings, file, maximum):
    """Without correction, 18 and 10 degrees more than in the recording."""
    points = read_recording(recordings / "kinect" / file)
    motion = from_points(points.tracks, points.parents)

    result = retargeted(motion, mixamo(), RetargetSettings(to_ground=True))

    for side in ("left", "right"):
        assert (
            np.nanmedian(knee_flexion_deg(result, side))
            - np.nanmedian(knee_flexion_deg(motion, side))
            < maximum
        )


def standing_leg(*, ankle: float, excess: float) -> TargetLeg:
    hip = np.array([[0.0, 0.0, 1.0]])
    return TargetLeg(hip, np.array([[0.0, 0.0, ankle]]), np.ones(1), STANDS, excess)


def shortened(rig: Skeleton, divisor: float) -> Skeleton:
    offsets = rig.offsets.copy()
    for name in ("LeftLeg", "LeftFoot"):
        offsets[rig.index(f"mixamorig:{name}")] /= divisor
    return Skeleton(rig.names, rig.parents, offsets)


def walk_of(rig: Skeleton, walk: Motion) -> Motion:
    return Motion(rig, walk.rotations, walk.root_positions, walk.frame_rate)


def retargeted(motion: Motion, rig: Skeleton, settings: RetargetSettings = DEFAULTS) -> Motion:
    maps = find_humanoid_map(motion.skeleton), find_humanoid_map(rig)
    return retarget(motion, maps[0], rig, maps[1], settings=settings)


def knee_flexion_deg(motion: Motion, side: str) -> np.ndarray:
    """Flexion of a knee, degrees."""
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
    positions = forward_kinematics(motion).positions[:, [joints[role] for role in roles]]
    thigh, shin = np.moveaxis(np.diff(positions, axis=1), 1, 0)
    cosine = (
        (thigh * shin).sum(1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
    )
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
