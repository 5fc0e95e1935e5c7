"""Find whether the noise of a take is correlated over time."""

import numpy as np

from ...arrays import Array, Flags
from .joint_noise import JointNoise
from .motion_mixture import N_CHANNELS, MotionMixture
from .noise_levels import MIN_MOVEMENT_DEG, MIN_OBSERVED, N_OVERLAPS
from .noise_spectrum import deviation_ratio
from .smooth_groups import GroupSmoother

CORRELATION_TIMES_S = (0.01, 0.02, 0.04)
"""Correlation times that are compared with white noise, seconds. By definition: a step is the
factor 2, from a fraction of a frame at 30 Hz up to where noise looks like movement."""
MIN_EVIDENCE = 1.0
"""Mean logarithm, over joints and windows, of the likelihood relative to that of white noise,
from which noise is correlated. Chosen by hand on the development takes of the first press:
clean and white ones have 0.7 at most (a fast run), those with 1/f noise 1.4 at least."""
MIN_NOISE_DEG = 1.0
"""Standard deviation of correlated noise, degrees. Chosen by hand: below it, noise costs
little, and clean movement that the mixture does not know may look like it."""
MAX_JOINTS = 12
"""Joints that are compared. It bounds the run time."""


def noise_correlation(
    samples: Array,
    noise: JointNoise,
    observed: Flags,
    frame_rate: float,
    mixture: MotionMixture,
) -> float:
    """Return the likeliest correlation time of a take's noise, seconds; 0 for white noise.

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
    white = GroupSmoother(covariances, frame_rate, mixture)
    if not len(joints) or not mixture.window <= white.length <= len(samples):
        return 0.0
    windows = white.windows(len(samples), N_OVERLAPS)
    known = windows.extract(observed[:, joints].astype(float), windows.starts)
    is_known = known.mean(axis=1) >= MIN_OBSERVED
    if not is_known.any():
        return 0.0
    chosen = samples[:, joints] - samples[:, joints].mean(axis=0)
    deviation = float(np.median(np.sqrt(np.einsum("jcc->j", covariances) / N_CHANNELS)))
    times = [0.0] + [
        each
        for each in CORRELATION_TIMES_S
        if deviation * deviation_ratio(frame_rate, each) > MIN_NOISE_DEG
    ]
    evidence = []
    for correlation_s in times:
        smoother = GroupSmoother(covariances, frame_rate, mixture, correlation_s)
        likelihoods = smoother.log_likelihoods(chosen, windows, np.ones(1))
        evidence.append(likelihoods[is_known].mean())
    best = int(np.argmax(evidence))
    return times[best] if evidence[best] > evidence[0] + MIN_EVIDENCE else 0.0
