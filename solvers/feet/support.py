"""A part of the body that bears on the floor: which of its points must not move, and when."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ..arrays import Array, Flags
from ..motion import WorldPoses
from ..motion_fitting.goals import BonePoint
from ..signals import find_runs

MIN_LIFT_M = 0.01
"""Meters, for a leg of 0.9 m: a planted sole this far above its contact height may rise. Half
and twice gain less than 1 % (`make sensitivity`)."""


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
    steps : shape (n_frames - 1, 3), 0 to 1
        How certainly the loaded point rests from each frame to the next, by direction.
    """

    size: float
    contact: Flags
    points: Sequence[BonePoint]
    load: Array
    steps: Array

    def slice(self, start: int, stop: int) -> Self:
        """Return the contact in frames `start` up to but without `stop`."""
        return replace(
            self,
            contact=self.contact[start:stop],
            load=self.load[start:stop],
            steps=self.steps[start : stop - 1],
        )

    def slide(self, poses: WorldPoses) -> float:
        """Return the distance in meters that the loaded point covers in contact."""
        positions = np.stack([point.position(poses) for point in self.points], axis=1)
        moved = np.einsum("fp,fpi->fi", self.step_load, np.diff(positions, axis=0))
        return float(np.linalg.norm(moved[both_in_contact(self.contact), :2], axis=1).sum())

    @property
    def step_load(self) -> Array:
        """Fraction of the load on each point from each frame to the next."""
        return np.asarray(0.5 * (self.load[1:] + self.load[:-1]))


def both_in_contact(contact: Flags) -> Flags:
    """Return the steps, (n_frames - 1, ...), between frames that are both in contact."""
    return np.asarray(contact[1:] & contact[:-1])


def resting_steps(height: Array, contact: Flags, size: float) -> Array:
    """Return how certainly what has a height rests in each step, as `Support.steps`.

    Height in meters and contact have the shape (n_frames,); `size` is relative to a human.
    """
    steps = np.repeat(both_in_contact(contact)[:, None].astype(np.float64), 3, axis=1)
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
