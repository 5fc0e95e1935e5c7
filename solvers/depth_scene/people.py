"""Track the people in a depth recording and select the actor."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .bodies import LabeledBodies

MAX_SPEED_M_S = 4.0
"""Maximum speed of a body's center. It guards recordings of several people: a runner stays one
person, a bystander another (`test_person_who_appears_far_from_one_who_left_is_another`)."""
MAX_GAP_S = 1.0
"""A body that reappears after a longer gap counts as another person. It guards recordings in
which an actor leaves and another one enters
(`test_actor_is_the_same_person_after_returning_elsewhere`)."""
MAX_JUMP_M = 0.3
"""Maximum jump of the center of the visible surface between two samples. It guards recordings
of several people who pass in front of each other
(`test_person_who_appears_far_from_one_who_left_is_another`)."""


@dataclass
class _PersonTrack:
    """One tracked person: samples, center positions and summed visible surface."""

    samples: list[int] = field(default_factory=list)
    centers: list[Array] = field(default_factory=list)
    area: float = 0.0

    def add(self, sample: int, center: Array, area: float) -> None:
        self.samples.append(sample)
        self.centers.append(center)
        self.area += area


@dataclass(frozen=True, eq=False)
class People:
    """The people in sampled frames of a recording.

    Attributes
    ----------
    frames : int array, shape (n_samples,)
        The sampled frames.
    n_bodies : int array, shape (n_samples,)
        Number of people in each sampled frame.
    trajectory : float array, shape (n_frames, 3), meters
        Position of the actor in the camera frame, for every frame; NaN without the actor.
    """

    frames: NDArray[np.intp]
    n_bodies: NDArray[np.intp]
    trajectory: Array


def follow_people(
    observe: Callable[[int], LabeledBodies],
    frames: NDArray[np.intp],
    n_frames: int,
    frame_rate: float,
) -> People:
    """Track people through sampled frames and select the most visible one as the actor.

    The actor is the person with the largest summed visible surface. A person who is visible
    only while the actor is missing counts as the same actor, who has returned.

    Parameters
    ----------
    observe : callable
        Maps a frame to the people in it.
    frames : int array, shape (n_samples,)
        Strictly increasing.
    n_frames : int
    frame_rate : float, hertz
    """
    people: list[_PersonTrack] = []
    n_bodies = []
    for sample, frame in enumerate(frames.tolist()):
        bodies = observe(frame)
        n_bodies.append(len(bodies.areas))
        _assign(people, bodies, sample, frames, frame_rate)
    actor: dict[int, Array] = {}
    for person in sorted(people, key=lambda person: -person.area):
        interval = range(person.samples[0], person.samples[-1] + 1)
        if not any(sample in actor for sample in interval):
            actor.update(zip(person.samples, person.centers, strict=True))
    trajectory = interpolate_trajectory(actor, frames, n_frames, frame_rate)
    return People(frames, np.array(n_bodies, dtype=np.intp), trajectory)


def _assign(
    people: list[_PersonTrack],
    bodies: LabeledBodies,
    sample: int,
    frames: NDArray[np.intp],
    frame_rate: float,
) -> None:
    """Assign each body to the nearest person, starting with the nearest pair."""
    pairs = []
    for body, center in enumerate(bodies.centers):
        for index, person in enumerate(people):
            elapsed = (frames[sample] - frames[person.samples[-1]]) / frame_rate
            distance = float(np.linalg.norm(center - person.centers[-1]))
            if elapsed <= MAX_GAP_S and distance <= MAX_JUMP_M + MAX_SPEED_M_S * elapsed:
                pairs.append((distance, body, index))
    unassigned, assigned = set(range(len(bodies.areas))), set()
    for _, body, index in sorted(pairs):
        if body in unassigned and index not in assigned:
            unassigned.remove(body)
            assigned.add(index)
            people[index].add(sample, bodies.centers[body], float(bodies.areas[body]))
    for body in sorted(unassigned):
        people.append(_PersonTrack())
        people[-1].add(sample, bodies.centers[body], float(bodies.areas[body]))


def interpolate_trajectory(
    actor: dict[int, Array], frames: NDArray[np.intp], n_frames: int, frame_rate: float
) -> Array:
    """Interpolate the actor's positions, (3,) meters by sample, to all frames: (n_frames, 3).

    NaN far from all samples, where the actor counts as missing. Sample i is of `frames[i]`.
    """
    trajectory = np.full((n_frames, 3), np.nan)
    if not actor:
        return trajectory
    samples = sorted(actor)
    observed = frames[samples]
    centers = np.stack([actor[sample] for sample in samples])
    all_frames = np.arange(n_frames)
    for axis in range(3):
        trajectory[:, axis] = np.interp(all_frames, observed, centers[:, axis])
    index = np.searchsorted(observed, all_frames)
    before = observed[np.clip(index - 1, 0, len(observed) - 1)]
    after = observed[np.clip(index, 0, len(observed) - 1)]
    step = int(np.diff(frames).max(initial=1))
    near = np.minimum(np.abs(all_frames - before), np.abs(all_frames - after)) < step
    joined = (before <= all_frames) & (all_frames <= after)
    joined &= after - before <= MAX_GAP_S * frame_rate
    trajectory[~(near | joined)] = np.nan
    return trajectory
