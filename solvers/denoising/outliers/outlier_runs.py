"""Separate errors that last several frames from fast movement, with the motion mixture.

A kick and a tracking error both leave a joint's path for a few frames and come back. Given the
frames around it, the motion mixture explains the kick; an error is more likely to be a constant
offset, or unrelated to the movement.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

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
from .predictive_density import PredictiveDensity, RunDensity, with_rare_movement
from .single_outliers import OUTLIER_DENSITY

SPIKE_PRIOR_PSEUDOCOUNT = 1e4
"""Number of samples of the prior of the rate of spikes, errors of a single frame. Chosen by
hand on the development takes of the first press: with 1e5, and as rare a first spike, the error
with examples rises by 4 % where a walk has 15 % of spikes."""
PRIOR_SPIKES = 0.01
"""Number of spikes among these samples: a clean take has hardly one in ten minutes (60
channels, 30 Hz). Chosen by hand on the development takes of the first press: with 1e-5 a
fifth more lone spikes of 40 degrees are kept."""
RUN_PRIOR_PSEUDOCOUNT = 1e5
"""Number of samples of the prior of the rate of longer errors. Chosen by hand on development
takes of the first press at up to twice their speed: with 1e4, and as rare a first error, those
with bursts lose 4 %."""
PRIOR_RUNS = 1e-4
"""Number of longer errors among these samples. Fast movement looks like one, so the first one
of a take needs far more evidence. Chosen by hand on the same takes: with 0.1 a throw
and a punch of clean ones are taken for errors."""
BURST_PRIOR_PSEUDOCOUNT = 1e9
"""The number of samples, one of them the start of a burst, which only its shape makes
suspicious. Chosen by hand on the development takes of the first press: with 1e6 nine runs of
clean takes are taken for errors, with 1e9 one; of 446 true bursts 3 % are lost."""
FIXED_PSEUDOCOUNT = 1e12
"""Number of samples of the prior of a rate that is given. By definition: far more than a take
has, so that the errors in it do not change the rate."""
MIN_STEP = 10.0
"""Degrees or centimeters: an error that begins or ends with a smaller step is left to the
smoothers. Chosen by hand; `make sensitivity` varies it."""
MAX_BURST_S = 0.3
"""Seconds: longest error that is looked for between two steps. Chosen by hand;
`make sensitivity` varies it."""
MIN_NOISE = 2.0
"""Degrees or centimeters: smaller noise would let the mixture reject any movement that its
recordings lack. Chosen by hand; `make sensitivity` varies it."""


class _Run(NamedTuple):
    """Samples of a joint that may be one error."""

    frames: slice
    channels: NDArray[np.bool_]

    @property
    def is_spike(self) -> bool:
        """Whether it is a single frame."""
        return bool(self.frames.stop - self.frames.start == 1)


class _RatePrior(NamedTuple):
    """Gamma prior of the rate of one kind of errors: so many of them among so many samples.

    Much less than one error says that most takes have none and some have many: the first error
    that is found has to be far likelier than movement, the second one less so.
    """

    n_errors: float
    n_samples: float

    def log_rate(self, gains: Array, n_own: int) -> float:
        """Return the logarithm of the rate, the mean of its posterior.

        It starts at that of a take without errors, and rises with those found. `n_own` is the
        number of samples of the take.
        """
        n_found, n_before, log_rate = 0, -1, 0.0
        while n_found > n_before:
            log_rate = float(np.log((n_found + self.n_errors) / (self.n_samples + n_own)))
            n_before, n_found = n_found, np.count_nonzero(gains + log_rate > 0.0)
        return log_rate


SPIKE_RATE = _RatePrior(PRIOR_SPIKES, SPIKE_PRIOR_PSEUDOCOUNT)
RUN_RATE = _RatePrior(PRIOR_RUNS, RUN_PRIOR_PSEUDOCOUNT)
BURST_RATE = _RatePrior(1.0, BURST_PRIOR_PSEUDOCOUNT)


class _Test(NamedTuple):
    """Whether a run is an error."""

    run: _Run
    first_channel: int
    """Of its joint."""
    density: RunDensity
    n_suspected: int | None
    """Number of its samples that may be unrelated to the movement, too; None if they may only
    be off by a constant."""

    @property
    def gain(self) -> float:
        """Log-density of the samples as errors, less that as movement."""
        as_error = self.density.with_offset
        if self.n_suspected is not None:
            as_error = max(as_error, self.n_suspected * np.log(OUTLIER_DENSITY))
        return as_error - self.density.as_movement

    @property
    def max_gain(self) -> float:
        """A bound of the gain."""
        return self.density.max_gain if self.n_suspected is None else np.inf


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
    fixed = None if rate is None else _RatePrior(rate * FIXED_PSEUDOCOUNT, FIXED_PSEUDOCOUNT)
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
    rates: tuple[_RatePrior, _RatePrior],
    are_suspected: bool,
    candidates: Callable[[slice], list[_Run]],
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
    tests = list[_Test]()
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
            n_tested = np.count_nonzero(is_tested) if are_suspected else None
            of_kind = predictive if run.is_spike else predictive_of_runs
            density = of_kind.of_run(*run, is_valid | is_tested)
            tests.append(_Test(run, first, density, n_tested))
    return _likeliest(tests, observed, rates)[:n_frames]


def _likeliest(
    tests: Sequence[_Test],
    observed: NDArray[np.bool_],
    rates: tuple[_RatePrior, _RatePrior],
) -> NDArray[np.bool_]:
    """Return the samples of the likeliest runs that do not overlap.

    Parameters
    ----------
    tests : sequence of _Test
    observed : shape (n_frames, n_channels)
    rates : two _RatePrior
        Of spikes, and of errors of several frames.
    """
    is_spike = np.array([test.run.is_spike for test in tests], dtype=np.bool_)
    gains, found = np.array([test.max_gain for test in tests]), np.zeros_like(observed)
    # Most runs cannot be likely enough, whatever the exact gains of the others are.
    for index in np.flatnonzero(_log_odds(gains, is_spike, observed, rates) > 0.0):
        gains[index] = tests[index].gain
    log_odds = _log_odds(gains, is_spike, observed, rates)
    for index in np.argsort(-log_odds):
        frames, tested = tests[index].run
        channels = tests[index].first_channel + np.flatnonzero(tested)
        if log_odds[index] > 0.0 and not found[frames, channels].any():
            found[frames, channels] = observed[frames, channels]
    return found


def _log_odds(
    gains: Array,
    is_spike: NDArray[np.bool_],
    observed: NDArray[np.bool_],
    rates: tuple[_RatePrior, _RatePrior],
) -> Array:
    """Return the logarithm of the odds of each test: spikes and runs have their own rates."""
    log_odds, n_samples = gains.copy(), int(np.count_nonzero(observed))
    for rate, of_kind in zip(rates, (is_spike, ~is_spike), strict=True):
        log_odds[of_kind] += rate.log_rate(gains[of_kind], n_samples)
    return log_odds


def _suspected_runs(suspected: NDArray[np.bool_]) -> list[_Run]:
    """Return runs of suspected samples of a joint; channels with equal frames are one run."""
    channels_of_run: dict[tuple[int, int], NDArray[np.bool_]] = {}
    for channel, is_suspected in enumerate(suspected.T):
        for run in find_runs(is_suspected):
            channels = channels_of_run.setdefault(run, np.zeros(3, dtype=np.bool_))
            channels[channel] = True
    return [_Run(slice(*run), channels) for run, channels in channels_of_run.items()]


def _between_steps(samples: Array, max_frames: int) -> list[_Run]:
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
        _Run(slice(int(starts[index]), int(stops[index])), is_off[index])
        for index in np.flatnonzero(is_off.any(axis=1))
    ]
