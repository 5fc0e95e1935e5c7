"""The natural posture space: principal components of the neighbours of each posture."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS

Array = NDArray[np.float64]

MIN_VARIANCE_M2 = 1e-8
"""Square metres. Spread below which a component is none."""


@dataclass(frozen=True, eq=False)
class PostureSpaces:
    """One space for each frame: x = means + axes z.

    Attributes
    ----------
    means : shape (n_frames, 60), metres
    axes : shape (n_frames, 60, n_dimensions)
        Orthonormal, the strongest first; zero where the neighbours span no more.
    spreads : shape (n_frames, n_dimensions), square metres
        Variance of the neighbours along each axis.
    neighbours : shape (n_frames, n_neighbours, 60), metres
    """

    means: Array
    axes: Array
    spreads: Array
    neighbours: Array

    def at(self, frames: slice) -> "PostureSpaces":
        """Return the spaces of some frames."""
        return PostureSpaces(*(getattr(self, each.name)[frames] for each in fields(self)))

    def postures(self, z: Array) -> Array:
        """Return where the joints are, shape (n_frames, 20, 3)."""
        flat = self.means + np.einsum("fij,fj->fi", self.axes, z)
        return np.asarray(flat.reshape(len(flat), N_JOINTS, 3))

    def coordinates(self, postures: Array) -> Array:
        """Return the nearest point of the space, shape (n_frames, n_dimensions)."""
        flat = postures.reshape(len(postures), -1) - self.means
        return np.asarray(np.einsum("fij,fi->fj", self.axes, flat))


def local_pca(neighbours: Array, n_dimensions: int = 20) -> PostureSpaces:
    """Span a space by the neighbours of each frame [1]_, [2]_.

    Eigenvectors of the Gram matrix of the neighbours, of which there are fewer than there are
    coordinates.

    Parameters
    ----------
    neighbours : shape (n_frames, n_neighbours, 20, 3), metres
    n_dimensions : int

    References
    ----------
    .. [1] Shum, Ho, Jiang, Takagi (2013), section V-B.
    .. [2] Lou (2012), section 3.5.
    """
    flat = np.asarray(neighbours, dtype=np.float64).reshape(*neighbours.shape[:2], -1)
    n_kept = min(n_dimensions, flat.shape[1], flat.shape[2])
    means = flat.mean(axis=1)
    off = flat - means[:, None]
    values, vectors = np.linalg.eigh(off @ off.swapaxes(-1, -2))
    values, vectors = values[:, : -n_kept - 1 : -1], vectors[:, :, : -n_kept - 1 : -1]
    real = values > MIN_VARIANCE_M2
    scale = np.where(real, 1.0 / np.sqrt(np.where(real, values, 1.0)), 0.0)
    axes = off.swapaxes(-1, -2) @ (vectors * scale[:, None])
    return PostureSpaces(means, axes, np.where(real, values, 0.0) / flat.shape[1], flat)
