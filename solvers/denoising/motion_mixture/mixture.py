"""A mixture of Gaussians over windows of one joint: from holding still to a kick."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ...archives import ArchiveLayout
from ...arrays import Array
from ...npz_members import integers, numbers, words

LAYOUT = ArchiveLayout(
    "motion mixture",
    1,
    {
        "weights": numbers("components", minimum=0.0, maximum=1.0),
        "covariances": numbers("components", "3*coefficients", "3*coefficients"),
        "frame_rate": numbers(minimum=1.0, maximum=1000.0),
        "n_coefficients": integers(minimum=1, maximum=1000),
        "trained_on": words(),
    },
    holds="a damaged motion mixture",
    remedy="Learn it again.",
)
SHIPPED = Path(__file__).parent / "motions.npz"
N_CHANNELS = 3
"""Channels of a joint: its rotation vector. By definition."""


@dataclass(frozen=True, eq=False)
class MotionMixture:
    """A mixture of zero-mean Gaussians over the DCT coefficients of a joint's window.

    Attributes
    ----------
    weights : shape (n_components,)
        Fraction of the windows of each component.
    covariances : shape (n_components, 3 * window, 3 * window), square degrees
        Channels outermost; a window has as many frames as coefficients.
    frame_rate : float, Hz
        Of these windows.
    trained_on : str
        Description of the recordings.
    """

    weights: Array
    covariances: Array
    frame_rate: float
    trained_on: str = ""

    @property
    def window(self) -> int:
        """Frames of a window, and coefficients of a channel."""
        return self.covariances.shape[1] // N_CHANNELS

    @lru_cache(maxsize=4)  # noqa: B019 - few mixtures live, and each as long as the program
    def truncated(self, n_coefficients: int) -> "MotionMixture":
        """Return the mixture of windows of at most this many frames, as of 24 Hz."""
        if n_coefficients >= self.window:
            return self
        shape = (-1, N_CHANNELS, self.window, N_CHANNELS, self.window)
        blocks = self.covariances.reshape(shape)
        kept = blocks[:, :, :n_coefficients, :, :n_coefficients]
        size = N_CHANNELS * n_coefficients
        return replace(self, covariances=kept.reshape(-1, size, size))

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_motion_mixture` reads."""
        LAYOUT.write(
            path,
            {
                "weights": self.weights,
                "covariances": self.covariances.astype(np.float32),
                "frame_rate": np.array(self.frame_rate),
                "n_coefficients": np.array(self.window),
                "trained_on": np.array(self.trained_on),
            },
        )


@lru_cache(maxsize=2)
def load_motion_mixture(path: Path | str = SHIPPED) -> MotionMixture:
    """Read what `MotionMixture.save` wrote; without a path, the mixture that is shipped.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    return MotionMixture(
        arrays["weights"],
        arrays["covariances"].astype(float),
        float(arrays["frame_rate"]),
        str(arrays["trained_on"]),
    )
