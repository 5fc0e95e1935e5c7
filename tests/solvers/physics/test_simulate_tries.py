"""Who cannot follow tries again with a calmer target, and only then."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.physics import Ground, SimulateSettings, simulate
from solvers.physics import segment as physics_piece
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
    ("asked", "tried"),
    [
        (0.02, [0.02, 0.04, 0.08, 0.16]),
        (0.1, [0.1, 0.16]),
        (0.3, [0.3]),
        (0.0, [0.0, 0.01, 0.02, 0.04]),
    ],
)
def test_who_cannot_be_followed_is_calmed_more_each_time(monkeypatch, asked, tried):
    found = tries(monkeypatch)
    monkeypatch.setattr(physics_piece, "HANGING", -1.0)

    result = simulate(WALK, settings=SimulateSettings(smoothing=asked))

    assert_allclose(found, tried)
    assert result.smoothing in found


def test_a_take_is_calmed_as_much_as_is_asked_for():
    less, more = (
        simulate(SHAKEN, settings=SimulateSettings(smoothing=each)) for each in (0.16, 0.5)
    )

    assert (less.smoothing, more.smoothing) == (0.16, 0.5)
    speeds = [
        np.abs(np.diff(each.motion.root_positions, axis=0)).mean() for each in (less, more)
    ]
    assert speeds[1] < speeds[0]


def test_a_shaken_take_that_is_not_to_be_calmed_is_calmed_where_it_is_lost():
    assert simulate(SHAKEN, settings=SimulateSettings(smoothing=0.0)).followed.all()


def test_who_goes_without_any_help_is_simulated_once(monkeypatch):
    found = tries(monkeypatch)

    result = simulate(WALK, settings=SimulateSettings(support=0.0))

    assert result.followed.all() and not result.support.any()
    assert len(found) == 1


def tries(monkeypatch) -> list[float]:
    """Return a list that fills with the smoothing of each try."""
    tried, found = physics_piece._tried, []

    def noted(engine, body, motion, conditions, smoothing, progress):
        found.append(smoothing)
        return tried(engine, body, motion, conditions, smoothing, progress)

    monkeypatch.setattr(physics_piece, "_tried", noted)
    return found


@pytest.mark.parametrize("n_frames", [5, 2])
def test_help_is_told_of_all_frames_of_a_body_that_hangs(n_frames):
    """One that hovers over the ground has nothing to stand on."""
    sky = WALK.slice(0, n_frames)
    sky = sky.with_poses(root_positions=sky.root_positions + np.array([0, 0, 0.9]))

    result = simulate(sky, settings=SimulateSettings(ground=Ground.HEIGHT))

    assert_allclose(result.support, 0.4)
