"""A first estimate of a take, from which the estimate by windows starts."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ..window_priors import Windows


class RoughTake(NamedTuple):
    """A first estimate of channels of a take, padded to at least one window."""

    noisy: Array
    """Shape (n_frames, n_channels); NaN where not observed, and beyond the end of a take that
    is shorter than a window."""
    is_error: Flags
    """Samples known to be wrong, same shape."""
    values: Array
    """Without spikes, gaps bridged by straight lines: no NaN."""
    noise: Array
    """First estimate of the standard deviation, shape (n_channels,)."""
    n_observed: NDArray[np.intp]
    """Number of samples of each channel without spikes."""
    windows: Windows

    def select_channels(self, columns: NDArray[np.intp]) -> "RoughTake":
        """Return the same of some channels."""
        return RoughTake(
            self.noisy[:, columns],
            self.is_error[:, columns],
            self.values[:, columns],
            self.noise[columns],
            self.n_observed[columns],
            self.windows,
        )
