"""The smoothest change of a curve that gives it the speed it should have here and there."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

Array = NDArray[np.float64]

FADE_TIME_CONSTANTS = np.pi * np.sqrt(2.0)
"""A free correction has faded to 4 % after this many of its time constants."""
PULL_WEIGHT = 100.0
"""So large that a goal is met to a hundredth."""


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
    """Return what to add to a curve so that it has a given speed where it is held.

    The correction d minimises the integral of

        |d|^2 + tau^4 |d''|^2 + held hold^2 |d' - speed|^2 + pulled p |d - goal|^2

    with long `hold` and large p: it stays small, sets in and fades smoothly, and chooses the
    place in which a held curve rests so that it moves least. Free of any hold it decays as
    exp(-t / (tau sqrt 2)), whatever the frame rate. Sums in place of the integrals lead to
    one banded linear system per component.

    Parameters
    ----------
    speed : shape (n_frames - 1, n_components), per second
        From each frame to the next; what is not held is ignored.
    held : shape (n_frames - 1,) or (n_frames - 1, n_components), 0 to 1
        How strictly the speed is asked for.
    frame_rate : float, hertz
    blend : float, seconds
        Time over which a correction fades.
    hold : float, seconds
        A curve held for much longer than this may creep, so that it does not end far away.
    goal : shape (n_frames, n_components)
        Where the correction should be, as far as it is `pulled`.
    pulled : shape (n_frames, n_components), 0 to 1

    Returns
    -------
    Array
        Shape (n_frames, n_components).
    """
    n_frames, n_components = len(speed) + 1, speed.shape[1]
    held = np.broadcast_to(held if held.ndim == 2 else held[:, None], speed.shape)
    goal = np.zeros((n_frames, n_components)) if goal is None else goal
    pulled = np.zeros((n_frames, n_components)) if pulled is None else pulled
    bending = (blend / FADE_TIME_CONSTANTS * frame_rate) ** 4
    found = np.empty((n_frames, n_components))
    for component in range(n_components):
        stiffness = (hold * frame_rate) ** 2 * held[:, component]
        pull = PULL_WEIGHT * pulled[:, component]
        # Rows of the upper banded form: second, first and main diagonal.
        bands = np.zeros((3, n_frames))
        bands[2] = 1.0 + pull
        bands[2, :-1] += stiffness
        bands[2, 1:] += stiffness
        bands[1, 1:] -= stiffness
        for place, (left, right) in enumerate(((0, 2), (1, 1), (2, 0))):
            bands[2, left : n_frames - right] += bending * (1.0, 4.0, 1.0)[place]
        bands[1, 1:-1] -= 2.0 * bending
        bands[1, 2:] -= 2.0 * bending
        bands[0, 2:] += bending
        force = (
            stiffness * np.where(held[:, component] > 0, speed[:, component], 0) / frame_rate
        )
        right_side = pull * goal[:, component]
        right_side[1:] += force
        right_side[:-1] -= force
        found[:, component] = solveh_banded(bands, right_side)
    return found
