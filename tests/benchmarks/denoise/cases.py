"""One damaged clip with everything a method may know, and what a method makes of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from solvers.motion import Motion

from ..shared.noise import (
    METERS_PER_DEGREE,
    Array,
    Channels,
    channel_error,
    corrupt,
    corrupt_in_bursts,
    one_over_f,
    seeded,
)


@dataclass(frozen=True)
class Level:
    """How much a clip is damaged: degrees, and the fraction of samples that are outliers."""

    sigma: float
    fraction: float = 0.0
    bursts: bool = False
    """Whether outliers are whole joints for a few frames instead of single samples."""
    drifts: bool = False
    """Whether the noise is 1/f noise instead of white noise; then there are no outliers."""
    follows: bool = True
    """Whether a line in a picture leads from the level before to this one."""

    def __str__(self) -> str:
        if self.drifts:
            return f"{self.sigma:g}, 1/f drift"
        outliers = f"{100 * self.fraction:g} %" if self.fraction else "0"
        return f"{self.sigma:g}, {outliers}{' in bursts' if self.bursts else ''}"


LEVELS = (
    *(Level(sigma) for sigma in (0.0, 1.0, 3.0, 5.0, 7.0)),
    Level(3.0, 0.05, follows=False),
    *(Level(3.0, fraction) for fraction in (0.10, 0.15, 0.25, 0.40)),
)
BURSTS = tuple(Level(3.0, fraction, bursts=True) for fraction in (0.02, 0.05, 0.10))


@dataclass(frozen=True, eq=False)
class Case:
    """A clip, damaged, with the clips that a method may learn from."""

    name: str
    level: Level
    truth: Motion
    training: Sequence[Motion]
    channels: Channels
    clean_root: bool = False

    @cached_property
    def clean(self) -> Array:
        """True angle channels, degrees, and root position in units of METERS_PER_DEGREE."""
        return with_root(self.channels.values(self.truth), self.truth)

    @cached_property
    def noisy(self) -> Array:
        """Corrupted channels, same shape as `clean`."""
        rng = seeded(self.name, self.level.sigma, self.level.fraction)
        sigma, fraction = self.level.sigma, self.level.fraction
        if self.level.drifts:
            noisy = self.clean + sigma * one_over_f(self.clean.shape, rng)
        elif self.level.bursts:
            noisy = corrupt_in_bursts(self.clean, sigma, fraction, self._groups, rng)
        else:
            noisy = corrupt(self.clean, sigma, fraction, rng)
        if self.clean_root:
            noisy[:, -3:] = self.clean[:, -3:]
        return noisy

    @property
    def _groups(self) -> list[NDArray[np.intp]]:
        """Channels that belong together: each joint's, and the root's position."""
        moving = np.flatnonzero(self.channels.joints)
        root = np.arange(-3, 0) + self.clean.shape[1]
        return [*(self.channels.of_joints([joint]) for joint in moving), root]

    @cached_property
    def noisy_motion(self) -> Motion:
        """What our method is given."""
        return self.motion(self.noisy)

    @cached_property
    def training_values(self) -> list[Array]:
        """Angle channels of the training clips, headings of each about zero."""
        return [without_heading(self.channels.values(motion)) for motion in self.training]

    def motion(self, values: Array) -> Motion:
        """Return the motion with these channels, root included."""
        moved = self.channels.motion(values[:, :-3], self.truth)
        return moved.with_poses(root_positions=values[:, -3:] * METERS_PER_DEGREE)

    def values(self, motion: Motion) -> Array:
        """Return the channels of a motion, root included; its heading near the true one.

        Where the first frame looks backward, noise decides whether a heading starts at half a
        turn or at minus half a turn.
        """
        values = with_root(self.channels.values(motion), motion)
        if self.channels.kept[0]:
            values[:, 0] -= 360.0 * np.round((values[:, 0] - self.clean[:, 0]).mean() / 360.0)
        return values

    def error(self, estimate: Array) -> float:
        """Mean absolute error of the angle channels, degrees."""
        return channel_error(estimate[:, :-3], self.clean[:, :-3])


def with_root(values: Array, motion: Motion) -> Array:
    """Append the root's position in units of METERS_PER_DEGREE."""
    return np.hstack([values, motion.root_positions / METERS_PER_DEGREE])


def without_heading(values: Array) -> Array:
    """Return channels whose first, the heading, is about zero in this clip."""
    return np.hstack([values[:, :1] - values[:, :1].mean(), values[:, 1:]])
