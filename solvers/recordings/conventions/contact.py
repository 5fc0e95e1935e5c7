"""Measure along which axis the points that carry a body rest: they do not slide."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array

N_SAMPLED_STEPS = 60
"""Number of steps from one frame to the next, evenly spaced, that are evaluated. It bounds the
run time."""
CONTACT_FRACTION = 0.05
"""Height above the lowest point, relative to the body, at which the weight of a point is 1/e.
By definition about the height of an ankle, 0.039 in Winter (2009), figure 4.1, and a shoe."""

TRAVEL_FRACTION = 0.5
"""Speed of the center of the points, relative to their mean speed, from which contact is full
evidence. Measured: joints on a floor have 0.5 to 0.96, those relative to the hips 0 in most
takes."""


def sampled_steps(is_observed: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return some of the observed frames that are followed by one, evenly spaced.

    Parameters
    ----------
    is_observed : shape (n_frames,)
    """
    steps = np.flatnonzero(is_observed[:-1] & is_observed[1:])
    return steps[:: max(1, len(steps) // N_SAMPLED_STEPS)]


@np.errstate(over="ignore", invalid="ignore")  # numbers that are refused later
def measure_contact(before: Array, after: Array, directions: Array) -> Array:
    """Return the evidence of each direction to be up, 0 to 1, shape (n_directions,).

    It is 1 where the lowest points along it rest, and 0 where they move as fast as all points
    do on average. It is 0 along all directions where the center of the points stays in place:
    what rests then may be near the center rather than carry the body. Points that never
    move are not those of a body.

    Parameters
    ----------
    before, after : shape (n_steps, n_points, 3)
        Points in frames, and in those that follow them; NaN where missing.
    directions : shape (n_directions, 3)
        Unit vectors.
    """
    is_moved = np.isfinite(after - before) & (after != before)
    is_observed = np.isfinite(before + after).all(axis=2) & is_moved.any(axis=(0, 2))
    is_step = is_observed.any(axis=1)
    if not is_step.any():
        return np.zeros(len(directions))
    before, after, is_observed = before[is_step], after[is_step], is_observed[is_step]
    steps = np.where(is_observed[..., None], after - before, 0.0)
    speeds = np.linalg.norm(steps, axis=2)
    travel = np.linalg.norm(steps.sum(axis=1), axis=1).sum() / speeds.sum()
    heights = (before + after) / 2.0 @ directions.T
    heights = np.where(is_observed[..., None], heights, np.inf)
    lowest = heights.min(axis=1, keepdims=True)
    extents = np.where(is_observed[..., None], heights - lowest, 0.0).max(axis=(1, 2))
    size = max(float(np.median(extents)), 1e-9)
    mean = speeds.sum() / is_observed.sum()
    weights = np.exp((lowest - heights) / (CONTACT_FRACTION * size))
    speeds_below = np.einsum("sp,spd->d", speeds, weights) / weights.sum(axis=(0, 1))
    rest = np.clip(1.0 - speeds_below / mean, 0.0, 1.0)
    return np.asarray(min(1.0, travel / TRAVEL_FRACTION) * rest)
