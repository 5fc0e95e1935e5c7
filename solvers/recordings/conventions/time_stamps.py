"""From the moments at which a camera happened to see something to a constant frame rate."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError

DEFAULT_FRAME_RATE = 30.0
"""Hertz, of every Kinect in good light."""
COMMON_RATES = (5.0, 10.0, 15.0, 24.0, 25.0, 30.0, 50.0, 60.0, 90.0, 100.0, 120.0)
MAX_DRIFT_FRAMES = 0.5
"""Frames by which stamps may be off a constant rate and still be rounded ones."""
MAX_RATE_DEVIATION = 0.03
"""Share by which a measured rate may differ from the common one that is meant."""
MIN_RATE_HZ, MAX_RATE_HZ = 0.1, 10_000.0
MAX_TIME_S = 1e11
"""Seconds; thousands of years."""
MIN_HOLE_FRAMES = 1.6
"""Frame times between two frames from which on one is missing, rather than late."""
MAX_COUNTED_STEPS = 5.0
"""Usual steps in a step between two frames that still tells something of the rate."""
MAX_DISTANCE_FRAMES = 0.5
"""Frame times around a frame up to which it stands for moments in a gap."""
TIME_TOLERANCE = 1e-6
MAX_LENGTH_RATIO, MAX_EXTRA_FRAMES = 10, 1000


def constant_rate_from_times(times: NDArray[np.float64], said: float | None) -> float | None:
    """Return the rate of stamps that run evenly to within half a frame, as rounded ones do.

    Parameters
    ----------
    times : float array, shape (n_frames,), seconds, at least two, always increasing
    said : float, hertz, or None
        The frame rate that the file states: it counts if the stamps bear it out.

    Returns
    -------
    float or None
        None where they are uneven, or frames were left out: see `ConstantRate`.
    """
    since, frames = times - times[0], np.arange(len(times))
    for rate in (said, frames[-1] / since[-1]):
        if rate is not None and np.abs(since * rate - frames).max() < MAX_DRIFT_FRAMES:
            return float(rate)
    return None


class ConstantRate:
    """Resample frames with uneven time stamps to a constant frame rate.

    Values between two frames come from the cubic through the four surrounding frames or, near
    gaps, from linear interpolation. Next to a hole (`MIN_HOLE_FRAMES`), or where one of the two
    frames does not observe a point, the nearest frame counts alone, up to half a frame time
    away. Farther away the value stays missing. Frames that are not later than all previous
    frames are skipped.

    Parameters
    ----------
    path : Path or str
        For error messages.
    times : float array, shape (n_in_file,), seconds
    said : float, hertz, or None
        The frame rate that the file states: it counts if the stamps come near it.

    Raises
    ------
    InvalidFileError
        The time stamps run backwards, or leave holes beyond reason.
    """

    frame_rate: float
    """The one that was measured, in hertz, or the stated or a common one within 3 % of it."""

    def __init__(
        self, path: Path | str, times: NDArray[np.float64], said: float | None = None
    ) -> None:
        usable = np.isfinite(times) & (np.abs(np.nan_to_num(times)) < MAX_TIME_S)
        latest = np.maximum.accumulate(np.where(usable, times, -np.inf))
        earlier = np.concatenate([[-np.inf], latest[:-1]])
        self._kept = np.flatnonzero(usable & (np.nan_to_num(times) > earlier))
        if 2 * len(self._kept) <= len(times) > 1 or not len(self._kept):
            raise InvalidFileError(
                f"{path}: most of its time stamps are not later than those before them, so"
                " nobody can tell its frame rate. Mend the column of time stamps."
            )
        seen = times[self._kept] - times[self._kept[0]]
        steps = np.diff(seen)
        self.frame_rate = _frame_rate(path, steps, said)
        n_frames = int(np.floor(seen[-1] * self.frame_rate + MAX_DISTANCE_FRAMES)) + 1
        if n_frames > MAX_LENGTH_RATIO * len(seen) + MAX_EXTRA_FRAMES:
            raise InvalidFileError(
                f"{path}: its {len(seen)} frames are spread over {seen[-1]:.3g} s, though they"
                f" come at {self.frame_rate:.3g} Hz. Cut it where it pauses, or mend its time"
                " stamps."
            )
        moments = np.minimum(np.arange(n_frames) / self.frame_rate, seen[-1])
        self._place(moments, seen, self.frame_rate * steps)

    def nearest(self) -> NDArray[np.intp]:
        """Return the frame in the file nearest to each moment, -1 farther than half a frame."""
        return np.asarray(np.where(self._near, self._nearest, -1))

    def positions(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Interpolate values of shape (n_in_file, n_points, n); gaps stay NaN."""
        result = self._weighted(values, self._curved)
        broken = np.isnan(result).any(axis=-1)
        result[broken] = self._weighted(values, self._straight)[broken]
        broken = np.isnan(result).any(axis=-1) | ~self._whole[:, None]
        result[broken] = values[self._nearest][broken]
        result[broken & ~self._near[:, None]] = np.nan
        return result

    def confidence(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Interpolate values of shape (n_in_file, n_points) linearly; 0 inside holes."""
        result = self._weighted(values[..., None], self._straight)[..., 0]
        result[~self._whole & ~self._near] = 0.0
        return np.asarray(np.clip(result, 0.0, 1.0))

    def states(self, values: NDArray[np.int8]) -> NDArray[np.int8]:
        """Return the worse state, the smaller, of those that `positions` go by; 0 in gaps."""
        counts = self._straight > 0.0
        around = values[self._kept[self._nodes]]
        worst = np.where(counts[..., None], around, np.int8(127)).min(axis=1)
        broken = (worst == 0) | ~self._whole[:, None]
        worst[broken] = values[self._nearest][broken]
        worst[broken & ~self._near[:, None]] = 0
        return np.asarray(worst)

    def _place(
        self, moments: NDArray[np.float64], seen: NDArray[np.float64], gaps: NDArray[np.float64]
    ) -> None:
        """Set nodes, shape (n_frames, 4), and their weights; gaps are in frame times."""
        last = len(seen) - 1
        before = np.clip(np.searchsorted(seen, moments, side="right") - 1, 0, max(last - 1, 0))
        self._nodes = np.clip(before[:, None] + (-1, 0, 1, 2), 0, last)
        at = seen[self._nodes]
        span = at[:, 2] - at[:, 1]
        share = (moments - at[:, 1]) / np.where(span > 0.0, span, 1.0)
        share = np.where(
            np.minimum(share, 1.0 - share) < TIME_TOLERANCE, np.round(share), share
        )
        nothing = np.zeros_like(share)
        self._straight = np.stack([nothing, 1.0 - share, share, nothing], axis=1)
        whole = np.concatenate([[False], gaps <= MIN_HOLE_FRAMES, [False, False]])
        smooth = whole[before] & whole[before + 1] & whole[before + 2]
        smooth &= (share > 0.0) & (share < 1.0)
        self._curved = self._straight.copy()
        self._curved[smooth] = _cubic_weights(at[smooth], moments[smooth])
        distance = np.abs(at - moments[:, None])
        nearest = distance.argmin(axis=1)[:, None]
        self._nearest = self._kept[np.take_along_axis(self._nodes, nearest, axis=1)[:, 0]]
        near = np.take_along_axis(distance, nearest, axis=1)[:, 0] * self.frame_rate
        self._near = near <= MAX_DISTANCE_FRAMES + TIME_TOLERANCE
        self._whole = whole[before + 1]

    def _weighted(
        self, values: NDArray[np.float64], weights: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        result = np.zeros((len(self._nodes), *values.shape[1:]))
        for nodes, weight in zip(self._nodes.T, weights.T, strict=True):
            part = values[self._kept[nodes]]
            part[weight == 0.0] = 0.0  # NaN of frames that do not count must not spread.
            result += weight[:, None, None] * part
        return result


def _frame_rate(path: Path | str, steps: NDArray[np.float64], said: float | None) -> float:
    if not len(steps):
        return said or DEFAULT_FRAME_RATE
    with np.errstate(over="ignore"):
        rate = _measured_rate(steps)
    if not MIN_RATE_HZ <= rate <= MAX_RATE_HZ:
        raise InvalidFileError(
            f"{path}: by its time stamps it has {rate:.3g} frames per second, which cannot be."
            " Mend the column of time stamps."
        )
    if said is not None and abs(rate / said - 1.0) <= MAX_RATE_DEVIATION:
        return said
    nearest = min(COMMON_RATES, key=lambda common: abs(common - rate))
    return nearest if abs(rate / nearest - 1.0) <= MAX_RATE_DEVIATION else rate


def _measured_rate(steps: NDArray[np.float64]) -> float:
    quarter, half = np.quantile(
        steps, [0.25, 0.5], method="lower"
    )  # The half: unless every other is lost.
    usual = min((half, quarter), key=lambda step: _unevenness(steps / step))
    steps = steps[steps <= MAX_COUNTED_STEPS * usual]
    return float(np.round(steps / usual).sum() / steps.sum())  # A late one makes a short one.


def _unevenness(counts: NDArray[np.float64]) -> float:
    """How far numbers of frame times are from whole ones above 0."""
    short = counts[counts <= MAX_COUNTED_STEPS]
    return float(np.abs(short - np.maximum(1.0, np.round(short))).mean())


def _cubic_weights(
    at: NDArray[np.float64], moments: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Weights of Lagrange's polynomial through four times, shape (n, 4)."""
    weights = np.ones_like(at)
    for node in range(at.shape[1]):
        for other in range(at.shape[1]):
            if other != node:
                weights[:, node] *= (moments - at[:, other]) / (at[:, node] - at[:, other])
    return weights
