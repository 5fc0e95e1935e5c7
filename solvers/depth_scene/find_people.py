"""Find the people in a depth recording, and the pixels of each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..arrays import Array, Integers
from ..errors import InvalidMotionError
from ..progress import Progress, unwatched, within
from .actor import DEFAULT_FOREGROUND, NO_PERSON, Actor
from .bodies import find_bodies
from .camera_checks import check_intrinsics
from .floor import LEVEL
from .follow_several_people import BodyPoints, follow_several_people, level_distances
from .foreground import ForegroundSettings
from .person_finder import PersonFinder, person_finder, sample_frames
from .recording import DepthImage, DepthRecording
from .share_pixels import NO_OWNER, enlarged, share_pixels

BODY_REACH_M = 0.9
"""Horizontal distance from the center of a person to the farthest fingertip. It guards images
with furniture (`test_two_people_in_a_furnished_room`)."""


@dataclass(frozen=True, eq=False)
class SeparatedPeople:
    """The people in a depth recording and the scene.

    Attributes
    ----------
    recording : DepthRecording
        Contains only the people; still read frame by frame.
    centers : shape (n_people, n_frames, 3), meters
        Position of each person in the camera frame; NaN while absent. The most visible first.
    actors : tuple of Actor
        Each person alone, by the distance of pixels to the centers. Other people are occluders.
    """

    recording: DepthRecording
    centers: Array
    actors: tuple[Actor, ...]


def find_people(
    recording: DepthRecording,
    settings: ForegroundSettings = DEFAULT_FOREGROUND,
    *,
    n_people: int | None = None,
    empty: Sequence[int] = (),
    progress: Progress = unwatched,
) -> SeparatedPeople:
    """Separate people from the room and from each other, in all frames.

    The scene is learned as by `find_actor`. Connected pixels in space form bodies; they are
    linked over time where people are expected, also while these touch.

    Parameters
    ----------
    recording : DepthRecording
    settings : ForegroundSettings
    n_people : int, optional
        Number of people, the most visible ones. Default: as many as are visible at once.
    empty : sequence of int
        Frames of the empty room.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is visible, or fewer than `n_people`.
    SolveCancelled
        Raised by `progress`.
    """
    frames = sample_frames(recording)
    finder = person_finder(recording, settings, empty, frames, within(progress, 0.0, 0.2))
    up = (finder.images.floor or LEVEL).up
    centers = follow_several_people(
        _observer(finder, len(frames), within(progress, 0.2, 1.0)),
        frames, recording.n_frames, recording.frame_rate, settings.min_body_area, up, n_people,
    )  # fmt: skip
    if not len(centers):
        raise InvalidMotionError(NO_PERSON)
    if n_people is not None and len(centers) < n_people:
        raise InvalidMotionError(
            f"Only {len(centers)} of {n_people} people are found. Reduce the number of people,"
            " or the minimum body area."
        )
    images = _PeopleImages(finder, centers)
    people = replace(recording, read_depth=images.depth, read_occluders=None)
    warnings = (*check_intrinsics(recording.camera), *finder.warnings())
    actors = []
    for person, path in enumerate(centers):
        visible = np.isfinite(path).all(axis=-1)
        alone = replace(
            recording, read_depth=partial(images.depth_of, person),
            read_occluders=partial(images.occluders_of, person),
        )  # fmt: skip
        actors.append(
            Actor(
                alone, finder.images.floor, finder.images.settings.actor_mask, visible,
                not finder.is_cropped(), (*warnings, *_absences(person, visible, recording)),
            )
        )  # fmt: skip
        warnings = ()
    return SeparatedPeople(people, centers, tuple(actors))


def _absences(person: int, visible: Array, recording: DepthRecording) -> tuple[str, ...]:
    if visible.all():
        return ()
    first, last = np.flatnonzero(visible)[[0, -1]] / recording.frame_rate
    return (
        f"Person {person + 1} is visible in {int(visible.sum())} of {len(visible)} frames, from"
        f" {first:.1f} s to {last:.1f} s.",
    )


def _observer(
    finder: PersonFinder, n_samples: int, progress: Progress
) -> Callable[[int], BodyPoints]:
    n_observed = 0

    def observe(frame: int) -> BodyPoints:
        nonlocal n_observed
        n_observed += 1
        bodies, is_person = finder.classify(frame)
        seen = np.isin(bodies.labels, np.flatnonzero(is_person) + 1)
        points = finder.camera.back_project(bodies.depth)[seen]
        areas = points[:, 2] ** 2 / (finder.camera.fx * finder.camera.fy)
        progress(n_observed / n_samples, "Finding the people")
        return BodyPoints(points, bodies.labels[seen] - 1, areas)

    return observe


class _PeopleImages:
    """Reader of depth images of the people, and of each person alone.

    Parameters
    ----------
    finder : PersonFinder
    centers : shape (n_people, n_frames, 3), meters
    """

    def __init__(self, finder: PersonFinder, centers: Array) -> None:
        self._finder, self._centers = finder, centers
        self._last: tuple[int, DepthImage, Integers] | None = None

    def depth(self, frame: int) -> DepthImage:
        """Return the depth of all people in a frame, meters; 0 elsewhere."""
        return self._shared(frame)[0]

    def depth_of(self, person: int, frame: int) -> DepthImage:
        """Return the depth of one person in a frame, meters; 0 elsewhere."""
        depth, owners = self._shared(frame)
        return np.where(owners == person, depth, np.float32(0.0))

    def occluders_of(self, person: int, frame: int) -> DepthImage:
        """Return the depth of the other people in a frame, meters; 0 elsewhere."""
        depth, owners = self._shared(frame)
        return np.where(owners != person, depth, np.float32(0.0))

    def _shared(self, frame: int) -> tuple[DepthImage, Integers]:
        """Return the last image again if it is that frame's: all people ask for the same."""
        if self._last is None or self._last[0] != frame:
            self._last = (frame, *self._read(frame))
        return self._last[1:]

    def _read(self, frame: int) -> tuple[DepthImage, Integers]:
        """Return the depth of the people, and the person of each pixel."""
        images, centers = self._finder.images, self._centers[:, frame]
        camera = images.recording.camera
        depth = images.foreground(images.recording.frame(frame))
        bodies = find_bodies(depth, camera, images.settings.min_body_area)
        coarse, coarse_camera = depth[:: bodies.step, :: bodies.step], camera.every(bodies.step)
        is_person = self._finder.may_be_people(bodies, coarse, bodies.step)
        in_body = np.isin(bodies.labels, np.flatnonzero(is_person) + 1)
        distances = level_distances(
            coarse_camera.back_project(coarse)[in_body], centers,
            (images.floor or LEVEL).up,
        )  # fmt: skip
        owners = np.full(bodies.labels.shape, NO_OWNER)
        owners[in_body] = share_pixels(distances, bodies.labels[in_body] - 1, BODY_REACH_M)
        labels = np.unique(bodies.labels[owners != NO_OWNER])
        masks = [bodies.mask(int(label)) for label in labels]
        mask = np.any(masks, axis=0) if masks else np.zeros(depth.shape, dtype=bool)
        owners = enlarged(owners, bodies.step, depth.shape)
        return np.where(mask, depth, np.float32(0.0)), owners
