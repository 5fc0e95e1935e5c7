"""Follow the people in a recording of depth, and choose the actor."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .bodies import Bodies

Array = NDArray[np.float64]

FASTEST = 4.0
"""Metres per second that a body's middle moves at most."""
LONGEST_UNSEEN = 1.0
"""Seconds after which a body that comes again counts as another one."""
SLACK = 0.3
"""Metres by which the middle of what is seen may jump."""


@dataclass
class _Person:
    """Somebody who was seen, at which of the looks, where, and how large."""

    looks: list[int] = field(default_factory=list)
    middles: list[Array] = field(default_factory=list)
    area: float = 0.0

    def add(self, look: int, middle: Array, area: float) -> None:
        self.looks.append(look)
        self.middles.append(middle)
        self.area += area


@dataclass(frozen=True, eq=False)
class People:
    """Who was seen in frames spread over a recording.

    Attributes
    ----------
    frames : int array, shape (n_looks,)
        The frames that were looked at.
    n_bodies : int array, shape (n_looks,)
        How many people were in each.
    course : float array, shape (n_frames, 3), metres
        Where the actor is in the camera's frame, in every frame of the recording; NaN where
        the actor is not.
    """

    frames: NDArray[np.intp]
    n_bodies: NDArray[np.intp]
    course: Array


def follow_people(
    look: Callable[[int], Bodies],
    frames: NDArray[np.intp],
    n_frames: int,
    frame_rate: float,
) -> People:
    """Look at some frames, follow who is seen there, and take for the actor who is seen most.

    That is the person with the largest sum of seen surfaces. Whoever is seen only when the
    actor is not is the same actor, who has come back.

    Parameters
    ----------
    look : callable
        Takes a frame and returns the people in it.
    frames : int array, shape (n_looks,)
        Always increasing.
    n_frames : int
    frame_rate : float, hertz
    """
    people: list[_Person] = []
    counts = []
    for number, frame in enumerate(frames.tolist()):
        found = look(frame)
        counts.append(len(found.areas))
        _assign(people, found, number, frames, frame_rate)
    actor: dict[int, Array] = {}
    for person in sorted(people, key=lambda person: -person.area):
        span = range(person.looks[0], person.looks[-1] + 1)
        if not any(look in actor for look in span):
            actor.update(zip(person.looks, person.middles, strict=True))
    course = _course(actor, frames, n_frames, frame_rate)
    return People(frames, np.array(counts, dtype=np.intp), course)


def _assign(
    people: list[_Person],
    found: Bodies,
    number: int,
    frames: NDArray[np.intp],
    frame_rate: float,
) -> None:
    """Give each body to the person nearest to it, the nearest pair first."""
    pairs = []
    for body, middle in enumerate(found.middles):
        for index, person in enumerate(people):
            passed = (frames[number] - frames[person.looks[-1]]) / frame_rate
            apart = float(np.linalg.norm(middle - person.middles[-1]))
            if passed <= LONGEST_UNSEEN and apart <= SLACK + FASTEST * passed:
                pairs.append((apart, body, index))
    bodies, taken = set(range(len(found.areas))), set()
    for _, body, index in sorted(pairs):
        if body in bodies and index not in taken:
            bodies.remove(body)
            taken.add(index)
            people[index].add(number, found.middles[body], float(found.areas[body]))
    for body in sorted(bodies):
        people.append(_Person())
        people[-1].add(number, found.middles[body], float(found.areas[body]))


def _course(
    actor: dict[int, Array], frames: NDArray[np.intp], n_frames: int, frame_rate: float
) -> Array:
    """Interpolate between looks; before, after and far from them the actor is not there."""
    course = np.full((n_frames, 3), np.nan)
    if not actor:
        return course
    looks = sorted(actor)
    seen = frames[looks]
    middles = np.stack([actor[look] for look in looks])
    every = np.arange(n_frames)
    for axis in range(3):
        course[:, axis] = np.interp(every, seen, middles[:, axis])
    place = np.searchsorted(seen, every)
    before = seen[np.clip(place - 1, 0, len(seen) - 1)]
    after = seen[np.clip(place, 0, len(seen) - 1)]
    step = int(np.diff(frames).max(initial=1))
    near = np.minimum(np.abs(every - before), np.abs(every - after)) < step
    joined = (before <= every) & (every <= after)
    joined &= after - before <= LONGEST_UNSEEN * frame_rate
    course[~(near | joined)] = np.nan
    return course
