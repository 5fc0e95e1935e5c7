"""Poses that few takes hold: each is what one constant of retargeting guards."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import mixamo

from solvers.motion import find_humanoid_map
from solvers.retargeting.body import find_body
from solvers.retargeting.hand_distance import Arms, match_meeting_hands
from solvers.retargeting.hand_heights import (
    GroundHeights,
    ease_into_extension,
    pull_to_ground,
)
from solvers.retargeting.placement import (
    HipPlacement,
    ankle_height,
    find_placement,
    leg_length,
    rests_on_ground,
    standing_ankle,
)

RATE = 120.0
GROUND = GroundHeights(
    HipPlacement(1.0, 1.0, np.zeros(3), (0.0, 0.0), (0.0, 0.0)), (0.0, 0.0), 0.9, RATE
)
ASIDE = np.array([0.0, 0.2, 0.0])


@pytest.fixture(scope="module")
def body():
    rig = mixamo()
    return find_body(rig, find_humanoid_map(rig), "The target")


def moved(body, height):
    """The same body, with its rest pose higher by some meters."""
    offsets = body.skeleton.offsets.copy()
    offsets[0, 2] += height
    return replace(body, skeleton=replace(body.skeleton, offsets=offsets))


def positions(*heights):
    """Points at these heights above one place, shape (n, 3)."""
    return np.array([(0.0, 0.0, height) for height in heights])


def test_hands_that_nearly_touch_keep_the_distance_of_the_source():
    shoulders = np.array([[[0.2, 0.0, 1.4]], [[-0.2, 0.0, 1.4]]])
    apart = np.array([[[0.3, -0.3, 1.3]], [[-0.3, -0.3, 1.3]]])
    separation = np.array([[0.05, 0.0, 0.0]])

    left, right = match_meeting_hands(Arms(shoulders, apart, np.full(2, 0.6)), separation)

    assert_allclose(left - right, separation, atol=1e-12)


def test_arms_too_short_for_hands_to_meet_stay_bent():
    shoulders = np.array([[[0.2, 0.0, 1.4]], [[-0.2, 0.0, 1.4]]])
    far = np.array([[[0.3, -0.6, 1.4]], [[-0.3, -0.6, 1.4]]])
    arms = Arms(shoulders, far, np.full(2, 0.5))

    hands = match_meeting_hands(arms, np.zeros((1, 3)))

    assert np.linalg.norm(hands - shoulders, axis=-1).max() < 0.5 * 0.9995


def test_hand_that_sweeps_over_the_ground_is_not_pulled_where_it_turns():
    """It stands for an instant there, as a hand does that supports the body."""
    time = np.arange(240) / RATE
    source = np.stack([0.3 * np.sin(4 * np.pi * time), 0 * time, 0 * time + 0.05], axis=1)
    hand = source + ASIDE

    found = pull_to_ground(hand, source, positions(*[0.4] * 240), 0.6, GROUND)

    assert np.abs(found - hand)[:, 1].max() < 0.01


def test_hand_that_supports_the_body_is_pulled_to_its_position():
    """It rolls by a decimeter per second."""
    source = positions(*[0.05] * 60) + np.linspace(0.0, 0.05, 60)[:, None] * (1.0, 0.0, 0.0)

    found = pull_to_ground(source + ASIDE, source, positions(*[0.4] * 60), 0.6, GROUND)

    assert_allclose(found, source, atol=1e-9)


def test_arm_does_not_snap_straight_where_the_ground_is_out_of_reach():
    """The elbow of two bones of 0.3 m, with the hand's goal moving away at 1 m/s."""
    goals = positions(*np.arange(0.4, 0.8, 1.0 / RATE))

    reached = ease_into_extension(goals, positions(*[0.4] * len(goals)), 0.6)

    elbow = 2.0 * np.arcsin(np.linalg.norm(reached, axis=1) / 0.6)
    assert np.degrees(np.diff(elbow)).max() < 4.0


@pytest.mark.parametrize("height", [-0.015, 0.0, 0.05])
def test_rig_that_stands_about_on_height_zero_rests_on_the_ground(body, height):
    assert rests_on_ground(moved(body, height))


@pytest.mark.parametrize("height", [-0.9, -0.04, 0.5])
def test_rig_with_its_origin_elsewhere_does_not_rest_on_the_ground(body, height):
    assert not rests_on_ground(moved(body, height))


@pytest.mark.parametrize(("height", "floor"), [(0.08, 0.0), (-0.08, 0.0), (0.5, 0.5)])
def test_ground_nearly_at_zero_is_at_zero_and_a_stage_is_not(body, height, floor):
    rest = body.rest[np.newaxis]
    ankle = standing_ankle(body) + height

    placement = find_placement(body, body, rest, ankle, travel=0.0, to_ground=False)

    assert_allclose(placement.floors[1], floor, atol=1e-12)
    assert leg_length(body) * 0.15 > 0.08


def test_ankle_height_is_that_of_flat_feet_if_most_contacts_are_on_tiptoe(body):
    frames = np.tile(body.rest, (100, 1, 1))
    flat = frames[0, body.joints["leftFoot"], 2]
    frames[:60, :, 2] += 0.1
    frames[95:, :, 2] -= 0.05

    height = ankle_height(body, frames, np.ones((100, 2), bool))

    assert_allclose(height, flat, atol=1e-9)
