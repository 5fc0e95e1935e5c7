"""Compare the people of one frame with the paths of all, and find whose path each continues."""

from collections.abc import Callable, Hashable, Mapping
from typing import Generic, TypeVar

from ...arrays import Array
from .evidence import BODY_TIMEOUT_S, MAX_RETURN_M, MIN_SWITCH_M, continues_other_path
from .path import PersonPath

Key = TypeVar("Key", bound=Hashable)
MAX_HIDDEN_SPEED_M_S = 2.0
"""Meters per second that a person may have moved since the last frame, in addition to
`MIN_SWITCH_M`. It guards people who walk while they are hidden."""


class Claims(Generic[Key]):
    """Identities of one frame and the persons that they claim to be.

    Parameters
    ----------
    bodies : mapping of identities to points, shape (n_joints, 3), in the unit of the file
    time : float, seconds
    persons : mapping of identities to persons, up to this frame
    paths : mapping of persons to their paths so far
    meter : float, in the unit of the file
    may_be_new : callable
        Returns whether an identity may be new for a person that was found before.
    """

    def __init__(
        self,
        bodies: Mapping[Key, Array],
        time: float,
        persons: Mapping[Key, Key],
        paths: Mapping[Key, PersonPath],
        meter: float,
        may_be_new: Callable[[Key, Key], bool],
    ) -> None:
        self.claimed = {key: persons[key] for key in bodies}
        self._bodies, self._time, self._meter = bodies, time, meter
        self._may_be_new = may_be_new
        self._all_paths = paths
        self._paths = {
            person: path for person, path in paths.items() if time - path.time <= BODY_TIMEOUT_S
        }
        self._own = {
            key: self._paths[person].distance(bodies[key], time)
            for key, person in self.claimed.items()
            if person in self._paths
        }

    def jumps(self, key: Key) -> bool:
        """Return whether an identity is farther from its person than people move."""
        if key not in self._own:
            return False
        reach = MIN_SWITCH_M * self._meter + self._walked(self._paths[self.claimed[key]])
        return self._own[key] > reach

    def _walked(self, path: PersonPath) -> float:
        """Return how far a person may have walked since the last observation."""
        gap = self._time - path.time
        return MAX_HIDDEN_SPEED_M_S * self._meter * gap

    def changes(self) -> list[dict[Key, Key]]:
        """Return groups of identities with the other persons whose paths they clearly continue.

        The identities of a group take each other's persons, or that of someone who is missing.
        """
        may_be_found_again = len(self._own) < len(self.claimed) and self._missing
        if not may_be_found_again and not any(map(self.jumps, self.claimed)):
            return []
        return [group for group in self._groups(self._nearest()) if self._is_clear(group)]

    @property
    def _missing(self) -> list[Key]:
        """Persons of the last frames whom no identity of this one claims."""
        claimed = set(self.claimed.values())
        return [person for person in self._paths if person not in claimed]

    def _distance(self, key: Key, person: Key) -> float:
        """Return how far an identity is from a person; someone new may be anywhere."""
        if person not in self._paths:
            return MAX_RETURN_M * self._meter
        return self._paths[person].distance(self._bodies[key], self._time)

    def _nearest(self) -> dict[Key, Key]:
        """Return a person for each identity, the nearest pairs first."""
        persons = [*self.claimed.values(), *self._missing]
        pairs = sorted(
            (
                (self._distance(key, person), person != claimed, key, person)
                for key, claimed in self.claimed.items()
                for person in persons
            ),
            key=lambda pair: pair[:2],
        )
        found: dict[Key, Key] = {}
        taken: set[Key] = set()
        for _, _, key, person in pairs:
            if key not in found and person not in taken:
                found[key] = person
                taken.add(person)
        return found

    def _groups(self, nearest: Mapping[Key, Key]) -> list[dict[Key, Key]]:
        """Return the changes, those that take each other's persons together."""
        claimant = {person: key for key, person in self.claimed.items()}
        groups: list[dict[Key, Key]] = []
        for key, person in nearest.items():
            if person == self.claimed[key]:
                continue
            linked = [
                group
                for group in groups
                if claimant.get(person) in group or self.claimed[key] in group.values()
            ]
            groups = [group for group in groups if group not in linked]
            groups.append({key: person} | {k: p for group in linked for k, p in group.items()})
        return groups

    def _is_clear(self, group: Mapping[Key, Key]) -> bool:
        """Return whether nothing but a switch or a new identity explains a group."""
        if any(key in self._own and not self.jumps(key) for key in group):
            return False
        found = [(key, person) for key, person in group.items() if person in self._paths]
        return bool(found) and all(self._continues(key, person) for key, person in found)

    def _continues(self, key: Key, person: Key) -> bool:
        """Return whether an identity clearly continues the path of a person."""
        distance = self._distance(key, person)
        rivals = [other for other, claimed in self.claimed.items() if claimed == person]
        own = [self._own[each] for each in (key, *rivals) if each in self._own]
        if not rivals and distance > MAX_RETURN_M * self._meter:
            return False
        if own:
            return continues_other_path(distance, min(own))
        return self._is_found_again(key, person, distance)

    def _is_found_again(self, key: Key, person: Key, distance: float) -> bool:
        """Return whether a new identity is a missing person and no one else can be it."""
        claimed = {*self.claimed.values(), person}
        others = [
            path.distance(self._bodies[key], self._time) - self._walked(path)
            for other, path in self._all_paths.items()
            if other not in claimed
        ]
        others += [
            self._distance(other, person)
            for other in self.claimed
            if other != key and other not in self._own
        ]
        return self._may_be_new(key, person) and all(
            continues_other_path(distance, other) for other in others
        )
