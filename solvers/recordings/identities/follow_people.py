"""Follow people over the frames of a file, where a tracker may switch their identities."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from itertools import combinations
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from ...arrays import Array
from .claims import Claims
from .evidence import MAX_PEOPLE, MIN_SWITCH_M, continues_other_path
from .path import PersonPath, center

Key = TypeVar("Key", bound=Hashable)
ADULT_EXTENT_M = 1.6
"""Longest side of the box around the joints of a standing adult, meters, in Winter 2009 from
head to ankles. Distances of files without a unit are relative to it."""
N_SAMPLED_FRAMES = 500
"""Frames from which the unit is estimated. It bounds the run time."""


class FoundAgain(NamedTuple, Generic[Key]):
    """A person who was missing for a moment and has a new identity."""

    person: Key
    new: Key
    time: float
    """Seconds."""


class FollowedPeople(NamedTuple, Generic[Key]):
    """Who is observed in each frame."""

    persons: list[dict[Key, Key]]
    """Person by identity for each frame; persons are called by the identities of the file."""
    switch_times: list[float]
    """Seconds at which identities were switched."""
    found_again: list[FoundAgain[Key]]

    @property
    def is_changed(self) -> bool:
        """Whether someone has another identity than in the file."""
        return bool(self.switch_times or self.found_again)


def follow_people(frames: Sequence[Mapping[Key, Array]], times: Array) -> FollowedPeople[Key]:
    """Return who is observed in each frame, by the paths of people instead of their identities.

    A tracker that confuses two people continues the path of each under the identity of the
    other: one cannot have moved so far, and is where the other one was. Joints, rather than
    centers, are compared with the last ones and with those predicted by their velocity, so
    that people may pass each other, or run. A new number where a person was just lost is that
    person, if no one else can be it and no frame has both. All else keeps its identity, as do
    people whose joints are relative to their own hips.

    Parameters
    ----------
    frames : sequence of mappings of identities to points, shape (n_joints, 3)
        In any unit; NaN where not observed.
    times : shape (n_frames,), seconds, increasing
    """
    observed = [
        {key: points for key, body in frame.items() if len(points := _observed(body))}
        for frame in frames
    ]
    follower = _Follower(observed, _meter_of(observed))
    if follower.is_possible:
        persons = [
            follower.add(bodies, time, frame.keys())
            for bodies, time, frame in zip(observed, times.tolist(), frames, strict=True)
        ]
    else:
        persons = [{key: key for key in frame} for frame in frames]
    return FollowedPeople(persons, follower.switch_times, follower.found_again)


class _Follower(Generic[Key]):
    """Finds the person of each identity, frame by frame.

    Parameters
    ----------
    frames : list of mappings of identities to points
    meter : float, in the unit of the file; 0 if unknown
    """

    def __init__(self, frames: list[dict[Key, Array]], meter: float) -> None:
        self.switch_times: list[float] = []
        self.found_again: list[FoundAgain[Key]] = []
        self._persons = {key: key for frame in frames for key in frame}
        self._stated = dict(self._persons)
        self._possible_persons: dict[Key, set[Key]] = {}
        self._paths: dict[Key, PersonPath] = {}
        self._time = -np.inf
        self._meter = meter
        self._companies = {frozenset(frame) for frame in frames}
        is_few = max(map(len, self._companies), default=0) <= MAX_PEOPLE
        self.is_possible = (
            len(self._persons) > 1 and is_few and meter > 0.0 and _are_separate(frames, meter)
        )

    def add(self, bodies: dict[Key, Array], time: float, keys: Iterable[Key]) -> dict[Key, Key]:
        """Add the people of the next frame; return the persons of all its identities."""
        self._restore(bodies, time)
        claims = Claims(bodies, time, self._persons, self._paths, self._meter, self._may_be_new)
        for group in claims.changes():
            if self._is_certain(group):
                self._apply(group, time)
        self._note_rivals(bodies, time)
        for key, points in bodies.items():
            person = self._persons[key]
            if person in self._paths:
                self._paths[person].add(points, time)
            else:
                self._paths[person] = PersonPath(points, time)
        self._time = time
        return {key: self._persons.setdefault(key, key) for key in keys}

    def _rivals(self, key: Key, bodies: Mapping[Key, Array], time: float) -> set[Key]:
        """Return absent persons whose paths an identity may continue as well as the own one."""
        person, points = self._persons[key], bodies[key]
        if person not in self._paths:
            return set()
        own = self._paths[person].distance(points, time)
        present = {self._persons[each] for each in bodies}
        return {
            other
            for other, path in self._paths.items()
            if other not in present
            and not continues_other_path(own, path.distance(points, time))
        }

    def _restore(self, bodies: Mapping[Key, Array], time: float) -> None:
        """Give those who were missing their identity in the file, if it fits as well.

        What follows a gap is less certain than what the file states.
        """
        for key in bodies:
            path = self._paths.get(self._persons[key])
            was_missing = path is None or path.time < self._time
            is_stated = self._persons[key] == self._stated[key]
            if was_missing and not is_stated and self._may_be_stated(key, bodies, time):
                self._give({key: self._stated[key]})
                self.switch_times.append(time)

    def _may_be_stated(self, key: Key, bodies: Mapping[Key, Array], time: float) -> bool:
        """Return whether an identity may be whom the file states, after a gap."""
        person, stated = self._persons[key], self._stated[key]
        holder = next((each for each in bodies if self._persons[each] == stated), None)
        if holder is None:
            return person not in self._paths or stated in self._rivals(key, bodies, time)
        path = self._paths.get(stated)
        if path is None:
            return False
        own, held = (path.distance(bodies[each], time) for each in (key, holder))
        return own < held or person in self._possible_persons[stated]

    def _note_rivals(self, bodies: Mapping[Key, Array], time: float) -> None:
        """Note whom each person may be instead, until both are observed together."""
        present = {self._persons[each] for each in bodies}
        for key in bodies:
            possible = self._possible_persons.setdefault(self._persons[key], set())
            possible |= self._rivals(key, bodies, time)
            possible -= present

    def _is_certain(self, group: Mapping[Key, Key]) -> bool:
        """Return whether the paths of a group are those of its persons, or it is as stated."""
        if all(person == self._stated[key] for key, person in group.items()):
            return True
        persons = {*group.values(), *(self._persons[key] for key in group)}
        return not any(self._possible_persons.get(person) for person in persons)

    def _apply(self, group: Mapping[Key, Key], time: float) -> None:
        """Give identities other persons, and note when."""
        ((key, person), *others) = group.items()
        if not others and self._persons[key] not in self._paths:
            self.found_again.append(FoundAgain(person, key, time))
            holder = next(each for each, owned in self._persons.items() if owned == person)
            self._stated |= {key: person, holder: self._persons[key]}
        else:
            self.switch_times.append(time)
        self._give(group)

    def _give(self, group: Mapping[Key, Key]) -> None:
        """Give identities other persons; those who lose theirs get what is left."""
        left = {self._persons[each] for each in group} - set(group.values())
        losers = [
            each
            for each, owned in self._persons.items()
            if owned in group.values() and each not in group
        ]
        self._persons.update(group)
        self._persons.update(zip(losers, left, strict=True))

    def _may_be_new(self, key: Key, person: Key) -> bool:
        """Return whether a number without a path so far may be new for a person."""
        holder = next(each for each, owned in self._persons.items() if owned == person)
        return (
            self._persons[key] not in self._paths
            and _is_number(key)
            and _is_number(holder)
            and not any({key, holder} <= company for company in self._companies)
        )


def _is_number(key: Hashable) -> bool:
    """Return whether a tracker counted a person, rather than gave a name."""
    text = key.decode("latin-1") if isinstance(key, bytes) else str(key)
    return text.strip().isdigit()


def _observed(points: Array) -> Array:
    """Return points with NaN for those at the origin, where many trackers put missing ones.

    Without points there is no body, nor if all are at one position.
    """
    points = np.where(points.any(axis=1, keepdims=True), points, np.nan)
    found = points[np.isfinite(points).all(axis=1)]
    return points if len(found) > 1 and (found != found[0]).any() else points[:0]


def _meter_of(frames: list[dict[Key, Array]]) -> float:
    """Return the length of a meter in the unit of the file, by the sizes of people."""
    sampled = frames[:: max(1, len(frames) // N_SAMPLED_FRAMES)]
    sizes = [
        float((np.nanmax(points, axis=0) - np.nanmin(points, axis=0)).max())
        for frame in sampled
        for points in frame.values()
    ]
    return float(np.median(sizes)) / ADULT_EXTENT_M if sizes else 0.0


def _are_separate(frames: list[dict[Key, Array]], meter: float) -> bool:
    """Return whether people have positions in the room, rather than all the same one."""
    distances = [
        float(np.linalg.norm(center(one) - center(other)))
        for frame in frames[:: max(1, len(frames) // N_SAMPLED_FRAMES)]
        for one, other in combinations(frame.values(), 2)
    ]
    return not distances or float(np.median(distances)) > MIN_SWITCH_M * meter
