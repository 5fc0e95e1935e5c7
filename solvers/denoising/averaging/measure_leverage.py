"""Measure how much a smoother follows the noise of its own take."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..channels import Smoothed
from ..motion_model import MAX_CONSTANT_RANGE

PROBE_FRACTION = 0.1
"""Size of the added noise, in standard deviations of the take's own. Small, so that the
smoother answers in proportion, and far above rounding."""
MAX_PROBED_FRAMES = 1024
"""Frames of a long take, in its middle, in which the change is measured. It bounds the run
time."""
MIN_PROBED_SAMPLES = 2048
"""Samples to which noise is added, over all probes: few are probed several times. Chosen by
hand: over 100 noisy takes of three channels and 60 frames, the factor lay between 1.0 and 3.4
with one probe, and between 1.0 and 1.8 with as many as this takes."""


def leverage(residual: Array, leave_one_out_error: Array) -> Array:
    """Return the weight of each sample in its own estimate, from both of its errors."""
    known = np.isfinite(leave_one_out_error) & (leave_one_out_error != 0.0)
    ratio = np.divide(residual, leave_one_out_error, out=np.zeros_like(residual), where=known)
    return np.asarray(np.clip(1.0 - ratio, 0.0, 1.0))


def leverage_factor(
    smooth: Callable[[Array], Smoothed | None],
    smoothed: Smoothed | None,
    samples: Array,
    is_good: NDArray[np.bool_],
    noise: Array,
) -> float:
    """Return how much more a smoother follows noise than the leverage of its samples says.

    A smoother that chooses its smoothness from the take chooses it by the noise, too. Noise is
    added, and its share in the change of the smoothed take is measured [1]_.

    Parameters
    ----------
    smooth : function of an array of shape (n_frames, n_channels)
    smoothed : Smoothed, optional
        Its result for these samples.
    samples : shape (n_frames, n_channels), without NaN
    is_good : shape (n_frames, n_channels)
        Samples that count.
    noise : shape (n_channels,)
        Standard deviation.

    Returns
    -------
    float, at least 1

    References
    ----------
    .. [1] Ramani, Blu, Unser (2008). Monte-Carlo SURE: a black-box optimization of
       regularization parameters for general denoising algorithms. IEEE Transactions on Image
       Processing 17. doi:10.1109/TIP.2008.2001404
    """
    if len(samples) > MAX_PROBED_FRAMES:
        first = (len(samples) - MAX_PROBED_FRAMES) // 2
        probed = slice(first, first + MAX_PROBED_FRAMES)
        samples, is_good = samples[probed], is_good[probed]
        smoothed = smooth(samples)
    counts = is_good & (np.ptp(samples, axis=0) > MAX_CONSTANT_RANGE)
    if smoothed is None or not counts.any():
        return 1.0
    expected = leverage(samples - smoothed.values, smoothed.leave_one_out_error)[counts].sum()
    if not expected > 0.0:
        return 1.0
    # By spread: neither the order of the joints nor one that stands still changes the result.
    moving = np.flatnonzero(counts.any(axis=0))
    moving = moving[np.argsort(-samples.std(axis=0)[moving])]
    rng, added, followed = np.random.default_rng(0), PROBE_FRACTION * noise, []
    for _ in range(math.ceil(MIN_PROBED_SAMPLES / np.count_nonzero(counts))):
        signs = np.zeros(samples.shape)
        signs[:, moving] = rng.choice([-1.0, 1.0], (len(moving), len(samples))).T
        signs[~counts] = 0.0
        again = smooth(samples + added * signs)
        if again is None:
            return 1.0
        followed.append((signs * (again.values - smoothed.values) / added).sum())
    return max(float(np.mean(followed) / expected), 1.0)
