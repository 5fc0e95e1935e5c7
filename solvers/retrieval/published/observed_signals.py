"""Postures as plain vectors, and which of their entries were seen."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def observed_signals(positions: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return frames as vectors, gaps bridged in time, and which entries were ever seen.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3)

    Returns
    -------
    signals : shape (n_frames, 60)
        Bridged by straight lines, at the ends by the nearest; 0 where never seen.
    seen : shape (60,), bool
    """
    signals = positions.reshape(len(positions), -1).copy()
    known = np.isfinite(signals)
    frames = np.arange(len(signals))
    for column in np.flatnonzero(~known.all(axis=0)):
        told = known[:, column]
        signals[:, column] = (
            np.interp(frames, frames[told], signals[told, column]) if told.any() else 0.0
        )
    return signals, known.any(axis=0)
