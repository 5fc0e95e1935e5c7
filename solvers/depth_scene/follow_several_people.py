"""Follow several people through sampled frames, from where they are apart."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Flags, Integers
from .people import MAX_GAP_S, MAX_JUMP_M, MAX_SPEED_M_S, interpolate_trajectory
from .share_pixels import NO_OWNER, share_pixels

MIN_TIME_FRACTION = 0.05
"""A person in fewer samples than this fraction of those of the longest visible one is a false
detection, as in recordings of joints. It guards noisy images
(`test_false_detection_in_one_sample_is_no_person`)."""
MIN_SEPARATION_M = 0.5
"""Bodies whose centers are horizontally nearer than this are parts of one person, whom another
person in front divides. It guards people who pass behind others
(`test_person_divided_by_another_one_in_front_is_one`)."""


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """The bodies in one frame.

    Attributes
    ----------
    points : shape (n, 3), meters
        All points of the bodies, camera frame.
    labels : int, shape (n,)
        Body of each point, from 0.
    areas : shape (n,), square meters
        Visible surface of each point.
    """

    points: Array
    labels: Integers
    areas: Array

    def center(self, chosen: Flags) -> Array:
        """Return the median (3,) of a part of the points, meters."""
        center: Array = np.median(self.points[chosen], axis=0)
        return center

    def area(self, chosen: Flags) -> float:
        """Return the visible surface of a part of the points, square meters."""
        return float(self.areas[chosen].sum())

    def large(self, min_area: float) -> list[int]:
        """Return the labels of the bodies with at least this surface, square meters."""
        surfaces = np.bincount(self.labels, weights=self.areas)
        return [int(label) for label in np.flatnonzero(surfaces >= min_area)]


@dataclass
class _Track:
    """One person: centers in the sampled frames, in the order of time."""

    centers: dict[int, Array] = field(default_factory=dict)
    area: float = 0.0

    def add(self, sample: int, bodies: BodyPoints, own: Flags) -> None:
        self.centers[sample] = bodies.center(own)
        self.area += bodies.area(own)

    @property
    def first(self) -> int:
        return min(self.centers)

    @property
    def last(self) -> int:
        return max(self.centers)


def follow_several_people(
    observe: Callable[[int], BodyPoints],
    frames: NDArray[np.intp],
    n_frames: int,
    frame_rate: float,
    min_area: float,
    up: Array,
    n_people: int | None = None,
) -> Array:
    """Return the position of each person, shape (n_people, n_frames, 3); NaN while absent.

    People are followed forward and backward from the frame with the most bodies. A person is
    expected where constant velocity leads. Bodies in reach of several expected people are
    shared point by point, so that people who touch for a while stay two. A person who appears
    when another one is gone counts as the same, unless more are visible at once or `n_people`
    are required.

    Parameters
    ----------
    observe : callable
        Maps a frame to the bodies in it.
    frames : int, shape (n_samples,)
        Strictly increasing.
    n_frames : int
    frame_rate : float, hertz
    min_area : float, square meters
        Smallest visible surface of a new person.
    up : shape (3,)
        Unit vector against gravity; distances are horizontal.
    n_people : int, optional
        Number of people, the most visible ones. Default: as many as are visible at once.
    """
    seen = [observe(frame) for frame in frames.tolist()]
    times = frames / frame_rate
    people_seen = [_new_people(bodies, bodies.large(min_area), up) for bodies in seen]
    start = _clearest(seen, people_seen, up)
    tracks: list[_Track] = []
    for order in (range(start, len(seen)), range(start - 1, -1, -1)):
        _follow(tracks, seen, times, order, min_area, up)
    longest = max((len(track.centers) for track in tracks), default=0)
    tracks = [track for track in tracks if len(track.centers) >= MIN_TIME_FRACTION * longest]
    people = _people(tracks, n_people)
    trajectories = [
        interpolate_trajectory(person.centers, frames, n_frames, frame_rate)
        for person in people
    ]
    return np.array(trajectories).reshape(-1, n_frames, 3)


def _follow(
    tracks: list[_Track],
    seen: Sequence[BodyPoints],
    times: Array,
    order: range,
    min_area: float,
    up: Array,
) -> None:
    """Extend the tracks over samples in ascending or descending order."""
    recent = {
        index: sorted(track.centers, reverse=order.step < 0)
        for index, track in enumerate(tracks)
    }
    for sample in order:
        bodies = seen[sample]
        active = [
            index for index, samples in recent.items()
            if abs(times[sample] - times[samples[-1]]) <= MAX_GAP_S
        ]  # fmt: skip
        expected = np.array([
            _expected(tracks[index], recent[index], times, sample) for index in active
        ]).reshape(-1, 3)
        distances = level_distances(bodies.points, expected, up)
        owners = share_pixels(
            distances, bodies.labels, MAX_JUMP_M + MAX_SPEED_M_S * _step(times)
        )
        for number, index in enumerate(active):
            own = owners == number
            if own.any():
                tracks[index].add(sample, bodies, own)
                recent[index].append(sample)
        free = [
            label for label in bodies.large(min_area)
            if (owners[bodies.labels == label] == NO_OWNER).all()
        ]  # fmt: skip
        for own in _new_people(bodies, free, up):
            recent[len(tracks)] = [sample]
            tracks.append(_Track())
            tracks[-1].add(sample, bodies, own)


def _new_people(bodies: BodyPoints, labels: Sequence[int], up: Array) -> list[Flags]:
    """Return the points of each person among bodies; those close together are one person."""
    people: list[Flags] = []
    for label in sorted(labels, key=lambda label: -bodies.area(bodies.labels == label)):
        own = bodies.labels == label
        centers = np.array([bodies.center(person) for person in people]).reshape(-1, 3)
        distances = level_distances(bodies.center(own)[np.newaxis], centers, up)[0]
        if len(people) and distances.min() < MIN_SEPARATION_M:
            people[int(distances.argmin())] |= own
        else:
            people.append(own)
    return people


def _clearest(bodies: Sequence[BodyPoints], people: Sequence[list[Flags]], up: Array) -> int:
    """Return the sample with the most people; of several, where they are farthest apart."""
    separations = []
    for one, persons in zip(bodies, people, strict=True):
        centers = np.array([one.center(person) for person in persons]).reshape(-1, 3)
        distances = level_distances(centers, centers, up)
        distances[np.diag_indices(len(centers))] = np.inf
        separations.append((len(centers), distances.min(initial=np.inf)))
    return max(range(len(separations)), key=lambda sample: separations[sample])


def _step(times: Array) -> float:
    return float(np.diff(times).max(initial=0.0))


def _expected(track: _Track, recent: list[int], times: Array, sample: int) -> Array:
    """Return the expected center of a track, by constant velocity."""
    last = track.centers[recent[-1]]
    if len(recent) < 2:
        return last
    elapsed = times[recent[-1]] - times[recent[-2]]
    velocity = (last - track.centers[recent[-2]]) / elapsed
    expected: Array = last + velocity * (times[sample] - times[recent[-1]])
    return expected


def level_distances(points: Array, centers: Array, up: Array) -> Array:
    """Return the horizontal distance of points (n, 3) to centers (k, 3), shape (n, k).

    It is infinite for a center of NaN.
    """
    offsets = points[:, np.newaxis] - centers[np.newaxis]
    squares = np.einsum("nki,nki->nk", offsets, offsets) - (offsets @ up) ** 2
    distances: Array = np.sqrt(np.where(np.isfinite(squares), np.maximum(squares, 0.0), np.inf))
    return distances


def _people(tracks: list[_Track], n_people: int | None) -> list[_Track]:
    """Join tracks that do not overlap in time, until no more than `n_people` are left."""
    people: list[list[_Track]] = []
    for track in sorted(tracks, key=lambda track: track.first):
        free = [person for person in people if person[-1].last < track.first]
        if not free or (n_people is not None and len(people) < n_people):
            people.append([track])
            continue
        entry = track.centers[track.first]
        nearest = min(
            free, key=lambda person: np.linalg.norm(person[-1].centers[person[-1].last] - entry)
        )
        nearest.append(track)
    joined = [
        _Track(
            {key: center for track in person for key, center in sorted(track.centers.items())},
            sum(track.area for track in person),
        )
        for person in people
    ]
    joined.sort(key=lambda person: -person.area)
    return joined[:n_people]
