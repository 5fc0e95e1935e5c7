"""How good a posture is: the energy of [SHJT13], eq. 10 to 15."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import ABOVE, N_JOINTS

Array = NDArray[np.float64]
N_BONES = N_JOINTS - 1


class EnergyWeights(NamedTuple):
    """How much each term counts; the values of [SHJT13]."""

    control: float = 1.0
    style: float = 0.5
    kinematics: float = 1.5
    continuity: float = 0.25


@dataclass(frozen=True, eq=False)
class EnergyTargets:
    """What is asked of the posture of each frame.

    Attributes
    ----------
    observed : shape (n_frames, 20, 3), metres
        NaN: not tracked.
    trust : shape (n_frames, 20)
    neighbours : shape (n_frames, n_neighbours, 60), metres
    lengths : shape (20,), metres
    expected : shape (n_frames, 20, 3), metres, or None
        Where the joints come to if they go on as they did; NaN: not known.
    weights : EnergyWeights
    """

    observed: Array
    trust: Array
    neighbours: Array
    lengths: Array
    expected: Array | None = None
    weights: EnergyWeights = EnergyWeights()

    def at(self, frames: slice) -> "EnergyTargets":
        """Return what is asked of some frames."""
        return replace(
            self,
            observed=self.observed[frames],
            trust=self.trust[frames],
            neighbours=self.neighbours[frames],
            expected=None if self.expected is None else self.expected[frames],
        )


def posture_energy(postures: Array, demands: EnergyTargets) -> Array:
    """Return the energy of postures, square metres; less is better.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3) or (n_frames, n_samples, 20, 3), metres
    demands : Demands

    Returns
    -------
    shape (n_frames,) or (n_frames, n_samples)
    """
    single = postures.ndim == 3
    x = postures[:, None] if single else postures
    w = demands.weights
    total = w.control * control_term(x, demands) + w.kinematics * kinematics_term(x, demands)
    total += w.style * style_distances(x, demands).min(axis=-1)
    if demands.expected is not None:
        total += w.continuity * continuity_term(x, demands)
    return np.asarray(total[:, 0] if single else total)


def control_term(x: Array, demands: EnergyTargets) -> Array:
    """Squared ways from where the joints were seen, as trusted (eq. 10)."""
    off = x - demands.observed[:, None]
    ways = np.nan_to_num(np.einsum("fsik,fsik->fsi", off, off))
    return np.asarray(np.einsum("fsi,fi->fs", ways, demands.trust))


def style_distances(x: Array, demands: EnergyTargets) -> Array:
    """Mean squared way to each neighbour; eq. 11 is the least of them."""
    flat = x.reshape(*x.shape[:2], -1)
    known = demands.neighbours
    squares = np.einsum("fsi,fsi->fs", flat, flat)[..., None]
    cross = flat @ known.swapaxes(-1, -2)
    away = squares - 2.0 * cross + np.einsum("fni,fni->fn", known, known)[:, None]
    return np.asarray(np.maximum(away, 0.0) / N_JOINTS)


def kinematics_term(x: Array, demands: EnergyTargets) -> Array:
    """Mean squared difference of the lengths of segments (eq. 12)."""
    sizes = np.linalg.norm(x - x[..., ABOVE, :], axis=-1)
    off = (sizes - demands.lengths)[..., 1:]
    return np.asarray(np.einsum("fsi,fsi->fs", off, off) / N_BONES)


def continuity_term(x: Array, demands: EnergyTargets) -> Array:
    """Mean squared change of displacement (eq. 14)."""
    if demands.expected is None:
        return np.zeros(x.shape[:2])
    off = x - demands.expected[:, None]
    return np.asarray(np.nan_to_num(np.einsum("fsik,fsik->fsi", off, off)).mean(axis=-1))
