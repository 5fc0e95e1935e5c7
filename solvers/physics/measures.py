"""What there is to say about a simulation."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics

OTHER_GROUND = 0.25
"""Metres, for legs of 0.9 m, by which the feet's ground may differ from the one given."""


def mean_distance(motion: Motion, other: Motion, joints: Sequence[int]) -> float:
    """Return the mean distance in metres between the same joints of two motions."""
    here, there = (
        forward_kinematics(each).positions[:, list(joints)] for each in (motion, other)
    )
    return float(np.linalg.norm(there - here, axis=-1).mean())


def told(followed: NDArray[np.bool_], given_up: bool, smoothing: float) -> str:
    """Say where the body could follow, and that the take had to be calmed for it (seconds)."""
    n_lost, n_frames = int((~followed).sum()), len(followed)
    if given_up:
        return "The simulated body could not follow the take, which is left as it is."
    calmed = f" It had to be calmed by {smoothing:.2g} s for that." if smoothing else ""
    if not n_lost:
        return f"The simulated body followed the whole take.{calmed}"
    first = int(np.flatnonzero(~followed)[0])
    return (
        f"The simulated body could not follow in {n_lost} of {n_frames} frames, the first of"
        f" them {first}; there the take is left as it is.{calmed}"
    )


def stands_on(ground: float, under_feet: float, size: float) -> bool:
    """Whether a body of this size stands on the ground, or near it: both are heights."""
    return abs(under_feet - ground) <= OTHER_GROUND * size


def about_ground(ground: float, under_feet: float, size: float, given: float | None) -> str:
    """Say that the ground is not where the take stands, or not at the height that was given.

    `given` is None where it must not be there; nothing is said where all is as expected.
    """
    if given is not None and not stands_on(given, ground, size):
        return (
            f" The take stands at a height of {ground:.2f} m, far from {given:.2f} m: the"
            " ground is taken to be under its feet."
        )
    if stands_on(ground, under_feet, size):
        return ""
    return (
        f" The take stands at a height of {under_feet:.2f} m, the ground is at {ground:.2f} m:"
        " choose the ground under the feet if that is wrong."
    )
