"""Describe posture transitions by outer products of sparse codes [ZH14, 3.3.2]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from .sparse_codes import SparseCodes


@dataclass(frozen=True, eq=False)
class TemporalCodes:
    """Pairs of postures; each pair stands for the outer product of its two codes (eq. 3.7).

    The product of two codes of m non-zeros has m^2, so it is never stored completely.

    Attributes
    ----------
    earlier, later : SparseCodes
        One row for each slice.
    """

    earlier: SparseCodes
    later: SparseCodes

    @property
    def n_slices(self) -> int:
        """Number of pairs."""
        return self.earlier.n_signals

    def entries(self) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
        """Return the products: rows, columns and values, each (n_slices, m, m)."""
        rows, columns = np.broadcast_arrays(
            self.earlier.atoms[:, :, None], self.later.atoms[:, None]
        )
        return rows, columns, self.earlier.weights[:, :, None] * self.later.weights[:, None]


def temporal_codes(codes: SparseCodes, gap: int) -> TemporalCodes:
    """Pair each `gap`-th frame with the one `gap` frames later (eq. 3.8 and 3.9).

    A partner beyond the last frame is replaced by the last frame.

    Parameters
    ----------
    codes : SparseCodes
        One row for each frame.
    gap : int, frames, at least 1
    """
    last = codes.n_signals - 1
    earlier = np.arange(0, max(last, 1), gap)
    return TemporalCodes(codes[earlier], codes[np.minimum(earlier + gap, last)])
