"""Put arrays of SMPL bodies that are written in one row in frames."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from .parameters import (
    BODY_POSE,
    BODY_SCALES,
    HANDS,
    LEFT_HAND,
    N_BODY_POSE,
    N_HAND,
    N_NUMBERS,
    POSITIONS,
    RATES,
    RIGHT_HAND,
    ROOT,
    ROTATIONS,
    SCALES,
)
from .rotations import with_rotation_vectors

CONSTANT = frozenset((*RATES, *SCALES, *BODY_SCALES))
"""Names of what a take has once."""
ROWS: dict[str, Collection[int]] = {
    **dict.fromkeys((*ROOT, *POSITIONS, "Rh", "Th"), (3,)),
    **dict.fromkeys((*LEFT_HAND, *RIGHT_HAND), (N_HAND,)),
    **dict.fromkeys(HANDS, (2 * N_HAND,)),
    **dict.fromkeys(ROTATIONS, N_NUMBERS),
    **dict.fromkeys(BODY_POSE, N_BODY_POSE),
}
"""Possible numbers of one frame by the names of arrays, the clear ones first."""


def rows_of_frames(arrays: Mapping[str, Array]) -> dict[str, Array]:
    """Return arrays (n_frames, ...); in the file a row may hold one frame or all.

    All frames are as many as the positions, or as those that change least from one to the next:
    bodies move little between frames. Rows of rotation matrices become rows of vectors.
    """
    arrays = with_rotation_vectors(arrays, ROWS)
    n_frames = _n_frames(arrays)
    return {
        name: array.reshape(n_frames if array.size % n_frames == 0 else 1, -1)
        if array.ndim == 1 and name in ROWS
        else array
        for name, array in arrays.items()
    }


def _n_frames(arrays: Mapping[str, Array]) -> int:
    """Return how many frames the rows hold: one, unless one is longer than any pose."""
    rows = {name: arrays[name] for name in ROWS if name in arrays and arrays[name].ndim == 1}
    if not any(row.size > max(ROWS[name]) for name, row in rows.items()):
        return 1
    lengths = {len(arrays[name]) for name in POSITIONS if name in arrays and name not in rows}
    for name, row in rows.items():
        known = {row.size // n for n in ROWS[name] if row.size % n == 0}
        lengths = lengths & known or known
        if len(lengths) == 1:
            return lengths.pop()
    name, row = list(rows.items())[-1]
    return min(lengths or {1}, key=lambda n: _change(row.reshape(n, -1)))


def _change(poses: Array) -> float:
    """Return the mean change from one pose to the next."""
    return float(np.abs(np.diff(poses, axis=0)).mean()) if len(poses) > 1 else np.inf


def joined_frames(
    path: Path | str, name: str, frames: Sequence[Mapping[str, Mapping[str, Array]]]
) -> dict[str, Array]:
    """Return the arrays, (n_frames, ...), of a person; NaN where a frame lacks them."""
    if len(frames) == 1:
        return dict(frames[0][name])
    own = [frame.get(name) for frame in frames]
    first = dict[str, Array]()
    for arrays in own:
        first = {**(arrays or {}), **first}
    joined = {key: first[key] for key in first if key in CONSTANT}
    for key in first.keys() - CONSTANT:
        missing = np.full_like(first[key], np.nan)
        rows = [missing if arrays is None else arrays.get(key, missing) for arrays in own]
        rows = [row if len(row) == 1 else row[None] for row in rows]
        if len({row.shape for row in rows}) > 1:
            raise InvalidFileError(
                f"{path}: the number of parameters of body {name} changes. Export it again."
            )
        joined[key] = np.concatenate(rows)
    return joined
