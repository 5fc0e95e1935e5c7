"""Missing markers and the rate of rows, for all readers of marker tables."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ..conventions import MILLISECOND, ConstantRate, constant_rate_from_times

MAX_VALUE = 1e12
"""Maximum plausible measurement; some programs write larger values for missing markers."""
MIN_RISING_FRACTION = 0.8
"""Fraction of stamps that are later than all before, from which the stamps are used. Chosen by
hand: x0.5 fails `test_frame_numbers_serve_where_the_times_do_not`, x2
`test_motive_gaps_and_skipped_frames_are_gaps`."""
MIN_RATE_HZ, MAX_RATE_HZ = 1e-3, 1e6


def mark_missing(points: NDArray[np.float64], path: Path | str) -> None:
    """Set points, (F, n, 3), to NaN in place that are at the origin, incomplete or too far.

    Raises InvalidFileError if no point is left, with its place for the path.
    """
    points[~(np.abs(points) < MAX_VALUE)] = np.nan
    points[(points == 0.0).all(axis=-1) | ~np.isfinite(points).all(axis=-1)] = np.nan
    if not points.size or np.isnan(points).all():
        raise InvalidFileError(f"{path} has no markers that are observed in any frame.")


def at_constant_rate(
    points: NDArray[np.float64],
    frames: NDArray[np.float64],
    times: NDArray[np.float64],
    stated_rate: float | None,
    path: Path | str,
) -> tuple[NDArray[np.float64], float]:
    """Resample by the times, or by the frame numbers if these increase more often.

    Rows that repeat a stamp or go back are skipped. Without usable stamps the rate is the
    stated one.

    Parameters
    ----------
    points : float array, shape (n_rows, n_points, n)
    frames, times : float arrays, shape (n_rows,)
        Frame numbers, and seconds, or milliseconds if only these agree with the stated rate.
    stated_rate : float, hertz, or None
    path : Path or str
        For error messages.

    Returns
    -------
    The points at a constant rate, and the rate in hertz.
    """
    rate = stated_rate
    if rate is not None and not MIN_RATE_HZ < rate < MAX_RATE_HZ:
        raise InvalidFileError(f"{path} states a frame rate of {rate:g} Hz. Export it again.")
    clock = _clock(times, frames, rate)
    if clock is not None:
        even = _rises(clock) == 1.0
        if even and rate and constant_rate_from_times(MILLISECOND * clock, rate) == rate:
            clock = MILLISECOND * clock
        counted = rate is not None and _counts(frames, times, rate)
        rate = constant_rate_from_times(clock, rate) if even and not counted else None
        if rate is None:
            resampler = ConstantRate(path, clock, stated_rate)
            points, rate = resampler.positions(points), resampler.frame_rate
    if rate is None or not MIN_RATE_HZ < rate < MAX_RATE_HZ:
        raise InvalidFileError(f"{path} does not state its frame rate.")
    return points, rate


def _clock(
    times: NDArray[np.float64], frames: NDArray[np.float64], stated_rate: float | None
) -> NDArray[np.float64] | None:
    """Return the stamps that always increase, else those that mostly do; None for neither."""
    clocks = [times]
    if stated_rate is not None:
        clocks.insert(not _counts(frames, times, stated_rate), frames / stated_rate)
    best = max(clocks, key=_rises)
    return best if _rises(best) >= MIN_RISING_FRACTION else None


def _counts(
    frames: NDArray[np.float64], times: NDArray[np.float64], stated_rate: float
) -> bool:
    """Whether frame numbers skip some, and agree with the times if there are any."""
    if _rises(frames) != 1.0 or not (np.diff(frames) > 1.0).any():
        return False
    difference = (times - times[0]) * stated_rate - (frames - frames[0])
    return bool(np.isnan(times).all() or (np.abs(difference) < 0.5).all())


def _rises(values: NDArray[np.float64]) -> float:
    """Return the fraction of values above all before; 0 for less than two values."""
    if len(values) < 2:
        return 0.0
    return float((values[1:] > np.fmax.accumulate(values)[:-1]).mean())
