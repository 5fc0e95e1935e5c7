"""The pose of least energy by local stochastic search [SHJT13, section VI-E]."""

import numpy as np

from ...arrays import Array
from ..pose_space import EnergyTargets, PostureSpaces, posture_energy
from .sequential import choose_sequentially

N_STEPS = 20
N_SAMPLES = 100
INITIAL_WIDTH = 0.5
"""Standard deviation of the first samples, relative to that of the neighbors. Chosen by hand,
as the paper does not specify it."""
WIDTH_DECAY = 0.85
"""Factor of the width after each step. Chosen by hand, as the paper gives no sample spread."""


def search_postures(
    spaces: PostureSpaces, targets: EnergyTargets, start: Array, seed: int = 0
) -> Array:
    """Return the coordinates of low-energy poses, shape (n_frames, n_dimensions).

    Each step draws samples around the best one so far, and keeps it if no sample is better.

    Parameters
    ----------
    spaces : PostureSpaces
    targets : EnergyTargets
    start : shape (n_frames, n_dimensions)
        Start of the search.
    seed : int
    """
    random = np.random.default_rng(seed)
    best = start
    min_energy = posture_energy(spaces.postures(best), targets)
    width = INITIAL_WIDTH * np.sqrt(spaces.spreads)[:, None]
    for _ in range(N_STEPS):
        noise = random.normal(size=(len(best), N_SAMPLES, best.shape[1]))
        samples = best[:, None] + width * noise
        positions = spaces.means[:, None] + samples @ spaces.axes.swapaxes(-1, -2)
        energies = posture_energy(positions.reshape(*positions.shape[:2], -1, 3), targets)
        indices = energies.argmin(axis=1)
        energies_found = np.take_along_axis(energies, indices[:, None], axis=1)[:, 0]
        better = energies_found < min_energy
        candidates = np.take_along_axis(samples, indices[:, None, None], axis=1)[:, 0]
        best = np.where(better[:, None], candidates, best)
        min_energy = np.where(better, energies_found, min_energy)
        width = width * WIDTH_DECAY
    return best


def search_sequentially(
    spaces: PostureSpaces, targets: EnergyTargets, seed: int = 0, before: Array | None = None
) -> tuple[Array, Array]:
    """Search frame by frame; each frame continues from the two poses before it.

    Returns
    -------
    postures : shape (n_frames, 20, 3), meters
    energies : shape (n_frames,)
    """

    def choose(
        space: PostureSpaces, frame_targets: EnergyTargets, last: Array | None, frame: int
    ) -> Array:
        start = space.coordinates(last) if last is not None else 0.0 * space.spreads
        return search_postures(space, frame_targets, start, seed + frame)

    return choose_sequentially(spaces, targets, choose, before)
