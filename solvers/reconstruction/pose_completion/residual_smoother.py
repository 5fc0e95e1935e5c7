"""Smooth the residual between observed and synthesized positions across gaps."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ..reliability import WRONG_RELIABILITY


class Estimates(NamedTuple):
    """Estimated values, shape (n_frames, n_joints, 3), and their standard deviations.

    `spread` has shape (n_frames, n_joints); it is the standard deviation of each coordinate, m.
    """

    values: Array
    spread: Array


class _Process(NamedTuple):
    """Dynamics of a value and its slope: transition, noise, start; (..., 2, 2)."""

    A: Array
    Q: Array
    start: Array


def measurement_deviation(reliability: Array, noise: float) -> Array:
    """Return the standard deviation of observations, same shape; infinite if unreliable."""
    with np.errstate(divide="ignore"):
        return np.where(
            reliability > WRONG_RELIABILITY,
            noise / np.maximum(reliability, WRONG_RELIABILITY) ** 2,
            np.inf,
        )


def smooth_residuals(
    observed: Array, deviation: Array, dt: float, size: Array, memory: float
) -> Estimates:
    """Smooth residuals that decay to zero across gaps.

    A Gaussian process with Matérn covariance (smoothness 3/2), computed by a Kalman filter and
    a Rauch-Tung-Striebel smoother [1]_.

    Parameters
    ----------
    observed : shape (n_frames, n_joints, 3), meters
        NaN: missing.
    deviation : shape (n_frames, n_joints), meters
        Standard deviation of the observations; infinite for missing joints.
    dt : float, seconds
    size : shape (n_joints,), meters
        Standard deviation of the process.
    memory : float, seconds
        Time constant of the decay.

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
    return _filter_and_smooth(observed, deviation, _Process(A, start - A @ start @ A.T, start))


class ResidualFilter:
    """Estimates the residuals of joints from past frames only, frame by frame.

    After a dropout, a joint moves from its last position to its synthesized position within the
    time constant `memory`.

    Parameters
    ----------
    dt, size, memory : as in `smooth_residuals`
    """

    def __init__(self, dt: float, size: Array, memory: float) -> None:
        self._decay, self._size = np.exp(-dt / memory), size
        self._variance = size**2
        self._value: Array | None = None
        self._last_synthesized, self._was_observed = np.zeros((len(size), 3)), size > 0.0

    def update(self, synthesized: Array, observed: Array, deviation: Array) -> Estimates:
        """Return the residuals of the next frames.

        Parameters
        ----------
        synthesized, observed : shape (n_frames, n_joints, 3), meters
            Positions; NaN where not observed.
        deviation : shape (n_frames, n_joints), meters
        """
        is_observed = np.isfinite(observed).all(axis=-1) & (deviation < np.inf)
        residuals = np.where(is_observed[..., None], observed - synthesized, 0.0)
        values, spread = np.empty_like(residuals), np.empty(is_observed.shape)
        for frame in range(len(residuals)):
            values[frame], spread[frame] = self._advance(
                synthesized[frame], residuals[frame], is_observed[frame], deviation[frame]
            )
        return Estimates(values, spread)

    def _advance(
        self, synthesized: Array, residual: Array, is_observed: Flags, deviation: Array
    ) -> tuple[Array, Array]:
        decay, value, variance = self._decay, self._value, self._variance
        if value is None:
            value = np.zeros_like(residual)
        else:
            dropped_out = self._was_observed & ~is_observed
            displacement = self._last_synthesized - synthesized
            value = decay * value + dropped_out[:, None] * (
                displacement + (1.0 - decay) * value
            )
            variance = decay**2 * variance + (1.0 - decay**2) * self._size**2
        noise = np.where(is_observed, deviation, np.inf) ** 2
        gain = variance / (variance + noise)
        self._value = value + gain[:, None] * (residual - value)
        self._variance = (1.0 - gain) * variance
        self._last_synthesized, self._was_observed = synthesized, is_observed
        return self._value, np.sqrt(self._variance)


def _filter_and_smooth(observed: Array, deviation: Array, process: _Process) -> Estimates:
    n_frames, n_joints = deviation.shape
    is_observed = np.isfinite(observed).all(axis=-1)
    values = np.where(is_observed[..., None], observed, 0.0)
    variances = np.where(is_observed, deviation, np.inf)[..., None, None] ** 2
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
        correction = spreads[frame + 1] - predicted[frame]
        spreads[frame] += gain @ correction @ gain.swapaxes(-1, -2)
