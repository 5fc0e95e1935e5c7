"""Convert postures to vectors with a mask of the observed entries."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array


def observed_signals(positions: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return frames as vectors with interpolated gaps, and the mask of observed entries.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3)

    Returns
    -------
    signals : shape (n_frames, 60)
        Interpolated linearly in time, constant at the ends; 0 if never observed.
    observed : shape (60,), bool
    """
    signals = positions.reshape(len(positions), -1).copy()
    observed = np.isfinite(signals)
    frames = np.arange(len(signals))
    for column in np.flatnonzero(~observed.all(axis=0)):
        column_observed = observed[:, column]
        signals[:, column] = (
            np.interp(frames, frames[column_observed], signals[column_observed, column])
            if column_observed.any()
            else 0.0
        )
    return signals, observed.any(axis=0)
