"""Which runs of samples are errors: the likeliest of movement, one error, and single errors."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..motion_model import N_CHANNELS
from .predictive_density import RunDensity
from .single_outliers import LOG_OUTLIER_DENSITY

SPIKE_PRIOR_PSEUDOCOUNT = 1e3
"""Number of samples of the prior of the rate of spikes, errors of a single frame. Sweep on the
development takes of the first press: with 1e4, the error rises by 2 % where a tenth of the
samples is wrong."""
PRIOR_SPIKES = 0.01
"""Number of spikes among these samples: most takes have none. Sweep on the development takes of
the first press: with 1e-5 a fifth more lone spikes of 40 degrees are kept."""
RUN_PRIOR_PSEUDOCOUNT = 1e5
"""Number of samples of the prior of the rate of longer errors. Sweep on development takes of
the first press at up to twice their speed: with 1e4, and as rare a first error, those with
bursts lose 4 %."""
PRIOR_RUNS = 1e-4
"""Number of longer errors among these samples. Fast movement looks like one, so the first one
of a take needs far more evidence. Sweep on the same takes: with 0.1 a throw and a punch of
clean ones are taken for errors."""
BURST_PRIOR_PSEUDOCOUNT = 1e9
"""The number of samples, one of them the start of a burst, which only its shape makes
suspicious. Sweep on the development takes of the first press: with 1e6 nine runs of clean takes
are taken for errors, with 1e9 one; of 446 true bursts 3 % are lost."""
FIXED_PSEUDOCOUNT = 1e12
"""Number of samples of the prior of a rate that is given. By definition: far more than a take
has, so that the errors in it do not change the rate."""
SPIKE_RATES = np.linspace(0.0, 1.0 / 3.0, 1000)
"""Fractions of wrong frames. By definition: up to a third, the more frames are wrong, the more
are wrong between right ones."""


class Run(NamedTuple):
    """Samples of a joint that may be one error."""

    frames: slice
    channels: NDArray[np.bool_]

    @property
    def is_spike(self) -> bool:
        """Whether it is a single frame."""
        return bool(self.frames.stop - self.frames.start == 1)


class RatePrior(NamedTuple):
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


SPIKE_RATE = RatePrior(PRIOR_SPIKES, SPIKE_PRIOR_PSEUDOCOUNT)
RUN_RATE = RatePrior(PRIOR_RUNS, RUN_PRIOR_PSEUDOCOUNT)
BURST_RATE = RatePrior(1.0, BURST_PRIOR_PSEUDOCOUNT)


class SingleErrors(NamedTuple):
    """Frames of a run that are errors of their own among right ones."""

    samples: NDArray[np.bool_]
    """Shape (length of the window, 3)."""
    log_odds: float
    """Against movement in all frames."""


class ErrorTest(NamedTuple):
    """Whether a run is an error, or has errors in some of its frames."""

    run: Run
    first_channel: int
    """Of its joint."""
    density: RunDensity
    is_suspected: bool
    """Whether its samples may be unrelated to the movement, too, and not only be off by a
    constant."""

    @property
    def gain(self) -> float:
        """Log-density of the samples as one error, less that as movement."""
        as_error = self.density.with_offset
        if self.is_suspected:
            n_tested = np.count_nonzero(self.density.tested)
            as_error = max(as_error, n_tested * LOG_OUTLIER_DENSITY)
        return as_error - self.density.as_movement

    @property
    def max_gain(self) -> float:
        """A bound of the gain."""
        return np.inf if self.is_suspected else self.density.max_gain

    def find_single_errors(self, log_rate: float) -> SingleErrors:
        """Return the likeliest errors of single frames in a run, with their rate.

        A run of suspected samples may be two spikes and the right frames between them. Of a run
        longer than a window, the frames of one window count.
        """
        density, errors = self.density, self.density.tested.copy()
        frames, right = np.flatnonzero(errors.any(axis=1)), np.zeros_like(errors)
        if self.run.is_spike or not self.is_suspected:
            return SingleErrors(right, 0.0)
        total = as_movement = 0.0
        for frame in frames:
            right[frame] = density.tested[frame]
            with_frame = density.movement_of(right)
            as_error = log_rate + np.count_nonzero(right[frame]) * LOG_OUTLIER_DENSITY
            if with_frame - as_movement > as_error:
                errors[frame], as_movement = False, with_frame
            else:
                right[frame], total = False, total + as_error
        log_odds = total + as_movement - density.as_movement
        return SingleErrors(errors & (log_odds > 0.0), log_odds)


def find_likeliest(
    tests: Sequence[ErrorTest],
    observed: NDArray[np.bool_],
    rates: tuple[RatePrior, RatePrior],
) -> NDArray[np.bool_]:
    """Return the samples of the likeliest errors that do not overlap.

    Each run is movement, one error, or errors of single frames.

    Parameters
    ----------
    tests : sequence of ErrorTest
    observed : shape (n_frames, n_channels)
    rates : two RatePrior
        Of spikes, and of errors of several frames.
    """
    is_spike = np.array([test.run.is_spike for test in tests], dtype=np.bool_)
    gains, found = np.array([test.max_gain for test in tests]), np.zeros_like(observed)
    # Most runs cannot be likely enough, whatever the exact gains of the others are.
    for index in np.flatnonzero(_log_odds(gains, is_spike, observed, rates) > 0.0):
        gains[index] = tests[index].gain
    spike_rate = rates[0].log_rate(gains[is_spike], int(np.count_nonzero(observed)))
    singles = [test.find_single_errors(_with_adjacent(spike_rate)) for test in tests]
    # One error has to be likelier than both movement and single errors.
    gains -= np.maximum([single.log_odds for single in singles], 0.0)
    log_odds = _log_odds(gains, is_spike, observed, rates)
    for index in np.argsort(-log_odds):
        test, single = tests[index], singles[index]
        frames, samples = test.run.frames, test.run.channels[None]
        if log_odds[index] <= 0.0:
            frames, samples = test.density.frames, single.samples
        joint = slice(test.first_channel, test.first_channel + N_CHANNELS)
        samples = samples & observed[frames, joint]
        if not (found[frames, joint] & samples).any():
            found[frames, joint] |= samples
    return found


def _with_adjacent(log_rate: float) -> float:
    """Return the log-rate of all spikes from that of those with right frames on both sides.

    If a fraction p of frames is wrong, p (1 - p)^2 are wrong between right ones.
    """
    return float(
        np.log(np.interp(np.exp(log_rate), SPIKE_RATES * (1.0 - SPIKE_RATES) ** 2, SPIKE_RATES))
    )


def _log_odds(
    gains: Array,
    is_spike: NDArray[np.bool_],
    observed: NDArray[np.bool_],
    rates: tuple[RatePrior, RatePrior],
) -> Array:
    """Return the logarithm of the odds of each test: spikes and runs have their own rates."""
    log_odds, n_samples = gains.copy(), int(np.count_nonzero(observed))
    for rate, of_kind in zip(rates, (is_spike, ~is_spike), strict=True):
        log_odds[of_kind] += rate.log_rate(gains[of_kind], n_samples)
    return log_odds
