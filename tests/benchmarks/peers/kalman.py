"""Kalman filters with Rauch-Tung-Striebel smoothing; NaN = not measured."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from solvers.arrays import Array

RIDGE = 1e-3


@dataclass(frozen=True, eq=False)
class Dynamics:
    """x' = F x + offset + N(0, Q); y = H x + N(0, R); x starts as N(start, spread)."""

    F: Array
    Q: Array
    H: Array
    R: Array
    offset: Array
    start: Array
    spread: Array


def smooth(dynamics: Dynamics, measured: Array) -> Array:
    """Return the smoothed states, shape (n_frames, n_states, ...): exact posterior means.

    `measured` is (n_frames, n_measured) with NaN anywhere. Rauch, Tung, Striebel (1965).
    """
    F, H = dynamics.F, dynamics.H
    mean, P, gain = dynamics.start, dynamics.spread, np.zeros((0, 0))
    predicted, filtered = [], []
    for frame, y in enumerate(measured):
        settled = frame > 1 and _same(P, filtered[-2][1]) and _same_pattern(measured, frame)
        if frame:
            mean = F @ mean + dynamics.offset
            P = predicted[-1][1] if settled else F @ P @ F.T + dynamics.Q
        predicted.append((mean, P))
        observed = np.isfinite(y)
        if settled:
            P = filtered[-1][1]
        elif observed.any():
            S = H[observed] @ P @ H[observed].T + dynamics.R[np.ix_(observed, observed)]
            gain = cho_solve(cho_factor(S), H[observed] @ P).T
            P = P - gain @ H[observed] @ P
            P = 0.5 * (P + P.T)
        if observed.any():
            mean = mean + gain @ (y[observed] - H[observed] @ mean)
        filtered.append((mean, P))
    return _backward(F, predicted, filtered)


def _backward(
    F: Array, predicted: list[tuple[Array, Array]], filtered: list[tuple[Array, Array]]
) -> Array:
    states = [filtered[-1][0]]
    pair: tuple[Array, ...] = ()
    for (m, P), (m_next, P_next) in zip(filtered[-2::-1], predicted[:0:-1], strict=True):
        if not (pair and pair[0] is P and pair[1] is P_next):
            gain = cho_solve(cho_factor(P_next), F @ P).T
            pair = (P, P_next)
        states.append(m + gain @ (states[-1] - m_next))
    return np.array(states[::-1])


def _same(P: Array, before: Array) -> bool:
    """Whether the covariance has settled, so that the gain may be used again."""
    return P is before or bool(np.abs(P - before).max() < 1e-9 * np.abs(P).max())


def _same_pattern(measured: Array, frame: int) -> bool:
    observed = np.isfinite(measured[frame - 2 : frame + 1])
    return bool((observed == observed[0]).all())


def constant_velocity(noisy: Array, frame_rate: float, agility: float) -> Array:
    """Each channel moves steadily, disturbed by white-noise acceleration.

    `agility` is the ratio of disturbance to measurement noise, per frame; larger follows the
    data closer. All channels with the same missing frames use one recursion.
    """
    F = np.array([[1.0, 1.0], [0.0, 1.0]])
    Q = agility**2 * np.array([[1 / 3, 1 / 2], [1 / 2, 1.0]])
    return _each_channel(noisy, F, Q)


def constant_acceleration(noisy: Array, frame_rate: float, agility: float) -> Array:
    """Each channel accelerates steadily, disturbed by white-noise jerk."""
    F = np.array([[1.0, 1.0, 0.5], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])
    Q = agility**2 * np.array([
        [1 / 20, 1 / 8, 1 / 6],
        [1 / 8, 1 / 3, 1 / 2],
        [1 / 6, 1 / 2, 1.0],
    ])
    return _each_channel(noisy, F, Q)


def learned_dynamics(
    noisy: Array, frame_rate: float, sigma: float, training: Sequence[Array]
) -> Array:
    """Linear dynamics of all channels together, learned by regression from the training clips.

    The "data-driven Kalman filter" of [LC10] 2.3.2, with smoothing; `sigma` is the
    measurement noise.
    """
    return np.asarray(smooth(learn_dynamics(training, sigma), noisy))


def learn_dynamics(training: Sequence[Array], sigma: float) -> Dynamics:
    """Regress every frame on the frame before, with a little ridge."""
    before = np.concatenate([clip[:-1] for clip in training])
    after = np.concatenate([clip[1:] for clip in training])
    mean = before.mean(axis=0)
    X, Y = before - mean, after - mean
    n = X.shape[1]
    scatter = X.T @ X
    F = np.linalg.solve(scatter + RIDGE * len(X) * np.eye(n), X.T @ Y).T
    Q = np.cov((Y - X @ F.T).T) + 1e-6 * np.eye(n)
    spread = scatter / len(X) + 1e-6 * np.eye(n)
    eye = np.eye(n)
    return Dynamics(F, Q, eye, sigma**2 * eye, mean - F @ mean, mean, spread)


def _each_channel(noisy: Array, F: Array, Q: Array) -> Array:
    """Smooth all channels; those that are observed in the same frames have the same gains."""
    H = np.eye(1, len(F))
    result = np.empty_like(noisy)
    patterns, which = np.unique(np.isfinite(noisy), axis=1, return_inverse=True)
    for number in range(patterns.shape[1]):
        columns = np.flatnonzero(which.ravel() == number)
        result[:, columns] = _smooth_pattern(noisy[:, columns], patterns[:, number], F, Q, H)
    return result


def _smooth_pattern(
    noisy: Array, observed: NDArray[np.bool_], F: Array, Q: Array, H: Array
) -> Array:
    n = len(F)
    mean = np.zeros((n, noisy.shape[1]))
    mean[0] = noisy[np.flatnonzero(observed)[0]] if observed.any() else 0.0
    P = 1e4 * np.eye(n)
    predicted, filtered = [], []
    for frame, y in enumerate(noisy):
        if frame:
            mean, P = F @ mean, F @ P @ F.T + Q
        predicted.append((mean, P))
        if observed[frame]:
            gain = P @ H.T / (H @ P @ H.T + 1.0)
            mean = mean + gain @ (y - H @ mean)
            P = P - gain @ H @ P
        filtered.append((mean, P))
    states = [mean]
    for (m, P), (m_next, P_next) in zip(filtered[-2::-1], predicted[:0:-1], strict=True):
        gain = np.linalg.solve(P_next, F @ P).T
        states.append(m + gain @ (states[-1] - m_next))
    return np.array(states[::-1])[:, 0]
