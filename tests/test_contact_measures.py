"""Scores of contacts are what their columns say; takes and peers are what they claim."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.feet.legs import find_legs
from solvers.motion import Motion, forward_kinematics
from solvers.rotations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.contacts.detection_scores import DetectionScores
from tests.benchmarks.contacts.detectors import by_guo, by_holden, by_thresholds
from tests.benchmarks.contacts.force_plates import weighed_walks
from tests.benchmarks.contacts.made_takes import PLANS, made_takes
from tests.benchmarks.contacts.part_takes import acceleration_ratio
from tests.benchmarks.peers.blender_ik import has_blender, pin_in_blender


def contacts_of(*windows: tuple[int, int]) -> np.ndarray:
    """Both feet in contact in some windows of 60 frames."""
    contacts = np.zeros((60, 2), np.bool_)
    for start, stop in windows:
        contacts[start:stop] = True
    return contacts


def test_scores_of_a_late_and_a_missed_contact():
    scores = DetectionScores()

    scores.add(contacts_of((12, 20), (25, 27)), contacts_of((10, 20), (40, 50)), 30.0)

    assert scores.precision() == pytest.approx(8 / 10)
    assert scores.recall(0) == pytest.approx(8 / 20)
    assert scores.f1(1) == pytest.approx(2 * 8 / 30)
    assert scores.onset_errors == [2.0, 2.0]
    assert scores.n_onsets == 4


def test_frames_without_a_known_contact_are_not_scored():
    scores = DetectionScores()
    known = contacts_of((0, 30))

    scores.add(contacts_of((10, 20), (40, 50)), contacts_of((10, 20)), 30.0, known)

    assert scores.precision() == 1.0
    assert scores.onset_errors == [0.0, 0.0]


def test_a_knee_that_passes_half_a_turn_accelerates_as_before():
    """It turns evenly, then jumps by 46 degrees; planting adds 1 degree in all frames."""
    walk = walking_gait(GaitSettings(duration=1.0))
    knee = find_legs(walk.skeleton)[0].knee
    angles = np.linspace(2.0, 2.74, walk.n_frames)
    angles[walk.n_frames // 2 :] += 0.8
    given, planted = (
        bent(walk, knee, angles),
        bent(walk, knee, angles + np.radians(1.0)),
    )

    assert acceleration_ratio(given, planted, [knee]) == pytest.approx(1.0)


def bent(motion: Motion, knee: int, angles: np.ndarray) -> Motion:
    """Return the motion with a knee at angles in radians."""
    rotations = motion.rotations.copy()
    rotations[:, knee] = quaternion_from_rotation_vector(angles[:, None] * (1.0, 0.0, 0.0))
    return motion.with_poses(rotations)


@pytest.fixture(scope="module", params=[30.0, 120.0])
def made(request):
    """The made takes at a frame rate, by name."""
    return made_takes(request.param)


@pytest.mark.parametrize("name", PLANS)
def test_feet_of_made_takes_are_fixed_in_contact(made, name):
    take = made[name]
    legs = find_legs(take.motion.skeleton)
    joints = np.array([[leg.ankle, leg.toe] for leg in legs])
    feet = forward_kinematics(take.motion).positions[:, joints]

    both = take.contacts[1:] & take.contacts[:-1]
    steps = np.linalg.norm(np.diff(feet, axis=0), axis=-1).min(axis=-1)

    assert steps[both].max() < 1e-6


def test_rules_differ_in_height_and_speed():
    """A foot that moves at 0.5 m/s, 10 cm above the other, which rests."""
    feet = np.zeros((60, 2, 2, 3))
    feet[:, 0, :, 0] = 0.5 * np.arange(60)[:, None] / 30.0
    feet[:, 0, :, 2] = 0.1

    by_name = {one: one(feet, 30.0)[:, 0] for one in (by_thresholds, by_holden, by_guo)}

    assert not by_name[by_thresholds].any()
    assert by_name[by_holden].all() and by_name[by_guo].all()
    feet[:, 0, :, 2] = 0.2
    assert not by_holden(feet, 30.0)[:, 0].any()


def test_steps_on_force_plates_alternate(recordings):
    pytest.importorskip("ezc3d")
    walk = next(weighed_walks(100.0))

    left, right = (np.flatnonzero(np.diff(foot.astype(int)) > 0) for foot in walk.contacts.T)

    assert len(left) == 2 and len(right) == 1
    assert left[0] < right[0] < left[1]


@pytest.mark.skipif(not has_blender(), reason="Blender is no module of this Python")
def test_blenders_pins_reach_their_targets():
    walk = walking_gait(GaitSettings(duration=0.5, frame_rate=30.0))
    ankles = [leg.ankle for leg in find_legs(walk.skeleton)]
    feet = [leg.chain[2] for leg in find_legs(walk.skeleton)]
    targets = forward_kinematics(walk).positions[:, ankles] + (0.03, 0.0, 0.02)

    [(pinned, seconds)] = pin_in_blender([(walk, targets)])

    poses, before = forward_kinematics(pinned), forward_kinematics(walk)
    assert_allclose(poses.positions[:, ankles], targets, atol=1e-4)
    dots = np.abs(np.sum(poses.rotations[:, feet] * before.rotations[:, feet], axis=-1))
    assert_allclose(dots, 1.0, atol=1e-5)
    assert seconds > 0.0
