"""The posture of least energy by local stochastic search [SHJT13, section VI-E]."""

import numpy as np
from numpy.typing import NDArray

from ..pose_space import EnergyTargets, PostureSpaces, posture_energy
from .sequential import choose_sequentially

Array = NDArray[np.float64]

N_STEPS = 20
N_SAMPLES = 100
INITIAL_WIDTH = 0.5
"""Standard deviation of the first samples, in those of the neighbours."""
WIDTH_DECAY = 0.85
"""Times that, after each step. The paper does not tell how its samples spread."""


def search_postures(
    spaces: PostureSpaces, demands: EnergyTargets, start: Array, seed: int = 0
) -> Array:
    """Return coordinates of good postures, shape (n_frames, n_dimensions).

    At each step, samples are drawn about the best one so far, which is kept if none is better.

    Parameters
    ----------
    spaces : PostureSpaces
    demands : Demands
    start : shape (n_frames, n_dimensions)
        Where the search begins.
    seed : int
    """
    random = np.random.default_rng(seed)
    best = start
    least = posture_energy(spaces.postures(best), demands)
    width = INITIAL_WIDTH * np.sqrt(spaces.spreads)[:, None]
    for _ in range(N_STEPS):
        drawn = random.normal(size=(len(best), N_SAMPLES, best.shape[1]))
        samples = best[:, None] + width * drawn
        flat = spaces.means[:, None] + samples @ spaces.axes.swapaxes(-1, -2)
        energies = posture_energy(flat.reshape(*flat.shape[:2], -1, 3), demands)
        place = energies.argmin(axis=1)
        found = np.take_along_axis(energies, place[:, None], axis=1)[:, 0]
        better = found < least
        taken = np.take_along_axis(samples, place[:, None, None], axis=1)[:, 0]
        best = np.where(better[:, None], taken, best)
        least = np.where(better, found, least)
        width = width * WIDTH_DECAY
    return best


def search_sequentially(
    spaces: PostureSpaces, demands: EnergyTargets, seed: int = 0, before: Array | None = None
) -> tuple[Array, Array]:
    """Search frame after frame; each goes on from the postures of the two before it.

    Returns
    -------
    postures : shape (n_frames, 20, 3), metres
    energies : shape (n_frames,)
    """

    def choose(
        space: PostureSpaces, asked: EnergyTargets, last: Array | None, frame: int
    ) -> Array:
        start = space.coordinates(last) if last is not None else 0.0 * space.spreads
        return search_postures(space, asked, start, seed + frame)

    return choose_sequentially(spaces, demands, choose, before)
