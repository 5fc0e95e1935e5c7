"""People who meet, hide each other, enter and leave, with known identities."""

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.find_people import find_people
from solvers.depth_scene.follow_several_people import (
    BodyPoints,
    follow_several_people,
    level_distances,
)
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_scene.share_pixels import NO_OWNER, enlarged, share_pixels
from solvers.errors import InvalidMotionError

RATE = 30.0
FRAMES = np.arange(0, 151, 5)
"""Six samples per second for five seconds."""
TIMES = np.arange(151) / RATE
UP = np.array([0.0, -1.0, 0.0])
BODY = np.stack(np.meshgrid(np.linspace(-0.2, 0.2, 9), np.linspace(-0.8, 0.8, 17)), axis=-1)
BODY = np.append(BODY.reshape(-1, 2), np.zeros((153, 1)), axis=1)
"""Points of a flat person, 0.4 m wide; the median is the center."""
TOUCHING_M = 0.45
"""Horizontal distance of centers below which two people are one component."""


def follow(*people, n_people=None):
    """Follow people, each a function from seconds to a position or None."""

    def observe(frame: int) -> BodyPoints:
        visible = [at for at in (person(frame / RATE) for person in people) if at is not None]
        points = [BODY + at for at in visible]
        labels = np.arange(len(visible))
        for index, at in enumerate(visible):
            for other in range(index):
                if np.linalg.norm(np.subtract(at, visible[other])[[0, 2]]) < TOUCHING_M:
                    labels[labels == labels[index]] = labels[other]
        labels = np.unique(labels, return_inverse=True)[1]
        points = np.concatenate([np.zeros((0, 3)), *points])
        return BodyPoints(points, np.repeat(labels, len(BODY)), np.full(len(points), 0.4 / 153))

    return follow_several_people(observe, FRAMES, 151, RATE, 0.08, UP, n_people)


def test_two_people_who_pass_each_other_keep_their_identities():
    """They run: between samples each comes to where the other was expected without a speed."""
    centers = follow(
        lambda time: (2.5 * time - 6.25, 0.0, 3.0), lambda time: (6.25 - 2.5 * time, 0.0, 3.46)
    )

    assert len(centers) == 2
    ordered = sorted(centers, key=lambda path: path[0, 0])
    np.testing.assert_allclose(ordered[0][:, 0], 2.5 * TIMES - 6.25, atol=1e-9)
    np.testing.assert_allclose(ordered[1][:, 2], 3.46, atol=1e-9)


def test_two_people_who_touch_for_two_seconds_stay_two():
    """They approach to 0.4 m, one component, and move apart again."""

    def half(time):
        return 0.2 + 1.0 * max(abs(time - 2.5) - 1.0, 0.0)

    centers = follow(lambda time: (-half(time), 0.0, 3.0), lambda time: (half(time), 0.0, 3.0))

    assert len(centers) == 2
    left, right = sorted(centers, key=lambda path: path[0, 0])
    expected = np.array([half(time) for time in TIMES])
    np.testing.assert_allclose(left[:, 0], -expected, atol=0.12)
    np.testing.assert_allclose(right[:, 0], expected, atol=0.12)


def test_person_who_enters_late_and_leaves_does_not_change_the_other():
    centers = follow(
        lambda time: (0.0, 0.0, 3.0),
        lambda time: (2.0 - time, 0.0, 4.0) if 1.0 <= time <= 3.5 else None,
    )

    assert len(centers) == 2
    np.testing.assert_allclose(centers[0], np.tile([0.0, 0.0, 3.0], (151, 1)), atol=1e-9)
    present = np.isfinite(centers[1][:, 0])
    assert present[30:106].all() and not present[:26].any() and not present[110:].any()


def test_person_hidden_for_half_a_second_is_the_same():
    centers = follow(
        lambda time: (0.0, 0.0, 2.5),
        lambda time: None if 2.2 < time < 2.8 else (1.2 * (time - 2.5), 0.0, 4.0),
    )

    assert len(centers) == 2
    np.testing.assert_allclose(centers[1][:, 0], 1.2 * (TIMES - 2.5), atol=1e-9)


def test_person_divided_by_another_one_in_front_is_one():
    """Two parts of a person behind another are half a meter from each other: three bodies."""

    def is_divided(time):
        return abs(time - 2.5) < 0.3

    centers = follow(
        lambda time: (0.0, 0.0, 2.5),
        lambda time: (-0.24 if is_divided(time) else 0.9 * time - 2.25, 0.0, 4.0),
        lambda time: (0.24, 0.0, 4.0) if is_divided(time) else None,
    )

    assert len(centers) == 2


def test_returning_person_counts_as_the_same_unless_more_are_required():
    people = (
        lambda time: (0.0, 0.0, 3.0),
        lambda time: (-2.0, 0.0, 3.0) if time < 1.5 else None,
        lambda time: (2.0, 0.0, 3.0) if time > 3.0 else None,
    )

    assert len(follow(*people)) == 2
    assert len(follow(*people, n_people=3)) == 3
    np.testing.assert_allclose(follow(*people, n_people=1), follow(*people)[:1])


def test_false_detection_in_one_sample_is_no_person():
    centers = follow(
        lambda time: (0.0, 0.0, 3.0), lambda time: (2.0, 0.0, 3.0) if time == 2.5 else None
    )

    assert len(centers) == 1


def test_distances_are_horizontal_and_infinite_for_absent_people():
    points, centers = np.array([[3.0, 7.0, 4.0]]), np.array([[0.0, 0.0, 0.0], [np.nan] * 3])

    np.testing.assert_allclose(level_distances(points, centers, UP), [[5.0, np.inf]])


def test_arm_held_out_to_another_person_keeps_its_owner():
    """A tenth of the first component is nearer to the other person."""
    distances = np.array([[0.1, 0.9]] * 18 + [[0.5, 0.4]] * 2 + [[0.9, 0.1]] * 20)
    components = np.array([0] * 20 + [1] * 20)

    owners = share_pixels(distances, components, 1.0)

    assert owners.tolist() == [0] * 20 + [1] * 20


def test_joined_people_are_shared_point_by_point_and_furniture_has_no_owner():
    distances = np.array([[0.1, 0.9]] * 10 + [[0.9, 0.1]] * 12 + [[2.0, 3.0]] * 5)
    components = np.array([0] * 22 + [1] * 5)

    owners = share_pixels(distances, components, 1.0)

    assert owners.tolist() == [0] * 10 + [1] * 12 + [NO_OWNER] * 5


def test_nothing_is_shared_without_points_or_people():
    assert share_pixels(np.zeros((0, 2)), np.zeros(0, dtype=int), 1.0).tolist() == []
    without = share_pixels(np.zeros((3, 0)), np.zeros(3, dtype=int), 1.0)
    assert without.tolist() == [NO_OWNER] * 3


def test_enlarged_owners_cover_all_pixels():
    owners = np.array([[0, NO_OWNER], [1, 1]])

    full = enlarged(owners, 2, (3, 4))

    assert full.shape == (3, 4)
    assert full[0, 0] == 0 and full[2, 3] == 1 and (full >= 0).all()


KINECT = Camera(142.8, 142.8, 79.75, 59.75, 160, 120)


def moving(frame: int, right: float, distance: float, phase: float) -> np.ndarray:
    """Return the depth of an upright ellipsoid that steps to the side; 0 elsewhere."""
    rays = KINECT.rays()
    center = np.array([right + 0.25 * np.sin(0.1 * frame + phase), 0.05, distance])
    scales = np.array([1 / 0.25, 1 / 0.85, 1 / 0.15])
    ray, start = rays * scales, center * scales
    a = (ray**2).sum(-1)
    b = ray @ start
    inside = b**2 - a * (start @ start - 1.0)
    return np.where(inside > 0.0, (b - np.sqrt(np.maximum(inside, 0.0))) / a, 0.0)


@pytest.fixture(scope="module")
def two_in_a_room():
    """A shelf stands at the right, and a stool within reach; two people move."""
    empty = room(KINECT, tilted(0.0), 0.92, 5.0)
    shelf = np.zeros(empty.shape, dtype=bool)
    shelf[20:90, 128:150] = True
    empty = np.where(shelf, 4.2, empty)
    empty[78:97, 112:125] = 3.75

    def read(frame):
        both = np.stack([moving(frame, -0.7, 3.0, 0.0), moving(frame, 0.5, 3.3, 1.0)])
        nearest = np.where(both > 0.0, both, np.inf).min(axis=0)
        return np.where(np.isfinite(nearest), nearest, 0.0)

    people = DepthRecording(KINECT, 60, RATE, read)
    return people, in_room(people, empty, 0.001)


def test_two_people_in_a_furnished_room(two_in_a_room):
    people, recording = two_in_a_room

    found = find_people(recording)

    assert len(found.actors) == 2 and found.actors[0].floor is not None
    for frame in (0, 20, 40):
        true, seen = people.frame(frame) > 0.0, found.recording.frame(frame) > 0.0
        assert (true & seen).sum() / (true | seen).sum() > 0.85
        assert (seen & ~true).sum() < 0.02 * true.sum()
        first, second = (actor.recording.frame(frame) > 0.0 for actor in found.actors)
        assert not (first & second).any()
        assert ((first | second) == seen).all()
        occluders = found.actors[0].recording.occluders(frame)
        np.testing.assert_array_equal(occluders > 0.0, second)


def test_too_many_people_are_refused(two_in_a_room):
    _, recording = two_in_a_room
    with pytest.raises(InvalidMotionError, match="Only 2 of 3 people are found"):
        find_people(recording, n_people=3)


def test_empty_images_have_no_people():
    empty = DepthRecording(KINECT, 4, RATE, lambda frame: np.zeros((120, 160), "f4"))
    with pytest.raises(InvalidMotionError, match="No person is visible"):
        find_people(empty)
