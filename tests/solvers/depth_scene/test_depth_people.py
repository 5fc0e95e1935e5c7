"""Tracking of synthetic people with true identities and positions."""

import numpy as np
import pytest

from solvers.depth_scene.bodies import LabeledBodies
from solvers.depth_scene.people import follow_people

RATE = 30.0
FRAMES = np.arange(0, 151, 5)
"""Six samples per second for five seconds."""


def track(*people, n_frames=151):
    """Track people, each an area and a function from seconds to a position or None."""

    def observe(frame: int) -> LabeledBodies:
        visible = [(area, position(frame / RATE)) for area, position in people]
        visible = sorted(
            ((area, at) for area, at in visible if at is not None), key=lambda one: -one[0]
        )
        centers = np.array([at for _, at in visible], dtype=np.float64).reshape(-1, 3)
        areas = np.array([area for area, _ in visible])
        return LabeledBodies(np.zeros((1, 1)), 1, np.zeros((1, 1), np.intp), areas, centers)

    return follow_people(observe, FRAMES, n_frames, RATE)


def standing(x: float):
    return lambda time: (x, 0.0, 3.0)


@pytest.mark.parametrize("speed", [0.0, 1.5, 3.5])
def test_runner_is_one_person(speed):
    tracked = track((0.5, lambda time: (speed * time - 2.0, 0.0, 3.0)))

    assert tracked.n_bodies.tolist() == [1] * len(FRAMES)
    times = np.arange(151) / RATE
    np.testing.assert_allclose(tracked.trajectory[:, 0], speed * times - 2.0, atol=1e-9)


def test_runner_is_one_person_next_to_a_bystander():
    tracked = track((0.5, lambda time: (3.5 * time, 0.0, 3.0)), (0.3, standing(-2.0)))

    np.testing.assert_allclose(tracked.trajectory[:, 0], 3.5 * np.arange(151) / RATE, atol=1e-9)


def test_two_people_keep_their_identities_when_they_pass():
    """The second shows more surface while passing, but less in total."""
    tracked = track(
        (0.5, lambda time: (0.8 * time - 2.0, 0.0, 3.0)),
        (0.45, lambda time: (2.0 - 0.8 * time, 0.0, 4.2)),
    )

    np.testing.assert_allclose(tracked.trajectory[:, 2], 3.0)
    assert (tracked.n_bodies == 2).all()


def test_actor_is_the_person_visible_for_longest():
    tracked = track(
        (0.7, lambda time: (1.5, 0.0, 2.0) if time < 1.0 else None), (0.4, standing(0.0))
    )

    np.testing.assert_allclose(tracked.trajectory, np.tile([0.0, 0.0, 3.0], (151, 1)))


def test_actor_is_the_same_person_after_returning_elsewhere():
    def position(time: float):
        return None if 1.5 < time < 3.5 else (0.0 if time < 2.0 else 2.5, 0.0, 3.0)

    tracked = track((0.5, position))

    assert np.isnan(tracked.trajectory[52:100]).all()
    np.testing.assert_allclose(tracked.trajectory[:46, 0], 0.0)
    np.testing.assert_allclose(tracked.trajectory[105:, 0], 2.5)


def test_person_who_appears_far_from_one_who_left_is_another():
    """Both together would show more surface than the bystander, who is the actor."""
    tracked = track(
        (0.5, lambda time: (-3.0, 0.0, 3.0) if time < 2.0 else None),
        (0.5, lambda time: (3.0, 0.0, 3.0) if time >= 2.0 else None),
        (0.4, standing(0.0)),
    )

    np.testing.assert_allclose(tracked.trajectory[:, 0], 0.0)


def test_trajectory_bridges_a_short_occlusion():
    tracked = track((0.5, lambda time: None if 2.0 < time < 2.6 else (time, 0.0, 3.0)))

    np.testing.assert_allclose(tracked.trajectory[:, 0], np.arange(151) / RATE, atol=1e-9)


def test_empty_recording_has_no_trajectory():
    assert np.isnan(track().trajectory).all()
