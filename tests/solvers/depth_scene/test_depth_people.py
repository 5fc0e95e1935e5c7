"""People who are only points: who is the actor, and where, is known."""

import numpy as np
import pytest

from solvers.depth_scene.bodies import Bodies
from solvers.depth_scene.people import follow_people

RATE = 30.0
FRAMES = np.arange(0, 151, 5)
"""Six looks a second, for five seconds."""


def followed(*people, n_frames=151):
    """Each of the people is an area, and a function from seconds to a place or None."""

    def look(frame: int) -> Bodies:
        seen = [(area, place(frame / RATE)) for area, place in people]
        seen = sorted(
            ((area, at) for area, at in seen if at is not None), key=lambda one: -one[0]
        )
        middles = np.array([at for _, at in seen], dtype=np.float64).reshape(-1, 3)
        areas = np.array([area for area, _ in seen])
        return Bodies(np.zeros((1, 1)), 1, np.zeros((1, 1), np.intp), areas, middles)

    return follow_people(look, FRAMES, n_frames, RATE)


def standing(x: float):
    return lambda time: (x, 0.0, 3.0)


@pytest.mark.parametrize("speed", [0.0, 1.5, 3.5])
def test_one_who_runs_is_one(speed):
    found = followed((0.5, lambda time: (speed * time - 2.0, 0.0, 3.0)))

    assert found.n_bodies.tolist() == [1] * len(FRAMES)
    times = np.arange(151) / RATE
    np.testing.assert_allclose(found.course[:, 0], speed * times - 2.0, atol=1e-9)


def test_one_who_runs_is_one_though_another_stands_by():
    found = followed((0.5, lambda time: (3.5 * time, 0.0, 3.0)), (0.3, standing(-2.0)))

    np.testing.assert_allclose(found.course[:, 0], 3.5 * np.arange(151) / RATE, atol=1e-9)


def test_two_who_pass_each_other_are_not_exchanged():
    """The second shows more surface on its way past, but less over the whole time."""
    found = followed(
        (0.5, lambda time: (0.8 * time - 2.0, 0.0, 3.0)),
        (0.45, lambda time: (2.0 - 0.8 * time, 0.0, 4.2)),
    )

    np.testing.assert_allclose(found.course[:, 2], 3.0)
    assert (found.n_bodies == 2).all()


def test_whoever_is_seen_for_longer_is_the_actor():
    found = followed(
        (0.7, lambda time: (1.5, 0.0, 2.0) if time < 1.0 else None), (0.4, standing(0.0))
    )

    np.testing.assert_allclose(found.course, np.tile([0.0, 0.0, 3.0], (151, 1)))


def test_one_who_comes_back_elsewhere_is_the_same():
    def place(time: float):
        return None if 1.5 < time < 3.5 else (0.0 if time < 2.0 else 2.5, 0.0, 3.0)

    found = followed((0.5, place))

    assert np.isnan(found.course[52:100]).all()
    np.testing.assert_allclose(found.course[:46, 0], 0.0)
    np.testing.assert_allclose(found.course[105:, 0], 2.5)


def test_one_who_is_hidden_for_a_moment_is_still_there():
    found = followed((0.5, lambda time: None if 2.0 < time < 2.6 else (time, 0.0, 3.0)))

    np.testing.assert_allclose(found.course[:, 0], np.arange(151) / RATE, atol=1e-9)


def test_nobody_has_no_course():
    assert np.isnan(followed().course).all()
