"""The natural posture space: principal components of the neighbors of each pose."""

from dataclasses import dataclass, fields

import numpy as np

from ...arrays import Array
from ...motion.humanoid import N_JOINTS

MIN_VARIANCE_M2 = 1e-8
"""Minimum variance (m²) of a component; weaker components are zero. It guards a division."""


@dataclass(frozen=True, eq=False)
class PostureSpaces:
    """One linear space per frame: x = means + axes z.

    Attributes
    ----------
    means : shape (n_frames, 60), meters
    axes : shape (n_frames, 60, n_dimensions)
        Orthonormal, the strongest first; zero beyond the rank of the neighbors.
    spreads : shape (n_frames, n_dimensions), square meters
        Variance of the neighbors along each axis.
    neighbors : shape (n_frames, n_neighbors, 60), meters
    """

    means: Array
    axes: Array
    spreads: Array
    neighbors: Array

    def at(self, frames: slice) -> "PostureSpaces":
        """Return the spaces of some frames."""
        return PostureSpaces(*(getattr(self, each.name)[frames] for each in fields(self)))

    def postures(self, z: Array) -> Array:
        """Return joint positions at coordinates z, shape (n_frames, 20, 3)."""
        flat = self.means + np.einsum("fij,fj->fi", self.axes, z)
        return np.asarray(flat.reshape(len(flat), N_JOINTS, 3))

    def coordinates(self, postures: Array) -> Array:
        """Return coordinates of the nearest point of the space, (n_frames, n_dimensions)."""
        flat = postures.reshape(len(postures), -1) - self.means
        return np.asarray(np.einsum("fij,fi->fj", self.axes, flat))


def local_pca(neighbors: Array, n_dimensions: int = 20) -> PostureSpaces:
    """Span a space by the neighbors of each frame [1]_, [2]_.

    The eigenvectors of the Gram matrix are used, since there are fewer neighbors than
    coordinates.

    Parameters
    ----------
    neighbors : shape (n_frames, n_neighbors, 20, 3), meters
    n_dimensions : int

    References
    ----------
    .. [1] Shum, Ho, Jiang, Takagi (2013), section V-B.
    .. [2] Lou (2012), section 3.5.
    """
    flat = np.asarray(neighbors, dtype=np.float64).reshape(*neighbors.shape[:2], -1)
    n_kept = min(n_dimensions, flat.shape[1], flat.shape[2])
    means = flat.mean(axis=1)
    deviations = flat - means[:, None]
    values, vectors = np.linalg.eigh(deviations @ deviations.swapaxes(-1, -2))
    values, vectors = values[:, : -n_kept - 1 : -1], vectors[:, :, : -n_kept - 1 : -1]
    is_nonzero = values > MIN_VARIANCE_M2
    scale = np.where(is_nonzero, 1.0 / np.sqrt(np.where(is_nonzero, values, 1.0)), 0.0)
    axes = deviations.swapaxes(-1, -2) @ (vectors * scale[:, None])
    return PostureSpaces(means, axes, np.where(is_nonzero, values, 0.0) / flat.shape[1], flat)
