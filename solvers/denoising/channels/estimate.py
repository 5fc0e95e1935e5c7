"""The result of any method on channels: values, and how reliable they are."""

from dataclasses import dataclass
from typing import NamedTuple

from ...arrays import Array


@dataclass(frozen=True, eq=False)
class Estimate:
    """Estimated channels; arrays have shape (n_frames, n_channels)."""

    values: Array
    inliers: Array
    """Probability that a sample is no outlier; 0 where not observed."""
    deviation: Array
    """Standard deviation of the estimate's error."""
    leave_one_out_error: Array
    """Error of each sample's prediction from all others; NaN where unknown."""
    iterations: int
    converged: bool


class Smoothed(NamedTuple):
    """The result of a smoother of complete channels, of shape (n_frames, n_channels)."""

    values: Array
    leave_one_out_error: Array
    """Error of each sample's prediction from all others."""
    variance: Array
    """Of the error of the values, given the noise that the smoother found."""
