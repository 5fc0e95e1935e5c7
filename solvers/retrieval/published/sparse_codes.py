"""Write signals as sums of few atoms: orthogonal matching pursuit of many signals at once."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidSettingError

Array = NDArray[np.float64]

BATCH = 512
"""Signals pursued at once: fewer calls, and their inner products with atoms take 1.4 MB."""
REORTHOGONALIZE_BELOW = 1e-3
"""Length that is left of an atom below which it is made orthogonal twice."""
MIN_RESIDUAL_FRACTION = 1e-10
"""Part of a signal's length, or of an atom's, below which what is left of it is rounding."""


@dataclass(frozen=True, eq=False)
class SparseCodes:
    """Which atoms make up each signal, and how much of each.

    Attributes
    ----------
    atoms : shape (n_signals, n_nonzeros), int
        In the order in which they were chosen.
    weights : shape (n_signals, n_nonzeros)
        0 where fewer atoms tell the whole signal.
    """

    atoms: NDArray[np.intp]
    weights: Array

    def __getitem__(self, which: slice | NDArray[np.intp]) -> "SparseCodes":
        return SparseCodes(self.atoms[which], self.weights[which])

    @property
    def n_signals(self) -> int:
        """How many signals there are."""
        return len(self.atoms)

    def signals(self, atoms: Array) -> Array:
        """Return what these sums of `atoms` are, shape (n_signals, n_dimensions)."""
        return np.asarray((self.weights[:, None] @ atoms[self.atoms])[:, 0])


def sparse_codes(signals: Array, atoms: Array, n_nonzeros: int) -> SparseCodes:
    """Choose for each signal, one by one, the atoms that tell most of what is left of it.

    Orthogonal matching pursuit [1]_. The least squares over the atoms chosen so far are kept
    up to date by the Cholesky factor of their Gram matrix, as in [2]_; it is made by
    orthogonalising each new atom against the others, twice where little of it is left, which
    is as quick for signals of few dimensions and keeps all digits.

    Parameters
    ----------
    signals : shape (n_signals, n_dimensions)
    atoms : shape (n_atoms, n_dimensions), each of length 1, or 0: never chosen
    n_nonzeros : int
        Atoms for each signal, at most as many as there are dimensions.

    Raises
    ------
    InvalidSettingError
        There are not so many atoms, or dimensions.

    References
    ----------
    .. [1] Pati, Rezaiifar, Krishnaprasad (1993). Orthogonal matching pursuit. Asilomar.
       doi:10.1109/ACSSC.1993.342465
    .. [2] Rubinstein, Zibulevsky, Elad (2008). Efficient implementation of the K-SVD algorithm
       using batch orthogonal matching pursuit. Technion CS-2008-08.
    """
    if not 1 <= n_nonzeros <= min(atoms.shape):
        raise InvalidSettingError(
            f"{n_nonzeros} non-zeros were asked for; there are {atoms.shape[0]} atoms of"
            f" {atoms.shape[1]} dimensions, so it must lie between 1 and {min(atoms.shape)}."
        )
    places = np.zeros((len(signals), n_nonzeros), dtype=np.intp)
    weights = np.zeros((len(signals), n_nonzeros))
    for start in range(0, len(signals), BATCH):
        batch = slice(start, start + BATCH)
        places[batch], weights[batch] = _pursue(signals[batch], atoms, n_nonzeros)
    return SparseCodes(places, weights)


def _pursue(signals: Array, atoms: Array, n_nonzeros: int) -> tuple[NDArray[np.intp], Array]:
    n_signals, n_dimensions = signals.shape
    chosen = np.zeros((n_signals, n_nonzeros), dtype=np.intp)
    basis = np.zeros((n_signals, n_nonzeros, n_dimensions))
    cholesky = np.zeros((n_signals, n_nonzeros, n_nonzeros))
    along = np.zeros((n_signals, n_nonzeros))
    left = np.array(signals, dtype=np.float64)
    enough = MIN_RESIDUAL_FRACTION * _lengths(left)
    # To choose, single precision will do: it is relative to what is left.
    columns = np.ascontiguousarray(atoms.T, dtype=np.float32)
    common = np.empty((n_signals, len(atoms)), dtype=np.float32)
    for step in range(n_nonzeros):
        np.matmul(left.astype(np.float32), columns, out=common)
        best = np.abs(common, out=common).argmax(axis=1)
        new, before = _orthogonalize(atoms[best], basis[:, :step])
        size = _lengths(new)
        useful = (size > MIN_RESIDUAL_FRACTION) & (_lengths(left) > enough)
        new = np.where(
            useful[:, None], new / np.maximum(size, MIN_RESIDUAL_FRACTION)[:, None], 0.0
        )
        chosen[:, step], basis[:, step] = best, new
        cholesky[:, :step, step] = np.where(useful[:, None], before, 0.0)
        cholesky[:, step, step] = np.where(useful, size, 1.0)
        along[:, step] = np.einsum("ij,ij->i", new, left)
        left -= along[:, step, None] * new
    return chosen, _back_substitute(cholesky, along)


def _orthogonalize(vectors: Array, bases: Array) -> tuple[Array, Array]:
    """Return what of each vector is across its basis, and how much along each of that.

    Where little is left, rounding is much of it: there it is done twice.
    """
    along = (bases @ vectors[:, :, None])[..., 0]
    across = vectors - (along[:, None] @ bases)[:, 0]
    few = np.flatnonzero(_lengths(across) < REORTHOGONALIZE_BELOW)
    more = (bases[few] @ across[few, :, None])[..., 0]
    across[few] -= (more[:, None] @ bases[few])[:, 0]
    along[few] += more
    return across, along


def _back_substitute(upper: Array, right: Array) -> Array:
    """Solve many upper triangular systems from their last rows on."""
    found = right.copy()
    for row in range(right.shape[1] - 1, -1, -1):
        later = np.einsum("ij,ij->i", upper[:, row, row + 1 :], found[:, row + 1 :])
        found[:, row] = (right[:, row] - later) / upper[:, row, row]
    return found


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))
