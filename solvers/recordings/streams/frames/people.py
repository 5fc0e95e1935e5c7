"""Recognize the people of a stream by their positions, whatever their sender calls them."""

import math
from dataclasses import dataclass

import numpy as np

from ...identities import (
    BODY_TIMEOUT_S,
    MAX_PEOPLE,
    MAX_RETURN_M,
    MIN_SWITCH_M,
    continues_other_path,
)
from .joint_frames import LiveFrame
from .pose_frames import PoseFrame

NEW_STREAM_S = 2.0
"""Minimum backward jump in time that starts a new stream, seconds. It guards packets that
arrive in another order, which are a fraction of a second late."""
MIN_ABSENCE_S = 0.1
"""Seconds after which someone counts as missing. It guards against frames that come in another
order; three frames at 30 Hz."""

Position = tuple[float, float, float]


@dataclass
class Person:
    """Someone in the stream.

    Attributes
    ----------
    number : int
        From 1, in the order in which people appear.
    body : int
        What the sender first called them.
    position : float, float, float; meters
    time : float, seconds
    """

    number: int
    body: int
    position: Position
    time: float


class StreamPeople:
    """Follows people by their positions, so that switched and new identities change nothing.

    A tracker that confuses two people continues the path of each under the identity of the
    other: both jump at once. A person who is missing for a while has a new identity at the
    same position.
    """

    def __init__(self) -> None:
        self._by_identity: dict[int, Person] = {}

    def forget(self) -> None:
        """Forget everyone: another stream comes."""
        self._by_identity.clear()

    @property
    def n_present(self) -> int:
        """Number of people in the last second of the stream."""
        return len(self._by_identity)

    def is_present(self, number: int) -> bool:
        """Return whether a number is that of someone in the last second of the stream."""
        return any(person.number == number for person in self._by_identity.values())

    def add(self, frame: LiveFrame | PoseFrame) -> Person | None:
        """Return who a frame shows; None beyond the maximum number of people."""
        self._forget_absent(frame.time)
        person = self._by_identity.get(frame.body)
        position = _position_of(frame)
        if person is None:
            person = self._find_returned_person(frame, position) or self._new(frame, position)
        elif position is not None:
            person = self._undo_identity_switch(frame.body, person, position)
        if person is not None and frame.time >= person.time:
            person.time = frame.time
            person.position = position or person.position
        return person

    def _forget_absent(self, time: float) -> None:
        for identity, person in list(self._by_identity.items()):
            if not -NEW_STREAM_S < time - person.time <= BODY_TIMEOUT_S:
                del self._by_identity[identity]

    def _undo_identity_switch(
        self, identity: int, person: Person, position: Position
    ) -> Person:
        """Return whose path a position continues, and undo an identity switch."""
        jump = math.dist(position, person.position)
        if jump < MIN_SWITCH_M:
            return person
        for other_identity, other in self._by_identity.items():
            distance = math.dist(position, other.position)
            if other is not person and continues_other_path(distance, jump):
                self._by_identity[identity] = other
                self._by_identity[other_identity] = person
                return other
        return person

    def _find_returned_person(
        self, frame: LiveFrame | PoseFrame, position: Position | None
    ) -> Person | None:
        """Return who was missing at this position and has a new identity, if anyone."""
        if position is None:
            return None
        for identity, person in self._by_identity.items():
            is_missing = frame.time - person.time > MIN_ABSENCE_S
            if is_missing and math.dist(position, person.position) < MAX_RETURN_M:
                del self._by_identity[identity]
                self._by_identity[frame.body] = person
                return person
        return None

    def _new(self, frame: LiveFrame | PoseFrame, position: Position | None) -> Person | None:
        """Give someone new the lowest free number."""
        if position is None or self.n_present >= MAX_PEOPLE:
            return None
        taken = {person.number for person in self._by_identity.values()}
        number = min(set(range(1, MAX_PEOPLE + 1)) - taken)
        person = Person(number, frame.body, position, frame.time)
        self._by_identity[frame.body] = person
        return person


def _position_of(frame: LiveFrame | PoseFrame) -> Position | None:
    """Return where a body is; None if no joint is observed."""
    if isinstance(frame, PoseFrame):
        x, y, z = frame.root_position.tolist()
        return x, y, z
    observed = frame.positions[np.isfinite(frame.positions).all(axis=-1)]
    if not len(observed):
        return None
    x, y, z = observed.mean(axis=0).tolist()
    return x, y, z
