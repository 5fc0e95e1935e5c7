"""A mixture of Gaussians over windows of a joint, or of a joint and its parent."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ...archives import ArchiveLayout
from ...arrays import Array
from ...npz_members import covariances, numbers, words

MAX_COVARIANCE = 180.0**2 * 1000.0
"""Square degrees: of coefficients of a window of a thousand frames. By definition: a rotation
vector is at most 180 degrees long."""
MIN_EIGENVALUE_RATIO = 1e-9
"""Fraction of the largest element, so that a covariance can be inverted. By definition of
double precision; learned ones have 7e-7."""
N_CHANNELS = 3
"""Channels of a joint: its rotation vector. By definition."""
LAYOUT = ArchiveLayout(
    "motion mixture",
    2,
    {
        "weights": numbers("components", minimum=np.finfo(float).tiny, maximum=1.0),
        "covariances": covariances(
            "components",
            "axes",
            "coefficients",
            "coefficients",
            minimum=-MAX_COVARIANCE,
            maximum=MAX_COVARIANCE,
            least_eigenvalue=MIN_EIGENVALUE_RATIO,
        ),
        "frame_rate": numbers(minimum=1.0, maximum=1000.0),
        "trained_on": words(),
    },
    holds="a damaged motion mixture",
    remedy="Learn it again.",
)
SHIPPED = Path(__file__).parent / "motions.npz"
"""Of joints."""
SHIPPED_PAIRS = Path(__file__).parent / "pairs.npz"
"""Of joints and their parents."""
MAX_MISSING_WEIGHT = 1e-4
"""Difference of the sum of all weights from 1. By definition: rounding in single precision."""


@dataclass(frozen=True, eq=False)
class MotionMixture:
    """A mixture of zero-mean Gaussians over the DCT coefficients of a window of joints.

    The coefficients are those of the movement of one or two joints along their common principal
    axes, which in each component are independent of each other. The mixture is therefore the
    same for any axes of a rig's joints.

    Attributes
    ----------
    weights : shape (n_components,)
        Fraction of the windows of each component.
    covariances : shape (n_components, 3 n_joints, window, window), square degrees
        Of each axis, that of the largest movement first; a window has as many frames as
        coefficients.
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
    def n_joints(self) -> int:
        """Joints of a window."""
        return self.covariances.shape[1] // N_CHANNELS

    @property
    def window(self) -> int:
        """Frames of a window, and coefficients of an axis."""
        return self.covariances.shape[-1]

    @lru_cache(maxsize=4)  # noqa: B019 - few mixtures live, and each as long as the program
    def truncated(self, n_coefficients: int) -> "MotionMixture":
        """Return the mixture of windows of at most this many frames, as of 24 Hz."""
        if n_coefficients >= self.window:
            return self
        return replace(
            self, covariances=self.covariances[..., :n_coefficients, :n_coefficients]
        )

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_motion_mixture` reads."""
        LAYOUT.write(
            path,
            {
                "weights": self.weights,
                "covariances": self.covariances.astype(np.float32),
                "frame_rate": np.array(self.frame_rate),
                "trained_on": np.array(self.trained_on),
            },
        )


@lru_cache(maxsize=4)
def load_motion_mixture(path: Path | str = SHIPPED, n_joints: int = 1) -> MotionMixture:
    """Read what `MotionMixture.save` wrote; without a path, the shipped mixture of joints.

    `n_joints` is 1 for a mixture of joints and 2 for one of pairs.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    if arrays["covariances"].shape[1] != N_CHANNELS * n_joints:
        raise LAYOUT.damaged(path, "it describes another number of joints")
    if not np.isclose(arrays["weights"].sum(), 1.0, atol=MAX_MISSING_WEIGHT):
        raise LAYOUT.damaged(path, "the weights do not add up to 1")
    return MotionMixture(
        arrays["weights"],
        arrays["covariances"].astype(float),
        float(arrays["frame_rate"]),
        str(arrays["trained_on"]),
    )
