"""Find whether the noise of a take is white, or its jitter lasts several frames."""

import numpy as np

from ...arrays import Array, Flags
from ..window_priors import deviation_ratio
from .joint_noise import JointNoise
from .motion_mixture import N_CHANNELS, MotionMixture
from .noise_levels import MIN_MOVEMENT_DEG, MIN_OBSERVED, N_OVERLAPS
from .smooth_groups import GroupSmoother

EXPONENTS = (0.5, 1.0, 1.5)
"""Exponents of colored noise that are compared with white noise: ratios of the logarithms of
power and frequency (`noise_spectrum`). By definition: from a little more than white noise over
1/f noise to a little less than a random walk, which is movement."""
FACTORS = 2.0 ** -np.arange(-0.5, 2.1, 0.5)
"""Factors of the deviation of the noise that are compared: third differences take fast movement
for noise, so that most often it is less. By definition: a step is the root of 2."""
N_IGNORED = 2
"""Number of the slowest coefficients of a window that do not count: they hold movement. Chosen
by hand on the development takes of the first press: with all, 1/f noise looks whiter."""
MIN_EVIDENCE = 0.5
"""Mean logarithm, over joints and windows, of the likelihood relative to that of white noise,
from which noise is colored. Chosen by hand on the development takes of the first press: clean
and white ones have 0.1 at most, those with 1/f noise 0.75 at least."""
MIN_NOISE_DEG = 0.7
"""Standard deviation of white noise with the same third differences, degrees, from which noise
may be colored. Chosen by hand: below it noise costs little, and short errors may look like
it."""
MAX_JOINTS = 12
"""Joints that are compared. It bounds the run time."""


def noise_exponent(
    samples: Array,
    noise: JointNoise,
    observed: Flags,
    frame_rate: float,
    mixture: MotionMixture,
) -> float:
    """Return the likeliest exponent of the noise of a take; 0 for white noise.

    All joints have the same: it depends on how they were tracked. It is judged by joints that
    turn about all of their axes. Below the frame rate of the mixture, fast movement and noise
    cannot be distinguished, so noise is white.

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
    moves = np.ptp(samples, axis=0).max(axis=1) > MIN_MOVEMENT_DEG
    free = np.flatnonzero(moves & noise.is_free[: len(moves)])
    n_chosen = min(len(free), MAX_JOINTS)
    joints = free[np.linspace(0, len(free) - 1, n_chosen).round().astype(int)]
    covariances = noise.covariances[joints]
    white = GroupSmoother(covariances, frame_rate, mixture, n_ignored=N_IGNORED)
    if not len(joints) or not mixture.window <= white.length <= len(samples):
        return 0.0
    windows = white.windows(len(samples), N_OVERLAPS)
    known = windows.extract(observed[:, joints].astype(float), windows.starts)
    is_known = known.mean(axis=1) >= MIN_OBSERVED
    deviations = np.sqrt(np.einsum("jcc->j", covariances) / N_CHANNELS)
    if not is_known.any() or np.median(deviations) < MIN_NOISE_DEG:
        return 0.0
    chosen = samples[:, joints] - samples[:, joints].mean(axis=0)
    evidence = {}
    for exponent in (0.0, *EXPONENTS):
        squared_ratio = deviation_ratio(white.length, exponent) ** 2
        smoother = GroupSmoother(
            covariances * squared_ratio, frame_rate, mixture, exponent, N_IGNORED
        )
        likelihoods = smoother.log_likelihoods(chosen, windows, FACTORS)
        evidence[exponent] = float(likelihoods[is_known].mean(axis=0).max())
    best = max(evidence, key=evidence.__getitem__)
    return best if evidence[best] > evidence[0.0] + MIN_EVIDENCE else 0.0
