"""Fit curves with few keys, such as Blender's F-Curves with Bezier handles."""

from dataclasses import dataclass

import numpy as np
import scipy

from ..arrays import Array, Integers

SLOPE_WEIGHT = 1e-3
"""Weight of the samples' own slope at the keys, which regularizes the fit. Half and twice are
no better (`make sensitivity`)."""
END_WEIGHT = 100.0
"""Weight of the first and the last sample, where clips are joined. Half and twice are no better
(`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class KeyCurve:
    """Channels with common key frames, and a slope at each key.

    Between two keys every channel is the cubic polynomial with these values and slopes: a
    Bezier F-Curve with handles at one third of the distance to the neighboring keys.

    Attributes
    ----------
    frames : int array, shape (n_keys,), increasing
        Without keys, the channels are not animated.
    values : shape (n_keys, n_channels)
    slopes : shape (n_keys, n_channels), per frame
    """

    frames: Integers
    values: Array
    slopes: Array

    def at(self, frames: Integers | Array) -> Array:
        """Return the channels at frames, shape (n, n_channels); constant outside the keys."""
        if len(self.frames) < 2:
            return np.broadcast_to(self.values[:1], (len(frames), self.values.shape[1])).copy()
        times = np.clip(np.asarray(frames, float), self.frames[0], self.frames[-1])
        segment = np.clip(
            np.searchsorted(self.frames, times, side="right") - 1, 0, len(self.frames) - 2
        )
        start, stop, begin, end = _basis(times, segment, self.frames)
        after = segment + 1
        return np.asarray(
            start[:, None] * self.values[segment]
            + begin[:, None] * self.slopes[segment]
            + stop[:, None] * self.values[after]
            + end[:, None] * self.slopes[after]
        )

    def handles(self) -> tuple[Array, Array]:
        """Return frames (n_keys, 2) and values (n_keys, 2, n_channels) of both handles.

        The left handle comes first. The outermost handles are one third of a frame long.
        """
        gaps = np.diff(self.frames).astype(np.float64)
        before = np.concatenate([[1.0], gaps])[: len(self.frames)]
        after = np.concatenate([gaps, [1.0]])[: len(self.frames)]
        shifts = np.stack([-before, after], axis=1) / 3.0
        values = self.values[:, None] + shifts[:, :, None] * self.slopes[:, None]
        return self.frames[:, None] + shifts, values


def fit_curve(samples: Array, keys: Integers) -> KeyCurve:
    """Return the least-squares fit of a curve with these keys to the samples.

    Parameters
    ----------
    samples : shape (n_frames, n_channels)
        One at each frame.
    keys : int array, shape (n_keys,), increasing
        Frames of the keys; several keys must include the first and the last frame.
    """
    if len(keys) < 2:
        return KeyCurve(keys, samples[keys], np.zeros((len(keys), samples.shape[1])))
    frames = np.arange(len(samples))
    segment = np.clip(np.searchsorted(keys, frames, side="right") - 1, 0, len(keys) - 2)
    basis = np.stack(_basis(frames.astype(float), segment, keys), axis=1)[:, (0, 2, 1, 3)]
    weights = np.ones(len(samples))
    weights[[0, -1]] = END_WEIGHT
    weighted = basis * weights[:, None]
    first = keys[:-1]
    squares = np.add.reduceat(weighted[:, :, None] * basis[:, None, :], first, axis=0)
    sides = np.add.reduceat(weighted[:, :, None] * samples[:, None, :], first, axis=0)
    banded, side = _assemble_equations(squares, sides)
    lengths = np.diff(keys).astype(np.float64)
    slope_weights = SLOPE_WEIGHT * (np.append(lengths, 0.0) ** 2 + np.append(0.0, lengths) ** 2)
    banded[3, 1::2] += slope_weights
    side[1::2] += (
        slope_weights[:, None]
        * np.gradient(samples, axis=0, edge_order=2 if len(samples) > 2 else 1)[keys]
    )
    solution = scipy.linalg.solveh_banded(banded, side, check_finite=False)
    return KeyCurve(keys, solution[0::2], solution[1::2])


def _basis(
    times: Array, segment: Integers, keys: Integers
) -> tuple[Array, Array, Array, Array]:
    """Return the Hermite basis of start and stop values, then of their slopes."""
    length = (keys[segment + 1] - keys[segment]).astype(np.float64)
    u = (times - keys[segment]) / length
    stop = u * u * (3.0 - 2.0 * u)
    return 1.0 - stop, stop, u * (1.0 - u) ** 2 * length, u * u * (u - 1.0) * length


def _assemble_equations(squares: Array, sides: Array) -> tuple[Array, Array]:
    """Return the normal equations of value, slope, value, ... as LAPACK's upper bands."""
    n_keys = len(squares) + 1
    banded, side = np.zeros((4, 2 * n_keys)), np.zeros((2 * n_keys, sides.shape[2]))
    for row in range(4):
        side[row : row + 2 * n_keys - 2 : 2] += sides[:, row]
        for column in range(row, 4):
            row_of_band = banded[3 - (column - row)]
            row_of_band[column : column + 2 * n_keys - 2 : 2] += squares[:, row, column]
    return banded, side
