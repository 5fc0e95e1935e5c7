"""Compare posture sequences by spatial temporal pyramid matching [ZH14, 3.4]."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ...settings import Settings, setting
from ..postures import ClipPostures
from .dictionary import PostureDictionary
from .temporal_codes import TemporalCodes, temporal_codes


@dataclass(frozen=True, kw_only=True)
class PyramidSettings(Settings):
    """Settings of `pyramid_descriptor`."""

    gap: float = setting(
        7 / 120,
        "Time between the two postures of a pair; longer captures slower changes",
        unit="s",
        minimum=0.001,
        maximum=10.0,
    )
    n_levels: int = setting(
        3, "Pyramid levels; each halves the time segments", minimum=1, maximum=8
    )
    normalize_cubes: bool = setting(
        False,
        "Normalize each cube to sum to 1, so that all segments and blocks of atoms weigh the"
        " same",
    )


def pyramid_descriptor(
    postures: ClipPostures,
    dictionary: PostureDictionary,
    settings: PyramidSettings = PyramidSettings(),
) -> Any:
    """Return the pooled temporal codes of a clip, a sparse row of scipy's.

    Level l cuts the slices of the temporal code into 2^l segments, and atoms into l + 1 groups,
    so that rows and columns make (l + 1)^2 blocks. Max pooling keeps the largest absolute value
    in a segment (eq. 3.10). Levels are weighted by 1 / 2^l, so that `pyramid_kernel` only adds.

    Returns
    -------
    csr_array, shape (1, (2^n_levels - 1) n_atoms^2), never negative
    """
    gap = max(1, round(settings.gap * postures.frame_rate))
    codes = temporal_codes(dictionary.codes(postures), gap)
    n_atoms = len(dictionary.atoms)
    indices, values, first = [], [], 0
    for level in range(settings.n_levels):
        level_indices, sizes = _pool_codes(codes, 2**level, n_atoms)
        if settings.normalize_cubes:
            sizes = sizes / _cube_sums(level_indices, sizes, level, n_atoms)
        indices.append(first + level_indices)
        values.append(sizes / 2**level)
        first += 2**level * n_atoms**2
    columns = np.concatenate(indices)
    return scipy.sparse.csr_array(
        (np.concatenate(values), columns, np.array([0, len(columns)])), shape=(1, first)
    )


def pyramid_kernel(a: Any, b: Any) -> Array:
    """Return the similarity of pyramids: the histogram intersection (eq. 3.11).

    Parameters
    ----------
    a : csr_array, shape (n, n_entries)
    b : csc_array, shape (m, n_entries)
        Other sparse arrays are converted, which takes longer than the rest.

    Returns
    -------
    shape (n, m)
    """
    a, b = a.tocsr(), b.tocsc()
    kernel = np.zeros((a.shape[0], b.shape[0]))
    for row in range(a.shape[0]):
        own_entries = slice(a.indptr[row], a.indptr[row + 1])
        columns = a.indices[own_entries]
        counts = b.indptr[columns + 1] - b.indptr[columns]
        skipped = np.cumsum(counts) - counts
        gathered = np.arange(counts.sum()) + np.repeat(b.indptr[columns] - skipped, counts)
        shared = np.minimum(b.data[gathered], np.repeat(a.data[own_entries], counts))
        kernel[row] = np.bincount(b.indices[gathered], shared, minlength=b.shape[0])
    return kernel


def _pool_codes(
    codes: TemporalCodes, n_segments: int, n_atoms: int
) -> tuple[NDArray[np.intp], Array]:
    """Return the flat indices (segment, row, column) of entries, and their maxima."""
    rows, columns, values = codes.entries()
    segments = np.arange(codes.n_slices) * n_segments // codes.n_slices
    indices = ((segments[:, None, None] * n_atoms + rows) * n_atoms + columns).ravel()
    sizes = np.abs(values).ravel()
    used = np.flatnonzero(sizes)
    order = used[np.argsort(indices[used])]
    indices, sizes = indices[order], sizes[order]
    starts = np.flatnonzero(np.diff(indices, prepend=-1))
    return indices[starts], np.maximum.reduceat(sizes, starts)


def _cube_sums(indices: NDArray[np.intp], sizes: Array, level: int, n_atoms: int) -> Array:
    """Return for each entry the sum of its cube."""
    segments, remainders = np.divmod(indices, n_atoms**2)
    rows, columns = (each * (level + 1) // n_atoms for each in np.divmod(remainders, n_atoms))
    cubes = (segments * (level + 1) + rows) * (level + 1) + columns
    return np.asarray(np.bincount(cubes, sizes)[cubes])
