"""Resample frames with uneven time stamps to a constant frame rate."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion.skeletons import check_frame_rate

DEFAULT_FRAME_RATE = 30.0
"""Frame rate in hertz of every Kinect in good light."""
COMMON_RATES = (
    5.0, 10.0, 15.0, 24.0, 25.0, 30.0, 50.0, 60.0, 72.0, 90.0, 100.0, 120.0, 200.0, 240.0,
    250.0, 300.0,
)  # fmt: skip
MILLISECOND = 0.001
MAX_DRIFT_FRAMES = 0.5
"""Maximum deviation in frames of rounded stamps from a constant rate. By definition: from half
a frame on, a stamp is that of another frame."""
MAX_RATE_DEVIATION = 0.03
"""Maximum relative deviation of a measured rate from the common rate that replaces it. Chosen
by hand: x0.5 fails `test_the_rate_is_the_common_one_if_there_is_one_nearby`."""
MIN_RATE_HZ, MAX_RATE_HZ = 0.1, 10_000.0
MAX_TIME_S = 1e11
"""Maximum time stamp in seconds, thousands of years."""
MIN_GAP_FRAMES = 1.6
"""Minimum distance in frame times of two frames between which a frame is missing, not late.
Chosen by hand: x0.5 fails `test_a_cubic_is_followed_exactly_through_uneven_stamps`."""
MAX_COUNTED_STEPS = 5.0
"""Maximum step between two frames, in typical steps, from which the rate is measured. It guards
pauses, whose length need be no multiple of a frame (`test_pauses_do_not_change_the_rate`)."""
MAX_DISTANCE_FRAMES = 0.5
"""Maximum distance in frame times of a time sample in a gap from the frame it copies. By
definition half: farther away, another sample is nearer."""
TIME_TOLERANCE = 1e-6
"""Fraction of a step between two frames that is only rounding."""
RATE_TOLERANCE = 1e-4
"""Relative deviation of a stated rate from a common one that is only rounding; 29.97 Hz differs
from 30 by 1e-3."""
MAX_LENGTH_RATIO, MAX_EXTRA_FRAMES = 10, 1000


def common_rate(rate: float) -> float:
    """Return the common rate nearest to a rate such as 120.00004 Hz, or the rate itself.

    Raises InvalidMotionError where a file states a rate that is none, such as 0.
    """
    check_frame_rate(rate)
    nearest = min(COMMON_RATES, key=lambda common: abs(common - rate))
    return nearest if abs(nearest - rate) <= RATE_TOLERANCE * nearest else rate


def constant_rate_from_times(
    times: NDArray[np.float64], stated_rate: float | None
) -> float | None:
    """Return the rate of stamps that are even to within half a frame, as rounded ones are.

    Parameters
    ----------
    times : float array, shape (n_frames,), seconds, at least two, always increasing
    stated_rate : float, hertz, or None
        The frame rate that the file states; it is used if it agrees with the stamps.

    Returns
    -------
    float or None
        None if they are uneven or frames were skipped: see `ConstantRate`.
    """
    elapsed, frames = times - times[0], np.arange(len(times))
    for rate in (stated_rate, frames[-1] / elapsed[-1]):
        if rate is not None and np.abs(elapsed * rate - frames).max() < MAX_DRIFT_FRAMES:
            return float(rate)
    return None


class ConstantRate:
    """Resample frames with uneven time stamps to a constant frame rate.

    Values between two frames are interpolated by the cubic through the four surrounding frames
    or, near gaps, linearly. Next to a gap (`MIN_GAP_FRAMES`), or where one of the two frames
    does not observe a point, the nearest frame is copied, up to half a frame time away. Farther
    away the value stays missing. Frames that are not later than all previous frames are
    skipped.

    Parameters
    ----------
    path : Path or str
        For error messages.
    times : float array, shape (n_in_file,), seconds
    stated_rate : float, hertz, or None
        The frame rate that the file states; it is used within 3 % of the measured one.

    Raises
    ------
    InvalidFileError
        Most time stamps are not increasing, or leave implausibly long gaps.
    """

    frame_rate: float
    """The measured rate in hertz, or the stated or a common rate within 3 % of it."""

    def __init__(
        self, path: Path | str, times: NDArray[np.float64], stated_rate: float | None = None
    ) -> None:
        usable = np.isfinite(times) & (np.abs(np.nan_to_num(times)) < MAX_TIME_S)
        latest = np.maximum.accumulate(np.where(usable, times, -np.inf))
        earlier = np.concatenate([[-np.inf], latest[:-1]])
        self._used_frames = np.flatnonzero(usable & (np.nan_to_num(times) > earlier))
        if 2 * len(self._used_frames) <= len(times) > 1 or not len(self._used_frames):
            raise InvalidFileError(
                f"{path}: most of its time stamps do not increase, so it has no frame rate."
                " Correct the column of time stamps."
            )
        elapsed = times[self._used_frames] - times[self._used_frames[0]]
        steps = np.diff(elapsed)
        self.frame_rate = _frame_rate(path, steps, stated_rate)
        n_frames = int(np.floor(elapsed[-1] * self.frame_rate + MAX_DISTANCE_FRAMES)) + 1
        if n_frames > MAX_LENGTH_RATIO * len(elapsed) + MAX_EXTRA_FRAMES:
            raise InvalidFileError(
                f"{path}: its {len(elapsed)} frames span {elapsed[-1]:.3g} s at a rate of"
                f" {self.frame_rate:.3g} Hz. Split it at the pauses, or correct its time"
                " stamps."
            )
        time_samples = np.minimum(np.arange(n_frames) / self.frame_rate, elapsed[-1])
        self._set_weights(time_samples, elapsed, self.frame_rate * steps)

    def nearest(self) -> NDArray[np.intp]:
        """Return the frame of the file nearest to each time sample; -1 beyond half a frame."""
        return np.asarray(np.where(self._is_near, self._nearest, -1))

    def positions(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Interpolate values of shape (n_in_file, n_points, n); gaps stay NaN."""
        result = self._weighted(values, self._interpolation_weights)
        broken = np.isnan(result).any(axis=-1)
        result[broken] = self._weighted(values, self._linear_weights)[broken]
        broken = np.isnan(result).any(axis=-1) | ~self._is_gap_free[:, None]
        result[broken] = values[self._nearest][broken]
        result[broken & ~self._is_near[:, None]] = np.nan
        return result

    def confidence(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Interpolate values of shape (n_in_file, n_points) linearly; 0 inside gaps."""
        result = self._weighted(values[..., None], self._linear_weights)[..., 0]
        result[~self._is_gap_free & ~self._is_near] = 0.0
        return np.asarray(np.clip(result, 0.0, 1.0))

    def states(self, values: NDArray[np.int8]) -> NDArray[np.int8]:
        """Return the smallest state of the frames that `positions` interpolates; 0 in gaps."""
        is_used = self._linear_weights > 0.0
        surrounding = values[self._used_frames[self._nodes]]
        state = np.where(is_used[..., None], surrounding, np.int8(127)).min(axis=1)
        broken = (state == 0) | ~self._is_gap_free[:, None]
        state[broken] = values[self._nearest][broken]
        state[broken & ~self._is_near[:, None]] = 0
        return np.asarray(state)

    def _set_weights(
        self,
        time_samples: NDArray[np.float64],
        elapsed: NDArray[np.float64],
        steps: NDArray[np.float64],
    ) -> None:
        """Set nodes, shape (n_frames, 4), and their weights; steps are in frame times."""
        last = len(elapsed) - 1
        before = np.clip(
            np.searchsorted(elapsed, time_samples, side="right") - 1, 0, max(last - 1, 0)
        )
        self._nodes = np.clip(before[:, None] + (-1, 0, 1, 2), 0, last)
        node_times = elapsed[self._nodes]
        span = node_times[:, 2] - node_times[:, 1]
        fraction = (time_samples - node_times[:, 1]) / np.where(span > 0.0, span, 1.0)
        fraction = np.where(
            np.minimum(fraction, 1.0 - fraction) < TIME_TOLERANCE, np.round(fraction), fraction
        )
        zero = np.zeros_like(fraction)
        self._linear_weights = np.stack([zero, 1.0 - fraction, fraction, zero], axis=1)
        is_gap_free = np.concatenate([[False], steps <= MIN_GAP_FRAMES, [False, False]])
        is_cubic = is_gap_free[before] & is_gap_free[before + 1] & is_gap_free[before + 2]
        is_cubic &= (fraction > 0.0) & (fraction < 1.0)
        self._interpolation_weights = self._linear_weights.copy()
        self._interpolation_weights[is_cubic] = _cubic_weights(
            node_times[is_cubic], time_samples[is_cubic]
        )
        distance = np.abs(node_times - time_samples[:, None])
        nearest = distance.argmin(axis=1)[:, None]
        self._nearest = self._used_frames[
            np.take_along_axis(self._nodes, nearest, axis=1)[:, 0]
        ]
        nearest_distance = np.take_along_axis(distance, nearest, axis=1)[:, 0] * self.frame_rate
        self._is_near = nearest_distance <= MAX_DISTANCE_FRAMES + TIME_TOLERANCE
        self._is_gap_free = is_gap_free[before + 1]

    def _weighted(
        self, values: NDArray[np.float64], weights: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        result = np.zeros((len(self._nodes), *values.shape[1:]))
        for nodes, weight in zip(self._nodes.T, weights.T, strict=True):
            part = values[self._used_frames[nodes]]
            part[weight == 0.0] = 0.0  # NaN of unused frames must not spread.
            result += weight[:, None, None] * part
        return result


def _frame_rate(
    path: Path | str, steps: NDArray[np.float64], stated_rate: float | None
) -> float:
    if not len(steps):
        return stated_rate or DEFAULT_FRAME_RATE
    with np.errstate(over="ignore"):
        rate = _measured_rate(steps)
    if not MIN_RATE_HZ <= rate <= MAX_RATE_HZ:
        raise InvalidFileError(
            f"{path}: its time stamps give {rate:.3g} frames per second, which is not possible."
            " Correct the column of time stamps."
        )
    if stated_rate is not None and abs(rate / stated_rate - 1.0) <= MAX_RATE_DEVIATION:
        return stated_rate
    nearest = min(COMMON_RATES, key=lambda common: abs(common - rate))
    return nearest if abs(rate / nearest - 1.0) <= MAX_RATE_DEVIATION else rate


def _measured_rate(steps: NDArray[np.float64]) -> float:
    # The median fails if every other frame is missing.
    quarter, half = np.quantile(steps, [0.25, 0.5], method="lower")
    typical_step = min((half, quarter), key=lambda step: _unevenness(steps / step))
    steps = steps[steps <= MAX_COUNTED_STEPS * typical_step]
    # A late frame makes the next step short, so the sums are robust.
    return float(np.round(steps / typical_step).sum() / steps.sum())


def _unevenness(step_counts: NDArray[np.float64]) -> float:
    """Return the mean deviation of steps in frame times from positive integers."""
    short = step_counts[step_counts <= MAX_COUNTED_STEPS]
    return float(np.abs(short - np.maximum(1.0, np.round(short))).mean())


def _cubic_weights(
    node_times: NDArray[np.float64], time_samples: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the weights of the Lagrange polynomial through four times, shape (n, 4)."""
    weights = np.ones_like(node_times)
    for node in range(node_times.shape[1]):
        for other in range(node_times.shape[1]):
            if other != node:
                weights[:, node] *= (time_samples - node_times[:, other]) / (
                    node_times[:, node] - node_times[:, other]
                )
    return weights
