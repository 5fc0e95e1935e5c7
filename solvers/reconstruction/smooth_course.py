"""The course of a value through gaps: Kalman filters, and smoothers where the future is known."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

UNSEEN = 0.05
"""Joints trusted less than this tell nothing."""
FAR = 10.0
"""Metres, and metres per second: any place and any speed of a joint."""
SPAN = 0.25
"""Seconds to both sides over which it is measured how fast a joint changes its speed."""
QUIETEST = 1e-3
"""Metres: least second difference over that span that is believed."""


class Course(NamedTuple):
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


def noise_of(trust: Array, noise: float) -> Array:
    """Return the standard deviation of what is seen; infinite where it tells nothing."""
    with np.errstate(divide="ignore"):
        return np.where(trust > UNSEEN, noise / np.maximum(trust, UNSEEN) ** 2, np.inf)


def fading_course(
    seen: Array,
    deviation: Array,
    dt: float,
    *,
    size: float,
    memory: float,
    causal: bool = False,
) -> Course:
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
    size : float, metres
        Usual size of a value.
    memory : float, seconds
        How long it lasts.
    causal : bool
        Each frame by those up to it alone.

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
    start = size**2 * np.diag([1.0, rate**2])
    return _follow(seen, deviation, _Process(A, start - A @ start @ A.T, start), causal)


def going_course(
    seen: Array, deviation: Array, dt: float, *, restless: float = 1.0, causal: bool = False
) -> Course:
    """Follow joints that go on as they went: constant velocity, disturbed by white noise.

    In gaps this is a cubic spline, which says how unsure it is. How strong the disturbance is,
    each joint tells by its second differences over a quarter of a second.

    Parameters
    ----------
    seen, deviation, dt, causal
        As in `fading_course`.
    restless : float
        Times that strength.
    """
    lag = max(round(SPAN / dt), 1)
    known = np.where((deviation < np.inf)[..., None], seen, np.nan)
    turns = known[2 * lag :] - 2.0 * known[lag : -lag or None][: max(len(known) - 2 * lag, 0)]
    turns = turns + known[: max(len(known) - 2 * lag, 0)]
    told = np.isfinite(turns)
    square = np.where(told, turns, 0.0) ** 2
    mean = square.sum(axis=(0, 2)) / np.maximum(told.sum(axis=(0, 2)), 1)
    usual = mean.max(initial=0.0)
    mean = np.where(told.any(axis=(0, 2)), mean, usual)
    power = restless * 1.5 * np.maximum(mean, QUIETEST**2) / (lag * dt) ** 3
    A = np.array([[1.0, dt], [0.0, 1.0]])
    Q = power[:, None, None] * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    return _follow(seen, deviation, _Process(A, Q, FAR**2 * np.eye(2)), causal)


def agreed(one: Course, other: Course) -> Course:
    """Return the mean of two courses, the surer one counting more, by inverse variances."""
    a, b = one.spread**-2, other.spread**-2
    values = (a[..., None] * one.values + b[..., None] * other.values) / (a + b)[..., None]
    return Course(values, (a + b) ** -0.5)


def _follow(seen: Array, deviation: Array, process: _Process, causal: bool) -> Course:
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
    if not causal:
        _backwards(means, spreads, A, Q)
    return Course(means[:, :, 0], np.sqrt(np.maximum(spreads[:, :, 0, 0], 1e-12)))


def _backwards(means: Array, spreads: Array, A: Array, Q: Array) -> None:
    """Rauch-Tung-Striebel smoothing, in place."""
    predicted = A @ spreads[:-1] @ A.T + Q
    gains = np.linalg.solve(predicted, A @ spreads[:-1]).swapaxes(-1, -2)
    for frame in range(len(means) - 2, -1, -1):
        gain = gains[frame]
        means[frame] += gain @ (means[frame + 1] - A @ means[frame])
        change = spreads[frame + 1] - predicted[frame]
        spreads[frame] += gain @ change @ gain.swapaxes(-1, -2)
