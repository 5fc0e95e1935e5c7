"""Likelihood of samples of a joint, given the other samples of their window."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..motion_model import N_CHANNELS, MotionMixture
from ..window_priors import Windows
from .single_outliers import OUTLIER_DENSITY
from .window_density import WindowDensity

OFFSET_DEVIATION = 0.5 / OUTLIER_DENSITY / np.sqrt(3.0)
"""Standard deviation of an outlier's error, degrees or centimeters. By definition of the width
of its uniform density."""

NEW_MOVEMENT_RATE = 1e-3
"""Fraction of suspected movements that begin out of another kind of movement, such as a kick
out of standing still. Sweep on 39 takes that are not scored: without it 304 samples of clean
takes are flagged, with it 203, and 3 % fewer of the burst samples are found."""

N_RARE_COMPONENTS = 8
"""Number of components, those of the largest movement, that rare movement exceeds. Sweep on 26
development takes at up to twice their speed: all 40 cost twice the time and separate errors
from movement no better."""
RARE_MOVEMENT_SCALE = 2.0
"""Ratio of rare movement to that of these components. Sweep on the same takes: with 3 the error
rises by 5 % where a tenth of the samples is wrong."""
RARE_MOVEMENT_WEIGHT = 0.03
"""Fraction of windows with rare movement. Sweep on the same takes: x0.3 flags a tenth more good
samples of takes with bursts, x3 keeps a burst of two frames in a walk at 24 Hz."""


class PredictiveDensity:
    """The density of samples of a joint's channels, given the channels' other samples.

    Parameters
    ----------
    samples : shape (n_frames, 3)
        About the joint's mean, complete.
    noise : shape (3,)
    windows : Windows
    mixture : MotionMixture
    axes : shape (3, 3)
        Principal axes of the joint's movement, as columns.
    """

    def __init__(
        self,
        samples: Array,
        noise: Array,
        windows: Windows,
        mixture: MotionMixture,
        axes: Array,
    ) -> None:
        self._samples, self._length = samples, windows.length
        self._density = WindowDensity(noise, windows.dct_basis(mixture.window), mixture, axes)

    def of_run(
        self, run: slice, tested: NDArray[np.bool_], valid: NDArray[np.bool_]
    ) -> "RunDensity":
        """Return how likely the tested samples of a run are, given the valid other ones.

        Parameters
        ----------
        run : slice
            Frames; of a run longer than a window, those of one window count.
        tested : shape (3,)
            Channels. A single frame is compared with the other frames of these channels only,
            which takes a tenth of the time; a longer run with all channels.
        valid : shape (n_frames, 3)
            Where samples are observed and, outside the run, no outliers.
        """
        length = self._length
        middle = (run.start + run.stop) // 2
        start = min(max(middle - length // 2, 0), len(self._samples) - length)
        inside = np.zeros((length, N_CHANNELS), dtype=np.bool_)
        inside[max(run.start - start, 0) : min(run.stop - start, length)] = tested
        is_single = run.stop - run.start == 1
        channels = tuple(np.flatnonzero(tested).tolist() if is_single else range(N_CHANNELS))
        frames = slice(start, start + length)
        return RunDensity(
            self._density, self._samples[frames], frames, channels, valid[frames], inside,
            not is_single,
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class RunDensity:
    """The density of the tested samples of a run, given the valid other ones.

    Attributes
    ----------
    density : WindowDensity
    samples : shape (length, 3)
        Of the window, complete.
    frames : slice
        The window around the run.
    channels : tuple of int
        Those that are compared.
    valid, tested : shape (length, 3)
        Samples of the window.
    may_be_off : bool
        Whether each tested channel may be off by a constant during the run.
    """

    density: WindowDensity
    samples: Array
    frames: slice
    channels: tuple[int, ...]
    valid: NDArray[np.bool_]
    tested: NDArray[np.bool_]
    may_be_off: bool

    @property
    def as_movement(self) -> float:
        """Log-density if the samples are right: the movement around them goes on, or another
        one begins."""
        return self._as_movement(self._both[0])

    def movement_of(self, right: NDArray[np.bool_]) -> float:
        """Return the same of some of the tested samples, without the others.

        Parameters
        ----------
        right : shape (length, 3)
        """
        valid = self.valid & (right | ~self.tested)
        both, _ = self.density.log_marginals(self.samples, self.channels, valid)
        return self._as_movement(both)

    @property
    def with_offset(self) -> float:
        """The same if each tested channel is off by a constant during the run."""
        return _log_sum(self._both[1]) - _log_sum(self._others) if self.may_be_off else -np.inf

    @property
    def max_gain(self) -> float:
        """The most by which `with_offset` can exceed `as_movement`, in half the time.

        It is the difference if the movement around the run can only go on.
        """
        both, with_offset = self._both
        return _log_sum(with_offset) - _log_sum(both) if self.may_be_off else -np.inf

    def _as_movement(self, both: Array) -> float:
        continued = _log_sum(both) - _log_sum(self._others)
        # The run may be of another kind of movement than the frames around it.
        begun = _log_sum(self.density.log_weights + both - self._others)
        return float(np.logaddexp(continued, np.log(NEW_MOVEMENT_RATE) + begun))

    @cached_property
    def _both(self) -> tuple[Array, Array]:
        """Of the tested and the other samples, for each component; and with an offset.

        A single frame that may be off by anything says nothing: its second density is that of
        the others.
        """
        deviation = OFFSET_DEVIATION if self.may_be_off else np.inf
        return self.density.log_marginals(
            self.samples, self.channels, self.valid, self.tested, deviation
        )

    @cached_property
    def _others(self) -> Array:
        if not self.may_be_off:
            return self._both[1]
        others = self.valid & ~self.tested
        return self.density.log_marginals(self.samples, self.channels, others)[0]


def _log_sum(log_densities: Array) -> float:
    """Return the logarithm of the sum of densities."""
    return float(np.logaddexp.reduce(log_densities))


@lru_cache(maxsize=4)
def with_rare_movement(mixture: MotionMixture) -> MotionMixture:
    """Return the mixture with heavier tails: people also move as its recordings do not.

    Copies of the components of the largest movement, scaled, join the mixture. A Gaussian
    alone takes a kick that is faster than any of the recordings for an error.
    """
    energies = np.einsum("kaii->k", mixture.covariances)
    largest = np.argsort(-energies, kind="stable")[:N_RARE_COMPONENTS]
    rare = mixture.covariances[largest] * RARE_MOVEMENT_SCALE**2
    weights = np.full(len(largest), RARE_MOVEMENT_WEIGHT / len(largest))
    return replace(
        mixture,
        weights=np.append((1.0 - RARE_MOVEMENT_WEIGHT) * mixture.weights, weights),
        covariances=np.concatenate([mixture.covariances, rare]),
    )
