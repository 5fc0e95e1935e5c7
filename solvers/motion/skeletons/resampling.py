"""Resample a recording to another frame rate."""

from dataclasses import replace
from functools import lru_cache
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ...arrays import row_blocks
from ...rotations import normalize, unroll
from ...signals import fill_gaps
from .frame_rate import check_frame_rate
from .motion import Motion
from .tracks import Tracks

STOPBAND_DB = 60.0
"""Attenuation of frequencies above the new Nyquist frequency, decibels. It guards shaking limbs
and jitter, which would become slow movements
(`test_movement_too_fast_for_the_new_rate_leaves_no_alias`)."""

PASSBAND = 0.7
"""Edge of the passband, as a fraction of the new Nyquist frequency. Half is worse
(`make sensitivity`), and twice is no fraction."""

ROWS_PER_BLOCK = 32
"""New frames that one matrix product filters. It bounds the run time."""

N_NODES = 4
"""Frames from which one value is interpolated. Half and twice are no better
(`make sensitivity`)."""

Recording = TypeVar("Recording", bound=Motion | Tracks)


def resample(recording: Recording, frame_rate: float) -> Recording:
    """Return the recording resampled to `frame_rate` hertz.

    Frame k is at time k / `frame_rate`; the last frame is not later than the recording's last
    frame. Values between frames come from the cubic through the four nearest frames (for
    rotations: of the unrolled quaternions, normalized). Frames that coincide are unchanged.
    Before downsampling, a zero-phase low-pass filter (Kaiser-windowed sinc) prevents aliasing:
    frequencies below 0.7 of the new Nyquist frequency pass. Gaps stay gaps: a new frame is
    observed if the frames on both sides are. Confidence is interpolated linearly.

    Parameters
    ----------
    recording : Motion or Tracks
    frame_rate : float, hertz

    Returns
    -------
    Motion or Tracks
        Same type as the recording; a recording of one frame keeps one frame.

    Raises
    ------
    InvalidMotionError
        The frame rate is outside the valid range.
    """
    check_frame_rate(frame_rate)
    times = _sample_times(recording.n_frames, recording.frame_rate, frame_rate)
    slowdown = frame_rate / recording.frame_rate
    if isinstance(recording, Motion):
        rotations = _sample_rotations(recording.rotations, times, slowdown)
        root_positions = _sample(recording.root_positions, times, slowdown)
        motion = Motion(recording.skeleton, rotations, root_positions, frame_rate)
        return cast(Recording, motion)
    confidence = recording.confidence
    if confidence is not None:
        frames = np.arange(recording.n_frames)
        confidence = np.stack(
            [np.interp(times, frames, column) for column in confidence.T], axis=-1
        )
    positions = _sample(recording.positions, times, slowdown)
    return replace(recording, positions=positions, confidence=confidence, frame_rate=frame_rate)


def _sample_times(n_frames: int, old_rate: float, new_rate: float) -> NDArray[np.float64]:
    """Return the times of the new frames, in old frames."""
    n_new = int(np.floor((n_frames - 1) * new_rate / old_rate + 1e-6)) + 1
    times = np.arange(n_new) * (old_rate / new_rate)
    nearest = np.round(times)
    times = np.where(np.abs(times - nearest) < 1e-6, nearest, times)
    return np.asarray(np.minimum(times, n_frames - 1))


def _sample_rotations(
    rotations: NDArray[np.float64], times: NDArray[np.float64], slowdown: float
) -> NDArray[np.float64]:
    """Return rotations at fractional frames, in blocks of joints."""
    result = np.empty((len(times), *rotations.shape[1:]))
    for columns in row_blocks(rotations.shape[1], 4 * len(rotations)):
        result[:, columns] = normalize(_sample(unroll(rotations[:, columns]), times, slowdown))
    return result


def _sample(
    values: NDArray[np.float64], times: NDArray[np.float64], slowdown: float
) -> NDArray[np.float64]:
    """Return `values`, shape (n_frames, ..., n), at fractional frames; gaps stay NaN."""
    observed = np.isfinite(values).all(axis=-1)
    filled = np.nan_to_num(fill_gaps(values))
    step = round(1.0 / slowdown)
    if slowdown >= 1.0 or len(values) < 2:
        result = _interpolate(filled, times)
    elif len(times) > 1 and np.array_equal(times, step * np.arange(len(times))):
        result = _low_pass(filled, slowdown, step)
    else:
        result = _interpolate(_low_pass(filled, slowdown), times)
    valid = observed[np.floor(times).astype(int)] & observed[np.ceil(times).astype(int)]
    result[~valid] = np.nan
    return result


def _low_pass(
    values: NDArray[np.float64], slowdown: float, step: int = 1
) -> NDArray[np.float64]:
    """Remove frequencies above the new Nyquist frequency; the ends keep their trend.

    Return every `step`-th frame.
    """
    kernel = _kernel(slowdown)
    half = len(kernel) // 2
    width = [(half, half)] + [(0, 0)] * (values.ndim - 1)
    padded = np.pad(values, width, mode="reflect", reflect_type="odd")
    flat = padded.reshape(len(padded), -1)
    filtered = np.empty((-(-len(values) // step), flat.shape[1]))
    rows = _kernel_rows(slowdown, step)
    for first in range(0, len(filtered), ROWS_PER_BLOCK):
        n_rows = min(ROWS_PER_BLOCK, len(filtered) - first)
        n_samples = (n_rows - 1) * step + len(kernel)
        valid = flat[first * step : first * step + n_samples]
        np.matmul(rows[:n_rows, :n_samples], valid, out=filtered[first : first + n_rows])
    return filtered.reshape(len(filtered), *values.shape[1:])


@lru_cache(maxsize=16)
def _kernel_rows(slowdown: float, step: int) -> NDArray[np.float64]:
    """Return the convolution matrix: the kernel in each row, shifted by `step`.

    A product with it is several times faster than a convolution, although half of it is zeros.
    """
    kernel = _kernel(slowdown)
    rows = np.zeros((ROWS_PER_BLOCK, (ROWS_PER_BLOCK - 1) * step + len(kernel)))
    for index, row in enumerate(rows):
        row[index * step : index * step + len(kernel)] = kernel
    return rows


@lru_cache(maxsize=16)
def _kernel(slowdown: float) -> NDArray[np.float64]:
    from scipy.signal import firwin, kaiserord  # takes a second: imported only when needed

    n_taps, beta = kaiserord(STOPBAND_DB, (1.0 - PASSBAND) * slowdown)
    cutoff = (1.0 + PASSBAND) / 2 * slowdown
    return np.asarray(firwin(2 * (n_taps // 2) + 1, cutoff, window=("kaiser", beta)))


def _interpolate(
    values: NDArray[np.float64], times: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Evaluate the Lagrange polynomial through the nearest frames at fractional frames."""
    n_nodes = min(N_NODES, len(values))
    first = np.clip(np.floor(times).astype(int) - 1, 0, len(values) - n_nodes)
    inside = times - first
    result = np.zeros((len(times), *values.shape[1:]))
    for node in range(n_nodes):
        others = [other for other in range(n_nodes) if other != node]
        weight = np.prod([(inside - other) / (node - other) for other in others], axis=0)
        weight = np.broadcast_to(weight, times.shape)
        result += weight.reshape(-1, *[1] * (values.ndim - 1)) * values[first + node]
    return result
