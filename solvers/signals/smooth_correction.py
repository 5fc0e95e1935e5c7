"""Correct a curve as smoothly as possible so that it has a given velocity in some frames."""

import numpy as np

from ..arrays import Array
from .second_differences import second_difference_bands

FADE_TIME_CONSTANTS = np.pi * np.sqrt(2.0)
"""Time constants after which a free correction has faded to exp(-pi), 4 %. By definition of the
blend."""
PULL_WEIGHT = 100.0
"""Weight of a goal; at 100 the goal is met to one hundredth. Chosen by hand: x0.5 costs 0.2 %,
x2 costs nothing."""


def smooth_correction(
    speed: Array,
    held: Array,
    frame_rate: float,
    blend: float,
    *,
    hold: float = 10.0,
    goal: Array | None = None,
    pulled: Array | None = None,
) -> Array:
    """Return the smoothest correction that gives a curve a target velocity where it is held.

    The correction d minimizes the integral of

        |d|^2 + tau^4 |d''|^2 + held hold^2 |d' - speed|^2 + pulled p |d - goal|^2

    with long `hold` and large p. It stays small, eases in and out, and a held curve rests at
    the position that needs the least correction. Outside of holds it decays as
    exp(-t / (tau sqrt 2)) at every frame rate. Discretized, this is one banded linear system
    per component.

    Parameters
    ----------
    speed : shape (n_frames - 1, n_components), per second
        From each frame to the next; ignored where the curve is not held.
    held : shape (n_frames - 1,) or (n_frames - 1, n_components), 0 to 1
        Weight of the target velocity.
    frame_rate : float, hertz
    blend : float, seconds
        Time in which a correction fades.
    hold : float, seconds
        A curve held for much longer than this may drift slowly, which bounds the correction.
    goal : shape (n_frames, n_components)
        Target value of the correction.
    pulled : shape (n_frames, n_components), 0 to 1
        Weight of the goal.

    Returns
    -------
    Array
        Shape (n_frames, n_components).
    """
    from scipy.linalg import solveh_banded  # slow to import: only when needed

    n_frames, n_components = len(speed) + 1, speed.shape[1]
    held = np.broadcast_to(held if held.ndim == 2 else held[:, None], speed.shape)
    goal = np.zeros((n_frames, n_components)) if goal is None else goal
    pulled = np.zeros((n_frames, n_components)) if pulled is None else pulled
    stiffness = (blend / FADE_TIME_CONSTANTS * frame_rate) ** 4
    correction = np.empty((n_frames, n_components))
    for component in range(n_components):
        hold_weight = (hold * frame_rate) ** 2 * held[:, component]
        pull_weight = PULL_WEIGHT * pulled[:, component]
        bands = stiffness * second_difference_bands(n_frames)
        bands[2] += 1.0 + pull_weight
        bands[2, :-1] += hold_weight
        bands[2, 1:] += hold_weight
        bands[1, 1:] -= hold_weight
        force = (
            hold_weight * np.where(held[:, component] > 0, speed[:, component], 0) / frame_rate
        )
        right_side = pull_weight * goal[:, component]
        right_side[1:] += force
        right_side[:-1] -= force
        correction[:, component] = solveh_banded(bands, right_side)
    return correction
