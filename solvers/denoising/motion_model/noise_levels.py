"""How the noise of a take changes over time."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import fill_channel_gaps, remove_outliers
from .motion_mixture import N_CHANNELS, MotionMixture
from .smooth_groups import GroupSmoother

LEVELS_DEG = 0.05 * 2.0 ** np.arange(9)
"""Standard deviations of noise that are compared, degrees: from that of the recordings of the
mixture to 12.8. By definition: a step is the factor 2."""
MIN_MOVEMENT_DEG = 0.5
"""Range over which a joint moves that counts. It guards joints that stand still."""
MAX_JOINTS = 8
"""Joints that are compared, from those that move least to those that move most. It bounds the
run time."""
N_OVERLAPS = 2
"""Number of windows that start within the length of one. It bounds the run time."""
MIN_OBSERVED = 0.75
"""Fraction of a window from which a joint counts there. It guards gaps, which have no noise."""
SPIKE_HALF_WIDTH = 4
"""Frames to either side among which a spike is found. Chosen by hand, as in the first guess of
Clean."""


def noise_levels(
    rotations: Array, frame_rate: float, mixture: MotionMixture
) -> tuple[NDArray[np.intp], Array] | None:
    """Return the likeliest noise of the body over time, the median of its joints.

    Fast movement is no noise: the mixture explains it. It takes all coefficients of a window to
    distinguish them, which takes below the frame rate of the mixture do not have.

    Parameters
    ----------
    rotations : shape (n_frames, n_joints, 3), degrees
        NaN where not observed.
    frame_rate : float, Hz
    mixture : MotionMixture
        Of joints.

    Returns
    -------
    frames : shape (n_windows,)
        Middle of each window.
    levels : shape (n_windows,), degrees
        NaN where too little was observed. None for a take shorter than a window, or below the
        frame rate of the mixture.
    """
    n_frames = len(rotations)
    flat = remove_outliers(rotations.reshape(n_frames, -1), SPIKE_HALF_WIDTH)
    complete = fill_channel_gaps(flat).reshape(rotations.shape)
    ranges = np.ptp(complete, axis=0).max(axis=1)
    moving = np.argsort(ranges, kind="stable")[np.count_nonzero(ranges <= MIN_MOVEMENT_DEG) :]
    n_chosen = min(len(moving), MAX_JOINTS)
    chosen = moving[np.linspace(0, len(moving) - 1, n_chosen).round().astype(int)]
    smoother = GroupSmoother(
        np.tile(np.eye(N_CHANNELS), (len(chosen), 1, 1)), frame_rate, mixture
    )
    if not len(chosen) or not mixture.window <= smoother.length <= n_frames:
        return None
    centered = complete[:, chosen] - complete[:, chosen].mean(axis=0)
    windows = smoother.windows(n_frames, N_OVERLAPS)
    likelihoods = smoother.log_likelihoods(centered, windows, LEVELS_DEG)
    observed = np.isfinite(rotations[:, chosen]).all(axis=2).astype(float)
    is_known = windows.extract(observed, windows.starts).mean(axis=1) >= MIN_OBSERVED
    levels = np.where(is_known, LEVELS_DEG[likelihoods.argmax(axis=2)], np.nan)
    enough = is_known.mean(axis=1) >= 0.5
    medians = np.nanmedian(np.where(enough[:, None], levels, 1.0), axis=1)
    return windows.starts + windows.length // 2, np.where(enough, medians, np.nan)
