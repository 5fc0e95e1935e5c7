"""A part of the body that bears on the floor: which of its points must not move, and when."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ..arrays import Array, Flags
from ..motion import WorldPoses
from ..motion_fitting.goals import BonePoint, StayInPlace
from ..signals import find_runs

MIN_LIFT_M = 0.01
"""Meters, for a leg of 0.9 m: a planted sole this far above its contact height may rise. Half
and twice gain less than 1 % (`make sensitivity`)."""
IN_CONTACT = 0.5
"""Probability of contact above which a part is in contact. By definition."""
CERTAIN = 0.9
"""Probability of contact from which a part is held completely. Chosen by hand on development
takes: 0.7 doubles how much feet jerk where a contact begins or ends, 1 lets them drift by 9 mm
in place of 0.9 between. `test_foot_does_not_jerk_where_it_lands_and_lifts` fails without it."""


@dataclass(frozen=True, eq=False)
class Support:
    """A part of the body that bears on the floor.

    Attributes
    ----------
    size : float
        Length of the legs over that of an adult's, 0.9 m.
    contact : bool, shape (n_frames,)
    points : sequence of BonePoint
    load : shape (n_frames, n_points)
        Fraction of the load on each point.
    held : shape (n_frames - 1,), 0 to 1
        How far it is held from each frame to the next; 0 moves it as it is recorded.
    steps : shape (n_frames - 1, 3), 0 to 1
        How certainly the loaded point is held in each step, by direction.
    """

    size: float
    contact: Flags
    points: Sequence[BonePoint]
    load: Array
    held: Array
    steps: Array

    def slice(self, start: int, stop: int) -> Self:
        """Return the contact in frames `start` up to but without `stop`."""
        return replace(
            self,
            contact=self.contact[start:stop],
            load=self.load[start:stop],
            held=self.held[start : stop - 1],
            steps=self.steps[start : stop - 1],
        )

    def slide(self, poses: WorldPoses, recorded: WorldPoses) -> float:
        """Return the distance in meters that the loaded point covers where it is held.

        What it is to move, as far as it is not held, does not count.
        """
        slid = self._moved(poses) - self._wanted(recorded)
        return float(np.linalg.norm(slid[self.held > 0.0, :2], axis=1).sum())

    def stay_in_place(self, poses: WorldPoses, tolerance: float) -> StayInPlace:
        """Return the goal that the loaded point moves only as far as it is not held.

        Parameters
        ----------
        poses : WorldPoses
            As recorded.
        tolerance : float, meters per second
        """
        wanted = self._wanted(poses)
        return StayInPlace(self.points, self.step_load, self.steps, tolerance, wanted)

    def _wanted(self, recorded: WorldPoses) -> Array:
        return np.asarray((1.0 - self.held)[:, None] * self._moved(recorded))

    def _moved(self, poses: WorldPoses) -> Array:
        """Return the displacement of the loaded point in each step, (n_frames - 1, 3)."""
        positions = np.stack([point.position(poses) for point in self.points], axis=1)
        return np.asarray(np.einsum("fp,fpi->fi", self.step_load, np.diff(positions, axis=0)))

    @property
    def step_load(self) -> Array:
        """Fraction of the load on each point from each frame to the next."""
        return np.asarray(0.5 * (self.load[1:] + self.load[:-1]))


def both_in_contact(contact: Flags) -> Flags:
    """Return the steps, (n_frames - 1, ...), between frames that are both in contact."""
    return np.asarray(contact[1:] & contact[:-1])


def held_steps(probability: Array | Flags) -> Array:
    """Return how far what is in contact with a probability is held, as `Support.held`.

    A foot that lands or lifts moves: on clean captures the loaded point has 0.3 to 1 m/s in the
    first and the last step in which contact is likelier than not. If it were held at once, it
    would stop and start within one frame. So it is held as far as the contact is believed, from
    not at all where contact is as likely as not. Between two frames of a contact that are more
    certain, a doubt does not count: only at its beginning and at its end a contact is let go.

    Parameters
    ----------
    probability : shape (n_frames,)
        Of contact, or whether there is one.
    """
    certainty = np.zeros(len(probability))
    for start, stop in find_runs(probability > IN_CONTACT):
        run = probability[start:stop]
        since, until = (np.maximum.accumulate(each) for each in (run, run[::-1]))
        certainty[start:stop] = np.minimum(since, until[::-1])
    held = np.clip((certainty - IN_CONTACT) / (CERTAIN - IN_CONTACT), 0.0, 1.0)
    return np.minimum(held[1:], held[:-1])


def resting_steps(height: Array, contact: Flags, held: Array, size: float) -> Array:
    """Return how certainly what has a height is held in each step, as `Support.steps`.

    Height in meters and contact have the shape (n_frames,), `held` is that of `Support`, and
    `size` is relative to a human.
    """
    steps = np.repeat(held[:, None], 3, axis=1)
    rise = np.abs(height - median_contact_heights(height, contact))
    rise = np.maximum(rise[1:], rise[:-1])
    steps[:, 2] *= np.clip(2.0 - rise / (MIN_LIFT_M * size), 0.0, 1.0)
    return steps


def median_contact_heights(height: Array, contact: Flags) -> Array:
    """Return the median height of each contact, (n_frames,); the height itself elsewhere."""
    contact_height = height.copy()
    for start, stop in find_runs(contact):
        contact_height[start:stop] = np.median(height[start:stop])
    return contact_height
