"""Simulation retries with more smoothing if the body cannot follow, and only then."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.physics import Ground, SimulateSettings, simulate, simulate_segment
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
SHAKEN = walking_gait(GaitSettings(duration=1.5, frame_rate=30.0))
SHAKEN = SHAKEN.with_poses(
    multiply(
        SHAKEN.rotations,
        quaternion_from_rotation_vector(
            np.random.default_rng(0).normal(scale=0.5, size=(*SHAKEN.rotations.shape[:2], 3))
        ),
    )
)
"""So wild that no body follows it."""


@pytest.mark.parametrize(
    ("requested", "attempts"),
    [
        (0.02, [0.02, 0.04, 0.08, 0.16]),
        (0.1, [0.1, 0.16]),
        (0.3, [0.3]),
        (0.0, [0.0, 0.04, 0.08, 0.16]),
    ],
)
def test_each_attempt_smooths_more(monkeypatch, requested, attempts):
    found = record_smoothing(monkeypatch)
    monkeypatch.setattr(simulate_segment, "MAX_SUPPORT_FRACTION", -1.0)

    result = simulate(WALK, settings=SimulateSettings(smoothing=requested))

    assert_allclose(found, attempts)
    assert result.smoothing in found


def test_smoothing_is_as_requested():
    less, more = (
        simulate(SHAKEN, settings=SimulateSettings(smoothing=each)) for each in (0.16, 0.5)
    )

    assert (less.smoothing, more.smoothing) == (0.16, 0.5)
    speeds = [
        np.abs(np.diff(each.motion.root_positions, axis=0)).mean() for each in (less, more)
    ]
    assert speeds[1] < speeds[0]


def test_noisy_take_is_smoothed_where_the_simulation_fails():
    assert simulate(SHAKEN, settings=SimulateSettings(smoothing=0.0)).followed.all()


def test_body_in_balance_is_simulated_once(monkeypatch):
    found = record_smoothing(monkeypatch)

    result = simulate(WALK, settings=SimulateSettings(support=0.0))

    assert result.followed.all() and not result.support.any()
    assert len(found) == 1


def record_smoothing(monkeypatch) -> list[float]:
    """Return a list that receives the smoothing of each attempt."""
    attempts, found = simulate_segment._attempt, []

    def noted(engine, body, motion, conditions, smoothing, progress):
        found.append(smoothing)
        return attempts(engine, body, motion, conditions, smoothing, progress)

    monkeypatch.setattr(simulate_segment, "_attempt", noted)
    return found


@pytest.mark.parametrize("n_frames", [5, 2])
def test_support_covers_all_frames_of_a_hanging_body(n_frames):
    """A body above the ground has no support from it."""
    sky = WALK.slice(0, n_frames)
    sky = sky.with_poses(root_positions=sky.root_positions + np.array([0, 0, 0.9]))

    result = simulate(sky, settings=SimulateSettings(ground=Ground.HEIGHT))

    assert_allclose(result.support, 0.4)
