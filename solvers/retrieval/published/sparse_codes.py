"""Compute sparse codes of many signals by orthogonal matching pursuit."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidSettingError

BATCH = 512
"""Signals per batch; the inner products with the atoms take 1.4 MB."""
REORTHOGONALIZE_BELOW = 1e-3
"""Length of the residual of an atom, as a fraction, below which it is orthogonalized twice. It
guards against rounding errors."""
MIN_RESIDUAL_FRACTION = 1e-10
"""Residual length of a signal or atom, as a fraction, below which it is rounding error."""


@dataclass(frozen=True, eq=False)
class SparseCodes:
    """Atoms and weights of each signal.

    Attributes
    ----------
    atoms : shape (n_signals, n_nonzeros), int
        In the order of selection.
    weights : shape (n_signals, n_nonzeros)
        0 if fewer atoms represent the complete signal.
    """

    atoms: NDArray[np.intp]
    weights: Array

    def __getitem__(self, which: slice | NDArray[np.intp]) -> "SparseCodes":
        return SparseCodes(self.atoms[which], self.weights[which])

    @property
    def n_signals(self) -> int:
        """Number of signals."""
        return len(self.atoms)

    def signals(self, atoms: Array) -> Array:
        """Reconstruct the signals from `atoms`, shape (n_signals, n_dimensions)."""
        return np.asarray((self.weights[:, None] @ atoms[self.atoms])[:, 0])


def sparse_codes(signals: Array, atoms: Array, n_nonzeros: int) -> SparseCodes:
    """Select the atoms of each signal greedily by the largest projection of the residual.

    Orthogonal matching pursuit [1]_. The Cholesky factor of the Gram matrix of the selected
    atoms is updated at each step, as in [2]_. Each new atom is orthogonalized against the
    others, twice if its residual is small: equally fast for few dimensions, and accurate.

    Parameters
    ----------
    signals : shape (n_signals, n_dimensions)
    atoms : shape (n_atoms, n_dimensions), each of length 1, or 0: never chosen
    n_nonzeros : int
        Atoms per signal, at most the number of dimensions.

    Raises
    ------
    InvalidSettingError
        There are fewer atoms or dimensions than that.

    References
    ----------
    .. [1] Pati, Rezaiifar, Krishnaprasad (1993). Orthogonal matching pursuit. Asilomar.
       doi:10.1109/ACSSC.1993.342465
    .. [2] Rubinstein, Zibulevsky, Elad (2008). Efficient implementation of the K-SVD algorithm
       using batch orthogonal matching pursuit. Technion CS-2008-08.
    """
    if not 1 <= n_nonzeros <= min(atoms.shape):
        raise InvalidSettingError(
            f"n_nonzeros is {n_nonzeros}; with {atoms.shape[0]} atoms of {atoms.shape[1]}"
            f" dimensions it must be between 1 and {min(atoms.shape)}."
        )
    indices = np.zeros((len(signals), n_nonzeros), dtype=np.intp)
    weights = np.zeros((len(signals), n_nonzeros))
    for start in range(0, len(signals), BATCH):
        batch = slice(start, start + BATCH)
        indices[batch], weights[batch] = _pursue(signals[batch], atoms, n_nonzeros)
    return SparseCodes(indices, weights)


def _pursue(signals: Array, atoms: Array, n_nonzeros: int) -> tuple[NDArray[np.intp], Array]:
    n_signals, n_dimensions = signals.shape
    selected = np.zeros((n_signals, n_nonzeros), dtype=np.intp)
    basis = np.zeros((n_signals, n_nonzeros, n_dimensions))
    cholesky = np.zeros((n_signals, n_nonzeros, n_nonzeros))
    projections = np.zeros((n_signals, n_nonzeros))
    residual = np.array(signals, dtype=np.float64)
    tolerance = MIN_RESIDUAL_FRACTION * _lengths(residual)
    # Single precision suffices for the selection: it is relative to the residual.
    columns = np.ascontiguousarray(atoms.T, dtype=np.float32)
    products = np.empty((n_signals, len(atoms)), dtype=np.float32)
    for step in range(n_nonzeros):
        np.matmul(residual.astype(np.float32), columns, out=products)
        best = np.abs(products, out=products).argmax(axis=1)
        component, coefficients = _orthogonalize(atoms[best], basis[:, :step])
        length = _lengths(component)
        useful = (length > MIN_RESIDUAL_FRACTION) & (_lengths(residual) > tolerance)
        component = np.where(
            useful[:, None], component / np.maximum(length, MIN_RESIDUAL_FRACTION)[:, None], 0.0
        )
        selected[:, step], basis[:, step] = best, component
        cholesky[:, :step, step] = np.where(useful[:, None], coefficients, 0.0)
        cholesky[:, step, step] = np.where(useful, length, 1.0)
        projections[:, step] = np.einsum("ij,ij->i", component, residual)
        residual -= projections[:, step, None] * component
    return selected, _back_substitute(cholesky, projections)


def _orthogonalize(vectors: Array, bases: Array) -> tuple[Array, Array]:
    """Return the component of each vector orthogonal to its basis, and the projections.

    Small components are orthogonalized twice, because of rounding errors.
    """
    projections = (bases @ vectors[:, :, None])[..., 0]
    orthogonal = vectors - (projections[:, None] @ bases)[:, 0]
    small = np.flatnonzero(_lengths(orthogonal) < REORTHOGONALIZE_BELOW)
    correction = (bases[small] @ orthogonal[small, :, None])[..., 0]
    orthogonal[small] -= (correction[:, None] @ bases[small])[:, 0]
    projections[small] += correction
    return orthogonal, projections


def _back_substitute(upper: Array, right: Array) -> Array:
    """Solve many upper triangular systems by back substitution."""
    solution = right.copy()
    for row in range(right.shape[1] - 1, -1, -1):
        later = np.einsum("ij,ij->i", upper[:, row, row + 1 :], solution[:, row + 1 :])
        solution[:, row] = (right[:, row] - later) / upper[:, row, row]
    return solution


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))
