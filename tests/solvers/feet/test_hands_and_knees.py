"""Hands and knees that bear on the floor stay in place, and no others."""

import numpy as np
import pytest

from solvers.feet import PlantSettings, find_legs, plant_feet
from solvers.feet.body_supports import LIMBS, detect_supports
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.recordings import read_acclaim
from tests.benchmarks.contacts.made_supports import joints_of, made_supports
from tests.benchmarks.contacts.part_takes import INPUTS, acceleration_ratio

MADE = made_supports(30.0)
ELBOWS, KNEES = ("LeftForeArm", "RightForeArm"), ("LeftLeg", "RightLeg")
FEET_ALONE = PlantSettings(hands_and_knees=False)


def detect(motion: Motion) -> np.ndarray:
    humanoid = find_humanoid_map(motion.skeleton)
    return detect_supports(motion, humanoid, find_legs(motion.skeleton, humanoid))


def drifting(motion: Motion) -> Motion:
    """Return the body, which drifts to and fro by 4 cm."""
    time = np.arange(motion.n_frames) / motion.frame_rate
    root = motion.root_positions.copy()
    root[:, 0] += 0.02 * np.sin(2.0 * np.pi * 0.25 * time)
    return motion.with_poses(root_positions=root)


def spread(motion: Motion, support: str) -> float:
    """Return the horizontal distance in meters over which a hand or knee moves."""
    joint = motion.skeleton.index(joints_of(support)[0])
    return float(np.ptp(forward_kinematics(motion).positions[:, joint, :2], axis=0).max())


@pytest.mark.parametrize("name", MADE)
def test_contacts_of_made_bodies_are_found(name):
    take = MADE[name]

    found = detect(take.motion)

    both = (found & take.contacts).sum()
    assert both >= 0.85 * take.contacts.sum()
    assert both >= 0.95 * found.sum()


def test_drifting_body_keeps_hands_and_knees_in_place():
    given = drifting(MADE["on hands and knees"].motion)

    planted = plant_feet(given)

    assert planted.supports[:, : len(LIMBS)].all()
    for support in LIMBS:
        assert spread(given, support) > 0.035
        assert spread(planted.motion, support) < 0.006  # the hand turns by a degree or two
    trunk = [given.skeleton.index(name) for name in ("Hips", "Spine2", "Head", "LeftShoulder")]
    assert (planted.motion.rotations[:, trunk] == given.rotations[:, trunk]).all()


@pytest.mark.parametrize(("joints", "most"), [(ELBOWS, 1.2), (KNEES, 4.0)])
def test_knees_and_elbows_do_not_take_the_jitter_of_the_root(joints, most):
    """They hardly move as given; the root jitters by 1 cm."""
    given = INPUTS["a root that jitters by 1 cm"](MADE["on hands and knees"].motion)

    planted = plant_feet(given).motion

    indices = [given.skeleton.index(name) for name in joints]
    assert acceleration_ratio(given, planted, indices) < most


def test_arms_stay_as_they_are_with_feet_alone():
    given = drifting(MADE["push-ups"].motion)

    planted = plant_feet(given, settings=FEET_ALONE)

    arms = given.skeleton.subtree(given.skeleton.index("LeftArm"))
    assert planted.supports is None
    assert (planted.motion.rotations[:, arms] == given.rotations[:, arms]).all()
    assert plant_feet(given).supports[:, :2].all()


def test_given_contacts_of_hands_replace_those_detected():
    given = drifting(MADE["push-ups"].motion)
    contacts = np.zeros((given.n_frames, 7), dtype=np.bool_)
    contacts[30:90, 2] = True

    planted = plant_feet(given, contacts)

    assert (planted.all_contacts == contacts).all()
    hand = given.skeleton.index("LeftHand")
    path, before = (
        forward_kinematics(motion).positions[30:90, hand, 0]
        for motion in (planted.motion, given)
    )
    assert np.ptp(path) < 0.2 * np.ptp(before)
    arm = given.skeleton.index("RightArm")
    assert (planted.motion.rotations[:, arm] == given.rotations[:, arm]).all()


def test_hands_of_a_body_that_lies_are_free(recordings):
    """The hand supports the body while it comes down; the hips come to rest after 2.7 s."""
    motion = read_acclaim(recordings / "mocap/hdm05/HDM_bd_lieDownFloor_002_120.amc")

    contacts = detect(motion)

    assert contacts[260:320, LIMBS.index("leftHand")].all()
    assert not contacts[:200].any()
    assert not contacts[360:, : len(LIMBS)].any()
