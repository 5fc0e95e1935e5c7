"""Fit the smooth path and heading of a body over the ground, without its gait."""

from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array
from ...rotations import FULL_TURN_RAD, quaternion_from_rotation_vector
from ...signals import fill_channel_gaps, remove_outliers, smooth_gaussian

TRAVEL_SMOOTHING_S = 0.5
"""Standard deviation of the kernel that removes the gait from the path, seconds. Chosen by
hand; `make sensitivity` varies it."""
SPIKE_HALF_WIDTH_S = 0.15
"""Half width of the neighborhood in which a spike of the path is detected, seconds. Half and
twice are no better (`make sensitivity`)."""
MAX_ANGLE_RAD = np.radians(120.0)
"""Angle to a smooth reference within which rotation vectors are safe: two thirds of the half
turn at which they jump. It guards takes that turn around, whose vectors would jump."""
UNWRAP_S = 0.05
"""Standard deviation of the kernel that removes jitter of headings before they are unwrapped,
seconds. It guards noisy takes: a sample alone must not decide on a turn."""
GAP_WEIGHT = 1e-3
"""Weight of a frame that was not observed, relative to one that was. It guards gaps wider than
the kernel, where 0 has no solution; x1000 counts gaps as observed."""


@dataclass(frozen=True, eq=False)
class TravelPath:
    """A slow frame of reference that travels with the body; all channels are relative to it."""

    ground_positions: Array
    """On the ground, shape (n_frames, 2), meters. No NaN."""
    headings: Array
    """Rotation about Z, unwrapped, shape (n_frames,), radians. No NaN."""

    @property
    def rotations(self) -> Array:
        """Quaternions from the path's frame to the world, shape (n_frames, 4)."""
        vectors = np.zeros((len(self.headings), 3))
        vectors[:, 2] = self.headings
        return quaternion_from_rotation_vector(vectors)


def fit_travel_path(ground_positions: Array, headings: Array, frame_rate: float) -> TravelPath:
    """Fit a path to noisy positions (n_frames, 2) and headings (n_frames,); NaN: not observed.

    Spikes are removed, a straight line is fitted around every frame, and gaps are bridged. The
    path moves and rotates about Z with its input: all steps are relative to the mean heading.
    """
    mean = float(np.angle(np.nansum(np.exp(1j * headings)) + 1e-12))
    aligned = rotate_on_ground(ground_positions, -mean)
    relative = unwrap_angles(headings - mean, UNWRAP_S * frame_rate)
    fitted = fit_local_lines(
        _without_spikes(aligned, frame_rate), TRAVEL_SMOOTHING_S * frame_rate
    )
    smooth_headings = smooth_angles(relative, frame_rate)
    return TravelPath(rotate_on_ground(fitted, mean), smooth_headings + mean)


def smooth_angles(angles: Array, frame_rate: float) -> Array:
    """Fit lines to angles (n_frames,), radians, around every frame; NaN: not observed.

    The kernel is halved until the result lags behind by at most 120 degrees: fast turns are
    smoothed less.
    """
    clean = _without_spikes(angles[:, None], frame_rate)
    width = TRAVEL_SMOOTHING_S * frame_rate
    fitted = fit_local_lines(clean, width)
    while width > 1.0 and np.nanmax(np.abs(clean - fitted), initial=0.0) > MAX_ANGLE_RAD:
        width /= 2.0
        fitted = fit_local_lines(clean, width)
    return np.asarray(fitted[:, 0])


def _without_spikes(values: Array, frame_rate: float) -> Array:
    half_width = max(round(SPIKE_HALF_WIDTH_S * frame_rate), 2)
    return remove_outliers(values, half_width)


def rotate_on_ground(ground_positions: Array, angle: float | Array) -> Array:
    """Rotate points on the ground, shape (n_frames, 2), by an angle in radians."""
    x, y = ground_positions[:, 0], ground_positions[:, 1]
    return np.stack(
        [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], axis=-1
    )


def unwrap_angles(angles: Array, width: float) -> Array:
    """Return the angles (n_frames,) without jumps of full turns; NaN stays NaN.

    Each angle is the equivalent nearest to the direction of the mean over its neighbors, with
    Gaussian weights of this width in frames. Spikes therefore do not add up to full turns.
    """
    unit_vectors = fill_channel_gaps(np.column_stack([np.cos(angles), np.sin(angles)]))
    x, y = smooth_gaussian(unit_vectors, width).T.copy()
    smooth = np.unwrap(np.arctan2(y, x))
    return np.asarray(angles + FULL_TURN_RAD * np.round((smooth - angles) / FULL_TURN_RAD))


def fit_local_lines(values: Array, width: float) -> Array:
    """Fit a line around every frame with Gaussian weights; NaN has no weight.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
    width : float, standard deviation of the weights in frames

    Returns
    -------
    Array
        Same shape, no NaN. A straight line, wherever observed, is returned unchanged.
    """
    reach = int(np.ceil(4 * width))
    steps = np.arange(-reach, reach + 1.0)
    kernel = np.exp(-0.5 * (steps / width) ** 2)
    # Gaps have a small weight, so that a line bridges even those wider than the kernel.
    filled = fill_channel_gaps(values)
    weight = np.where(np.isfinite(values), 1.0, GAP_WEIGHT)
    s0, s1, s2 = (_weighted_sum(weight, kernel * steps**power) for power in (0, 1, 2))
    t0, t1 = (_weighted_sum(weight * filled, kernel * steps**power) for power in (0, 1))
    determinant = s0 * s2 - s1**2
    line = (s2 * t0 - s1 * t1) / np.where(determinant > 0.0, determinant, 1.0)
    return np.where(determinant > 1e-9 * s0 * s2, line, t0 / s0)


def _weighted_sum(values: Array, kernel: Array) -> Array:
    return np.asarray(scipy.ndimage.correlate1d(values, kernel, axis=0, mode="constant"))
