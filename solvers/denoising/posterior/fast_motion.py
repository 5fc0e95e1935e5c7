"""Separate fast but genuine motion, such as a foot strike, from spikes."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from ...arrays import Array

INLIER_THRESHOLD = 0.5
"""Probability of being an inlier below which a sample counts as an outlier. Chosen by hand:
x0.5 costs nothing, x2 costs 41.1 %."""
LOW_NOISE = 0.5
"""Noise, degrees or centimeters, below which single samples are reliable. Chosen by hand: x0.5
and x2 move no error; x0.01 costs 68 % on a clean squat."""
LOW_OUTLIER_RATE = 0.02
"""Fraction of outliers up to which adjacent ones rarely form a gradual deviation by chance.
Chosen by hand: x0.5 costs 5.6 %, x2 costs nothing."""
MAX_EDGE_FRACTION = 0.75
"""Maximum first and last step of a motion, relative to its height; a spike has larger ones.
Chosen by hand: x0.5 costs 5.6 %, x2 costs 16.7 %."""
MAX_STEP_FRACTION = 0.5
"""Maximum step within a motion, relative to its range from lowest to highest sample. Chosen by
hand: x0.5 costs nothing, x2 costs 1.3 %."""
MIN_MOTION_FRAMES, MIN_MOTION_FRACTION = 3, 0.15
"""Frames, and fraction of a window, beyond which noise cannot give a spike gradual slopes.
Chosen by hand: x0.5 and x2 move no error; they matter where noise is high and outliers are
many."""
MIN_OUTLIER_FRACTION, MIN_LASTING_FRAMES = 0.6, 15
"""Fraction of the observed samples around a frame that cannot all be errors. It is measured
over a window, but at least this many frames. Chosen by hand: first, x0.5 costs 13.6 %, x2 costs
nothing; second, x0.5 and x2 move no error."""


def find_fast_motion(
    error: Array, inlier: Array, noise: Array, rate: float, window: int
) -> NDArray[np.bool_]:
    """Return which outliers belong to a motion that the recording resolves.

    A spike leaves the estimate with a step and comes back with a step, even if a filter
    softened it a little. A deviation that rises and falls gradually is a motion faster than
    expected. In takes with little noise and few outliers its first and last step decide.
    Elsewhere it must last and have no steep step at all. If most observed samples around a
    frame are outliers, the estimate is wrong.

    Parameters
    ----------
    error : shape (n_frames, n_channels), degrees or centimeters
        From the estimate to the samples; NaN where not observed.
    inlier : same shape
        Probability that the sample is no outlier.
    noise : shape (n_channels,)
        Standard deviation.
    rate : float
        Fraction of outliers in the take.
    window : int, frames
    """
    nothing_found = np.zeros(error.shape, dtype=np.bool_)
    # One long column, with an empty frame before and after each channel.
    column_error = np.pad(error, ((1, 1), (0, 0)), constant_values=np.nan).T.ravel()
    outlier = np.pad(inlier < INLIER_THRESHOLD, ((1, 1), (0, 0))).T.ravel()
    outlier &= np.isfinite(column_error)
    edges = np.flatnonzero(np.diff(outlier))
    if not edges.size:
        return nothing_found
    steps = np.nan_to_num(np.abs(np.diff(column_error, append=np.nan)), nan=np.inf)
    first, last = edges[::2], edges[1::2]
    heights = np.maximum.reduceat(np.nan_to_num(np.abs(column_error)), edges + 1)[::2]
    highest = np.maximum.reduceat(np.nan_to_num(column_error), edges + 1)[::2]
    lowest = np.minimum.reduceat(np.nan_to_num(column_error), edges + 1)[::2]
    ranges = np.maximum(highest, 0.0) - np.minimum(lowest, 0.0)
    steepest = np.maximum.reduceat(steps, np.stack([first, last + 1], 1).ravel())[::2]
    min_frames = max(MIN_MOTION_FRAMES, round(MIN_MOTION_FRACTION * window))
    low_noise = np.repeat((noise < LOW_NOISE) & (rate <= LOW_OUTLIER_RATE), len(error) + 2)[
        first
    ]
    gradual = np.maximum(steps[first], steps[last]) < MAX_EDGE_FRACTION * heights
    smooth_run = (steepest < MAX_STEP_FRACTION * ranges) & (last - first >= min_frames)
    edge_marks = np.zeros(len(column_error), dtype=np.int8)
    is_motion = (low_noise & gradual) | smooth_run
    edge_marks[first + 1] = is_motion
    edge_marks[last + 1] = -is_motion.astype(np.int8)
    gradual_runs = np.cumsum(edge_marks).reshape(error.shape[1], -1)[:, 1:-1].T > 0
    return np.asarray(
        gradual_runs
        | _find_lasting_outliers(
            inlier < INLIER_THRESHOLD, error, max(window, MIN_LASTING_FRAMES)
        )
    )


def _find_lasting_outliers(
    outlier: NDArray[np.bool_], error: Array, window: int
) -> NDArray[np.bool_]:
    """Return the outliers where, over a window, most observed samples are outliers."""
    observed = np.isfinite(error)
    outlier = observed & outlier
    observed_fraction, outlier_fraction = (
        uniform_filter1d(mask.astype(float), window, axis=0, mode="constant")
        for mask in (observed, outlier)
    )
    lasts = (outlier_fraction > MIN_OUTLIER_FRACTION * observed_fraction) & (
        observed_fraction > 0.5
    )
    return np.asarray(outlier & lasts)
