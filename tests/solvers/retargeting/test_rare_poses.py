"""Poses that few takes hold: each is what one constant of retargeting guards."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import mixamo

from solvers.motion import find_humanoid_map
from solvers.retargeting.body import find_body
from solvers.retargeting.hand_paths import ground_weights
from solvers.retargeting.placement import (
    ankle_height,
    find_placement,
    leg_length,
    rests_on_ground,
    standing_ankle,
)

RATE = 120.0
LEG_M = 0.9


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


def test_hand_that_sweeps_over_the_ground_does_not_support_where_it_turns():
    """It stands for an instant there, as a hand does that supports the body."""
    time = np.arange(240) / RATE
    hand = np.stack([0.3 * np.sin(4 * np.pi * time), 0 * time, 0 * time + 0.05], axis=1)

    weights = ground_weights(hand / LEG_M, hand[:, 2] / LEG_M, RATE)

    assert weights[:, :2].max() < 0.05
    assert_allclose(weights[:, 2], 1.0)


def test_hand_that_rolls_on_the_ground_supports_the_body():
    """It rolls by a decimeter per second."""
    hand = positions(*[0.05] * 60) + np.linspace(0.0, 0.05, 60)[:, None] * (1.0, 0.0, 0.0)

    assert_allclose(ground_weights(hand / LEG_M, hand[:, 2] / LEG_M, RATE), 1.0)


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
