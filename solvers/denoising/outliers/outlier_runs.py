"""Separate errors that last several frames from fast movement, with the motion mixture.

A kick and a tracking error both leave a joint's path for a few frames and come back. Given the
frames around it, the motion mixture explains the kick; an error is more likely to be a constant
offset, or unrelated to the movement.
"""

from collections.abc import Callable

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from ...signals import fill_channel_gaps, find_runs
from ..motion_model import (
    MotionMixture,
    estimate_joint_noise,
    robust_axes,
)
from ..window_priors import Windows
from .likeliest_errors import (
    BURST_RATE,
    FIXED_PSEUDOCOUNT,
    RUN_RATE,
    SPIKE_RATE,
    ErrorTest,
    RatePrior,
    Run,
    find_likeliest,
)
from .predictive_density import PredictiveDensity, with_rare_movement

MIN_STEP = 10.0
"""Degrees or centimeters: an error that begins or ends with a smaller step is left to the
smoothers. Half and twice gain less than 1 % (`make sensitivity`)."""
MAX_BURST_S = 0.3
"""Seconds: longest error that is looked for between two steps. Half and twice are no better
(`make sensitivity`)."""
MIN_NOISE = 2.0
"""Degrees or centimeters: smaller noise would let the mixture reject any movement that its
recordings lack. Half and twice are no better (`make sensitivity`)."""


def find_bursts(noisy: Array, frame_rate: float, mixture: MotionMixture) -> NDArray[np.bool_]:
    """Return samples that are errors of two or more frames, shape (n_frames, n_channels).

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        NaN where not observed; each joint has three channels.
    frame_rate : float, Hz
    mixture : MotionMixture
    """
    max_frames = round(MAX_BURST_S * frame_rate)
    complete = fill_channel_gaps(noisy)
    # Single frames that jump are no bursts, and say nothing about one.
    despiked = scipy.ndimage.median_filter(complete, (3, 1), mode="nearest")
    noisy = np.where(np.abs(noisy - despiked) > MIN_STEP, np.nan, noisy)
    found = _select(
        noisy, np.zeros(noisy.shape, dtype=np.bool_), despiked, frame_rate, mixture,
        (SPIKE_RATE, BURST_RATE), False,
        lambda joint: _between_steps(despiked[:, joint], max_frames),
    )  # fmt: skip
    # An error in its window makes the movement near it unlikely, too.
    return _select(
        noisy, found, despiked, frame_rate, mixture, (SPIKE_RATE, BURST_RATE), False,
        lambda joint: _suspected_runs(found[:, joint]),
    )  # fmt: skip


def confirm_outliers(
    noisy: Array,
    suspected: NDArray[np.bool_],
    complete: Array,
    frame_rate: float,
    mixture: MotionMixture,
    rate: float | None = None,
) -> NDArray[np.bool_]:
    """Return the suspected outliers that are not movement, shape (n_frames, n_channels).

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        NaN where not observed; each joint has three channels.
    suspected : same shape
    complete : same shape
        An estimate without them, without NaN.
    frame_rate : float, Hz
    mixture : MotionMixture
    rate : float, optional
        Errors per sample; estimated from the take if not given.
    """
    fixed = None if rate is None else RatePrior(rate * FIXED_PSEUDOCOUNT, FIXED_PSEUDOCOUNT)
    return _select(
        noisy, suspected, complete, frame_rate, mixture,
        (fixed or SPIKE_RATE, fixed or RUN_RATE), True,
        lambda joint: _suspected_runs(suspected[:, joint]),
    )  # fmt: skip


def _select(
    noisy: Array,
    suspected: NDArray[np.bool_],
    complete: Array,
    frame_rate: float,
    mixture: MotionMixture,
    rates: tuple[RatePrior, RatePrior],
    are_suspected: bool,
    candidates: Callable[[slice], list[Run]],
) -> NDArray[np.bool_]:
    """Return the samples of the candidates that are likelier to be errors than movement."""
    frame_ratio, n_frames = frame_rate / mixture.frame_rate, len(noisy)
    length = round(mixture.window * frame_ratio)
    noise = estimate_joint_noise(complete, MIN_NOISE).deviation
    if n_frames < length:  # the rest of the window is not observed
        added = ((0, length - n_frames), (0, 0))
        noisy = np.pad(noisy, added, constant_values=np.nan)
        suspected = np.pad(suspected, added)
        complete = np.pad(complete, added, mode="mean")
    mixture = mixture.truncated(length)
    windows, observed = Windows(len(noisy), length, frame_ratio), np.isfinite(noisy)
    tests = list[ErrorTest]()
    for first in range(0, noisy.shape[1], 3):
        joint = slice(first, first + 3)
        runs = candidates(joint)
        if not runs:
            continue
        is_observed = observed[:, joint]
        is_valid = is_observed & ~suspected[:, joint]
        samples = np.where(is_observed, noisy[:, joint], complete[:, joint])
        centered = samples - complete[:, joint].mean(axis=0)
        axes = robust_axes(complete[:, joint])
        predictive, predictive_of_runs = (
            PredictiveDensity(centered, noise[joint], windows, each, axes)
            for each in (mixture, with_rare_movement(mixture))
        )
        for run in runs:
            is_tested = np.zeros_like(is_observed)
            is_tested[run.frames, run.channels] = is_observed[run.frames, run.channels]
            of_kind = predictive if run.is_spike else predictive_of_runs
            density = of_kind.of_run(*run, is_valid | is_tested)
            tests.append(ErrorTest(run, first, density, are_suspected))
    return find_likeliest(tests, observed, rates)[:n_frames]


def _suspected_runs(suspected: NDArray[np.bool_]) -> list[Run]:
    """Return runs of suspected samples of a joint; channels with equal frames are one run."""
    channels_of_run: dict[tuple[int, int], NDArray[np.bool_]] = {}
    for channel, is_suspected in enumerate(suspected.T):
        for run in find_runs(is_suspected):
            channels = channels_of_run.setdefault(run, np.zeros(3, dtype=np.bool_))
            channels[channel] = True
    return [Run(slice(*run), channels) for run, channels in channels_of_run.items()]


def _between_steps(samples: Array, max_frames: int) -> list[Run]:
    """Return runs of two or more frames that begin and end with a step.

    Only channels count that are off the frames before and after by more than these differ.
    """
    edges = np.flatnonzero(np.abs(np.diff(samples, axis=0)).max(axis=1) > MIN_STEP) + 1
    # Each edge with those up to `max_frames` later: all pairs would need too much memory.
    own = np.arange(len(edges))
    counts = np.searchsorted(edges, edges + max_frames, side="right") - own
    own = np.repeat(own, counts)
    later = np.arange(len(own)) - np.repeat(np.cumsum(counts) - counts, counts)
    starts, stops = edges[own], edges[own + later]
    starts, stops = starts[stops - starts > 1], stops[stops - starts > 1]
    sums = np.cumsum(np.concatenate([np.zeros_like(samples[:1]), samples]), axis=0)
    means = (sums[stops] - sums[starts]) / (stops - starts)[:, None]
    before, after = samples[starts - 1], samples[stops]
    offset = np.abs(means - (before + after) / 2.0)
    is_off = (offset > MIN_STEP) & (np.abs(after - before) < offset)
    return [
        Run(slice(int(starts[index]), int(stops[index])), is_off[index])
        for index in np.flatnonzero(is_off.any(axis=1))
    ]
