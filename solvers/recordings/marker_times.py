"""Markers whose frames have times beside them, brought to a constant frame rate."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError

DRIFT = 0.5
"""Frames by which stamps may be off a constant rate before they count as something else."""
ON_THE_GRID = 0.25
ALIKE = 0.05
LONGEST_STEP = 2.0
"""Frames between two stamps beyond which nothing is known in between."""
MOST_TIMES_LONGER = 20
FREE_FRAMES = 1000


def at_constant_rate(
    positions: NDArray[np.float64],
    times: NDArray[np.float64],
    said: float | None,
    path: Path | str,
) -> tuple[NDArray[np.float64], float]:
    """Return positions at a constant frame rate, and that rate.

    Where the stamps run evenly to within half a frame, as rounded ones do, nothing is changed,
    and the rate is the one the file says if the stamps bear it out, or else theirs. Where
    frames were left out, they come back as NaN. Where the stamps are uneven, positions are
    interpolated linearly between neighbours in time, but not across more than two frames, nor
    next to what was not seen.

    Parameters
    ----------
    positions : float array, shape (n_frames, n_points, 3)
    times : float array, shape (n_frames,), seconds, at least two, always increasing
    said : float, hertz, or None
        The frame rate that the file states.
    path : Path or str
        For error messages.

    Raises
    ------
    InvalidFileError
        The stamps leap so far that hardly anything but gaps would come out.
    """
    n_frames = len(times)
    since = times - times[0]
    for rate in (said, (n_frames - 1) / since[-1]):
        if rate is not None and np.abs(since * rate - np.arange(n_frames)).max() < DRIFT:
            return positions, float(rate)
    rate = _usual_rate(np.diff(times), said)
    since = since * rate
    if since[-1] > MOST_TIMES_LONGER * n_frames + FREE_FRAMES:
        raise InvalidFileError(
            f"{path}: {n_frames} frames are spread over {since[-1] / rate:g} s, from"
            f" {times[0]:g} to {times[-1]:g}. The times are damaged; export the file again."
        )
    slots = np.rint(since).astype(int)
    if np.abs(since - slots).max() < ON_THE_GRID and (np.diff(slots) > 0).all():
        spread = np.full((slots[-1] + 1, *positions.shape[1:]), np.nan)
        spread[slots] = positions
        return spread, rate
    return _interpolated(positions, since), rate


def _usual_rate(steps: NDArray[np.float64], said: float | None) -> float:
    """Return the rate within unbroken stretches: the one that is said, if it is about right."""
    usual = float(1.0 / steps[steps < LONGEST_STEP * np.median(steps)].mean())
    return usual if said is None or abs(usual / said - 1.0) > ALIKE else said


def _interpolated(
    positions: NDArray[np.float64], since: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return positions at 0, 1, 2... from positions at `since`, in frames from 0."""
    grid = np.arange(int(since[-1]) + 1)
    after = np.searchsorted(since, grid).clip(1, len(since) - 1)
    step = since[after] - since[after - 1]
    share = ((grid - since[after - 1]) / step)[:, None, None]
    between = (1.0 - share) * positions[after - 1] + share * positions[after]
    between[step > LONGEST_STEP] = np.nan
    return np.asarray(between)
