"""The energy of a pose, [SHJT13], eq. 10 to 15."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion.humanoid import N_JOINTS, PARENT_INDICES

N_BONES = N_JOINTS - 1


class EnergyWeights(NamedTuple):
    """Weights of the energy terms; defaults from [SHJT13]."""

    control: float = 1.0
    style: float = 0.5
    kinematics: float = 1.5
    continuity: float = 0.25


@dataclass(frozen=True, eq=False)
class EnergyTargets:
    """Targets of the energy terms for each frame.

    Attributes
    ----------
    observed : shape (n_frames, 20, 3), meters
        NaN: not tracked.
    reliability : shape (n_frames, 20)
    neighbors : shape (n_frames, n_neighbors, 60), meters
    lengths : shape (20,), meters
    expected : shape (n_frames, 20, 3), meters, or None
        Positions by linear extrapolation; NaN where unknown.
    weights : EnergyWeights
    """

    observed: Array
    reliability: Array
    neighbors: Array
    lengths: Array
    expected: Array | None = None
    weights: EnergyWeights = EnergyWeights()

    def at(self, frames: slice) -> "EnergyTargets":
        """Return the targets of some frames."""
        return replace(
            self,
            observed=self.observed[frames],
            reliability=self.reliability[frames],
            neighbors=self.neighbors[frames],
            expected=None if self.expected is None else self.expected[frames],
        )


def posture_energy(postures: Array, targets: EnergyTargets) -> Array:
    """Return the energy of poses, square meters; lower is better.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3) or (n_frames, n_samples, 20, 3), meters
    targets : EnergyTargets

    Returns
    -------
    shape (n_frames,) or (n_frames, n_samples)
    """
    single = postures.ndim == 3
    x = postures[:, None] if single else postures
    w = targets.weights
    total = w.control * control_term(x, targets) + w.kinematics * kinematics_term(x, targets)
    total += w.style * style_distances(x, targets).min(axis=-1)
    if targets.expected is not None:
        total += w.continuity * continuity_term(x, targets)
    return np.asarray(total[:, 0] if single else total)


def control_term(x: Array, targets: EnergyTargets) -> Array:
    """Squared distances from observed joints, weighted by reliability (eq. 10).

    As of all terms the shape is (n_frames, n_samples), of x (n_frames, n_samples, 20, 3).
    """
    differences = x - targets.observed[:, None]
    squares = np.nan_to_num(np.einsum("fsik,fsik->fsi", differences, differences))
    return np.asarray(np.einsum("fsi,fi->fs", squares, targets.reliability))


def style_distances(x: Array, targets: EnergyTargets) -> Array:
    """Mean squared distance, m², of postures (F, S, 20, 3) to neighbors: (F, S, N), eq. 11."""
    flat = x.reshape(*x.shape[:2], -1)
    neighbors = targets.neighbors
    squares = np.einsum("fsi,fsi->fs", flat, flat)[..., None]
    cross = flat @ neighbors.swapaxes(-1, -2)
    distances = squares - 2.0 * cross + np.einsum("fni,fni->fn", neighbors, neighbors)[:, None]
    return np.asarray(np.maximum(distances, 0.0) / N_JOINTS)


def kinematics_term(x: Array, targets: EnergyTargets) -> Array:
    """Mean squared difference, m², of the lengths of segments of postures: (F, S), eq. 12."""
    lengths = np.linalg.norm(x - x[..., PARENT_INDICES, :], axis=-1)
    differences = (lengths - targets.lengths)[..., 1:]
    return np.asarray(np.einsum("fsi,fsi->fs", differences, differences) / N_BONES)


def continuity_term(x: Array, targets: EnergyTargets) -> Array:
    """Mean squared change, m², of the displacement of postures: (F, S), eq. 14."""
    if targets.expected is None:
        return np.zeros(x.shape[:2])
    differences = x - targets.expected[:, None]
    return np.asarray(
        np.nan_to_num(np.einsum("fsik,fsik->fsi", differences, differences)).mean(axis=-1)
    )
