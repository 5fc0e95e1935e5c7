"""Find whether the noise of a take is white, or its jitter lasts several frames."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...signals import DIFFERENCE_ORDER
from ..window_priors import WHITE, NoiseSpectrum, Windows
from .joint_noise import JointNoise
from .motion_mixture import N_CHANNELS, MotionMixture
from .noise_levels import MIN_MOVEMENT_DEG, MIN_OBSERVED, N_OVERLAPS
from .smooth_groups import GroupSmoother

EXPONENTS = (0.5, 1.0, 1.5)
"""Exponents of power laws that are compared with white noise: ratios of the logarithms of the
power and the frequency. By definition: from a little more than white noise over 1/f noise to a
little less than a random walk, which is movement."""
CUTOFFS_HZ = (6.0, 9.0)
"""Frequencies, Hz, of the filters that are compared. By definition: the 6 Hz of biomechanics,
and half as much again. Jitter slower than 6 Hz cannot be distinguished from movement."""
FACTORS = 2.0 ** -np.arange(-1.0, 3.1)
"""Factors of the deviation of the noise that are compared: third differences take fast movement
for noise, and other filters leave other differences. By definition: a step is the factor 2."""
N_IGNORED = 2
"""Number of the slowest coefficients of a window that do not count: they hold movement. Sweep
on the development takes of the first press: with all, 1/f noise looks whiter."""
MIN_EVIDENCE = 0.65
"""Mean logarithm, over joints and windows, of the likelihood relative to that of white noise,
from which noise is colored. Measured on the development takes of the first press: clean and
white ones have 0.5 at most, those with 1/f noise 0.8 at least."""
MIN_FILTERED_EVIDENCE = 1.5
"""Lower quartile of the same mean logarithm over joints, from which noise was filtered. In a
smooth take, fast movement of a few joints looks like filtered noise, that of others does not.
Measured on the development takes: clean ones, filtered or not, have 1.0 at most."""
MAX_REPETITION = 0.4
"""Correlation coefficient of third differences with those after `MIN_LAG_S` or more, a ratio,
above which a take is fast movement that repeats itself, such as a shiver. Measured: takes with
filtered noise have 0.2 at most, except fast runs, and a walk that is played three times as fast
has 0.9."""
MIN_LAG_S = 0.35
"""Lag from which filtered noise is forgotten, seconds. Chosen by hand: twice the period of the
lowest cutoff."""
MIN_NOISE_DEG = 0.7
"""Standard deviation of noise, degrees, from which it may be colored: for power laws, of white
noise with the same third differences. Chosen by hand: below it noise costs little, and short
errors may look like it."""
MAX_FILTERED_NOISE_DEG = 6.0
"""Standard deviation up to which noise may be filtered, degrees. Measured: 2 to 3 degrees of
noise are estimated as 5 at most, and a shiver of 15 with white noise as more."""
MIN_RATE_RATIO = 0.75
"""Ratio of the frame rate from which noise may be colored to that of the mixture. Measured on
the development takes at 24 Hz, where clean ones have an evidence of 0.07 at most."""
MIN_STEP_DEG = 1e-9
"""Guards a division: a joint that stands still has no third differences, degrees."""
MAX_JOINTS = 12
"""Joints that are compared. It bounds the run time."""


def find_noise_spectrum(
    samples: Array,
    noise: JointNoise,
    observed: Flags,
    frame_rate: float,
    mixture: MotionMixture,
) -> NoiseSpectrum:
    """Return the likeliest spectrum of the noise of a take: white, a power law, or filtered.

    All joints have the same: it depends on how they were tracked. It is judged by joints that
    turn about all of their axes. Far below the frame rate of the mixture, fast movement and
    noise cannot be distinguished, so noise is white.

    Parameters
    ----------
    samples : shape (n_frames, n_joints, 3), degrees, without NaN
    noise : JointNoise
        Of these joints, and perhaps of others after them.
    observed : shape (n_frames, n_joints)
        Other samples were estimated.
    frame_rate : float, Hz
    mixture : MotionMixture
        Of joints.
    """
    if frame_rate < MIN_RATE_RATIO * mixture.frame_rate:
        return WHITE
    moves = np.ptp(samples, axis=0).max(axis=1) > MIN_MOVEMENT_DEG
    free = np.flatnonzero(moves & noise.is_free[: len(moves)])
    n_chosen = min(len(free), MAX_JOINTS)
    joints = free[np.linspace(0, len(free) - 1, n_chosen).round().astype(int)]
    evidence = _Evidence(
        samples[:, joints] - samples[:, joints].mean(axis=0), noise.covariances[joints],
        observed[:, joints], frame_rate, mixture,
    )  # fmt: skip
    length = evidence.smoother(WHITE).length
    if not len(joints) or length > len(samples) or not evidence.is_known.any():
        return WHITE
    found: dict[NoiseSpectrum, float] = {}
    if evidence.deviation >= MIN_NOISE_DEG:
        laws = (NoiseSpectrum(exponent) for exponent in EXPONENTS)
        found = {law: mean for law, mean, _ in evidence.of(laws) if mean > MIN_EVIDENCE}
    filters = _filters(frame_rate) if evidence.repetition <= MAX_REPETITION else ()
    for filtered, mean, quartile in evidence.of(filters):
        deviation = evidence.deviation * filtered.deviation_ratio(length)
        is_plausible = MIN_NOISE_DEG <= deviation <= MAX_FILTERED_NOISE_DEG
        if is_plausible and quartile > MIN_FILTERED_EVIDENCE:
            found[filtered] = mean
    return max(found, key=found.__getitem__, default=WHITE)


def _filters(frame_rate: float) -> Iterable[NoiseSpectrum]:
    for cutoff in CUTOFFS_HZ:
        for n_runs in (1, 2):
            yield NoiseSpectrum(cutoff=cutoff / frame_rate, n_runs=n_runs)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """How likely a take is with noise of different spectra."""

    samples: Array
    """Of the joints that are compared, about their mean, shape (n_frames, n_joints, 3)."""
    covariances: Array
    """Of their noise if it is white, shape (n_joints, 3, 3)."""
    observed: Flags
    frame_rate: float
    mixture: MotionMixture

    @cached_property
    def deviation(self) -> float:
        """Deviation of white noise in the median of the joints, degrees."""
        variances = np.einsum("jcc->j", self.covariances) / N_CHANNELS
        return float(np.sqrt(np.median(variances)))

    def smoother(self, spectrum: NoiseSpectrum) -> GroupSmoother:
        """Return the smoother for noise of a spectrum."""
        white = GroupSmoother(
            self.covariances, self.frame_rate, self.mixture, spectrum, N_IGNORED
        )
        ratio = spectrum.deviation_ratio(white.length)
        return replace(white, noise=self.covariances * ratio**2)

    def of(
        self, spectra: Iterable[NoiseSpectrum]
    ) -> Iterable[tuple[NoiseSpectrum, float, float]]:
        """Yield spectra with their scale, the mean log-likelihood relative to white noise, and
        its lower quartile over the joints."""
        for spectrum in spectra:
            likelihoods, factor = self._by_joint(spectrum)
            gains, n_known = likelihoods - self._white, self.is_known.sum(axis=0)
            mean = float(gains.sum() / n_known.sum())
            of_joints = gains[n_known > 0] / n_known[n_known > 0]
            yield replace(spectrum, scale=factor), mean, float(np.quantile(of_joints, 0.25))

    def _by_joint(self, spectrum: NoiseSpectrum) -> tuple[Array, float]:
        """Return the log-likelihood of each joint with the best factor of the noise."""
        found = self.smoother(spectrum).log_likelihoods(self.samples, self._windows, FACTORS)
        of_joints = np.where(self.is_known[..., None], found, 0.0).sum(axis=0)
        best = int(of_joints.sum(axis=0).argmax())
        return of_joints[:, best], float(FACTORS[best])

    @cached_property
    def repetition(self) -> float:
        """Largest correlation of third differences with later ones, the mean of all joints."""
        steps = np.diff(self.samples.reshape(len(self.samples), -1), DIFFERENCE_ORDER, axis=0)
        steps /= np.maximum(steps.std(axis=0), MIN_STEP_DEG)
        n_steps = len(steps)
        size = scipy.fft.next_fast_len(2 * n_steps, real=True)
        power = np.square(np.abs(scipy.fft.rfft(steps, size, axis=0))).sum(axis=1)
        products = scipy.fft.irfft(power, size)[: n_steps // 2 + 1]
        correlations = products / products[0] * n_steps / (n_steps - np.arange(len(products)))
        later = correlations[int(np.ceil(MIN_LAG_S * self.frame_rate)) :]
        return float(np.abs(later).max(initial=0.0))

    @cached_property
    def _white(self) -> Array:
        return self._by_joint(WHITE)[0]

    @cached_property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether enough of a joint was observed in a window, shape (n_windows, n_joints)."""
        known = self._windows.extract(self.observed.astype(float), self._windows.starts)
        return np.asarray(known.mean(axis=1) >= MIN_OBSERVED)

    @cached_property
    def _windows(self) -> Windows:
        return self.smoother(WHITE).windows(len(self.samples), N_OVERLAPS)
