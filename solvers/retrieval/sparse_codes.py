"""Write signals as sums of few atoms: orthogonal matching pursuit of many signals at once."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidSettingError

Array = NDArray[np.float64]

BATCH = 256
"""Signals pursued at once: their inner products with the atoms then stay in the cache."""
SPENT = 1e-10
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
    orthogonalising each new atom against the others, twice, which is as quick for signals of
    few dimensions and keeps all digits.

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
    enough = SPENT * np.linalg.norm(signals, axis=1)
    for step in range(n_nonzeros):
        best = np.abs(left @ atoms.T).argmax(axis=1)
        new, before = atoms[best], np.zeros((n_signals, step))
        for _ in range(2):
            shared = (basis[:, :step] @ new[:, :, None])[..., 0]
            new = new - (shared[:, None] @ basis[:, :step])[:, 0]
            before += shared
        size = np.linalg.norm(new, axis=1)
        useful = (size > SPENT) & (np.linalg.norm(left, axis=1) > enough)
        new = np.where(useful[:, None], new / np.maximum(size, SPENT)[:, None], 0.0)
        chosen[:, step], basis[:, step] = best, new
        cholesky[:, :step, step] = np.where(useful[:, None], before, 0.0)
        cholesky[:, step, step] = np.where(useful, size, 1.0)
        along[:, step] = (new * left).sum(axis=1)
        left -= along[:, step, None] * new
    return chosen, np.linalg.solve(cholesky, along[..., None])[..., 0]
