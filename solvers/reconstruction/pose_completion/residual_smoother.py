"""How what was seen differs from what was synthesised, as a course through gaps."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_RELIABILITY = 0.05
"""Joints trusted less than this tell nothing."""


class Estimates(NamedTuple):
    """Estimates of values, shape (n_frames, n_joints, 3), and their standard deviations.

    `spread` has shape (n_frames, n_joints); it is that of each coordinate, in metres.
    """

    values: Array
    spread: Array


class _Process(NamedTuple):
    """How a value and its slope go on by themselves: transition, noise, start; (..., 2, 2)."""

    A: Array
    Q: Array
    start: Array


def measurement_deviation(trust: Array, noise: float) -> Array:
    """Return the standard deviation of what is seen; infinite where it tells nothing."""
    with np.errstate(divide="ignore"):
        return np.where(
            trust > MIN_RELIABILITY, noise / np.maximum(trust, MIN_RELIABILITY) ** 2, np.inf
        )


def smooth_residuals(
    seen: Array, deviation: Array, dt: float, size: Array, memory: float
) -> Estimates:
    """Follow values that fade to nothing where they are not seen.

    A Gaussian process with Matérn covariance (smoothness 3/2), as a Kalman filter and a
    Rauch-Tung-Striebel smoother [1]_.

    Parameters
    ----------
    seen : shape (n_frames, n_joints, 3), metres
        NaN: not seen.
    deviation : shape (n_frames, n_joints), metres
        Standard deviation of what was seen; infinite where it tells nothing.
    dt : float, seconds
    size : shape (n_joints,), metres
        Usual size of a value.
    memory : float, seconds
        How long it lasts.

    References
    ----------
    .. [1] Hartikainen, Särkkä (2010). Kalman filtering and smoothing solutions to temporal
       Gaussian process regression models. IEEE MLSP. doi:10.1109/MLSP.2010.5589113
    """
    rate = np.sqrt(3.0) / memory
    A = np.exp(-rate * dt) * np.array([
        [1.0 + rate * dt, dt],
        [-(rate**2) * dt, 1.0 - rate * dt],
    ])  # fmt: skip
    start = size[:, None, None] ** 2 * np.diag([1.0, rate**2])
    return _filter_and_smooth(seen, deviation, _Process(A, start - A @ start @ A.T, start))


def filter_residuals(
    synthesised: Array, seen: Array, deviation: Array, dt: float, size: Array, memory: float
) -> Estimates:
    """Estimate, from the past alone, how far joints are from where they were synthesised.

    A joint that is lost goes on from where it was last, and from there to where it is
    synthesised, in the time of its memory.

    Parameters
    ----------
    synthesised : shape (n_frames, n_joints, 3), metres
    seen, deviation, dt, size, memory
        As in `fading_course`; what was seen are joints, not differences.
    """
    told = np.isfinite(seen).all(axis=-1) & (deviation < np.inf)
    off = np.where(told[..., None], seen - synthesised, 0.0)
    fade = np.exp(-dt / memory)
    values, spread = np.empty_like(off), np.empty(told.shape)
    value, variance = np.zeros_like(off[0]), size**2
    for frame in range(len(off)):
        if frame:
            lost = told[frame - 1] & ~told[frame]
            jump = synthesised[frame - 1] - synthesised[frame]
            value = fade * value + lost[:, None] * (jump + (1.0 - fade) * value)
            variance = fade**2 * variance + (1.0 - fade**2) * size**2
        noise = np.where(told[frame], deviation[frame], np.inf) ** 2
        gain = variance / (variance + noise)
        value = value + gain[:, None] * (off[frame] - value)
        variance = (1.0 - gain) * variance
        values[frame], spread[frame] = value, np.sqrt(variance)
    return Estimates(values, spread)


def _filter_and_smooth(seen: Array, deviation: Array, process: _Process) -> Estimates:
    n_frames, n_joints = deviation.shape
    told = np.isfinite(seen).all(axis=-1)
    values = np.where(told[..., None], seen, 0.0)
    variances = np.where(told, deviation, np.inf)[..., None, None] ** 2
    A, Q, start = process
    mean, P = np.zeros((n_joints, 2, 3)), np.broadcast_to(start, (n_joints, 2, 2))
    means = np.empty((n_frames, n_joints, 2, 3))
    spreads = np.empty((n_frames, n_joints, 2, 2))
    for frame in range(n_frames):
        if frame:
            mean, P = A @ mean, A @ P @ A.T + Q
        gain = P[:, :, :1] / (P[:, :1, :1] + variances[frame])
        mean = mean + gain * (values[frame][:, None] - mean[:, :1])
        P = P - gain * P[:, :1]
        means[frame], spreads[frame] = mean, P
    _smooth_backward(means, spreads, A, Q)
    return Estimates(means[:, :, 0], np.sqrt(np.maximum(spreads[:, :, 0, 0], 1e-12)))


def _smooth_backward(means: Array, spreads: Array, A: Array, Q: Array) -> None:
    """Rauch-Tung-Striebel smoothing, in place."""
    predicted = A @ spreads[:-1] @ A.T + Q
    gains = np.linalg.solve(predicted, A @ spreads[:-1]).swapaxes(-1, -2)
    for frame in range(len(means) - 2, -1, -1):
        gain = gains[frame]
        means[frame] += gain @ (means[frame + 1] - A @ means[frame])
        change = spreads[frame + 1] - predicted[frame]
        spreads[frame] += gain @ change @ gain.swapaxes(-1, -2)
