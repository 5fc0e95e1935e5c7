"""The same recording at another frame rate, with the same seconds."""

from dataclasses import replace
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...rotations import normalize, unroll
from ...signals import fill_gaps
from .frame_rate import check_frame_rate
from .motion import Motion
from .tracks import Tracks

STOPBAND = 60.0
"""Decibels by which what the new rate cannot carry is weakened."""

PASSED = 0.7
"""Part of the new Nyquist frequency up to which motion is kept."""

NUMBERS_AT_ONCE = 4_000_000
"""Of which more would need much memory: two hours of a skeleton are thirty times as many."""

ROWS_AT_ONCE = 32
"""New frames that one product filters."""

STENCIL = 4
"""Frames that take part in one interpolated value."""

Recording = TypeVar("Recording", Motion, Tracks)


def resample(recording: Recording, frame_rate: float) -> Recording:
    """Return the recording seen at `frame_rate` hertz.

    Frame k is the moment k / `frame_rate`; the last frame is the last such moment that is not
    after the recording's own last frame. Values between frames come from the cubic through the
    four frames around them (for rotations: of the unrolled quaternions, normalised), so frames
    that coincide stay as they are. When the rate falls, a zero-phase low-pass filter comes
    first (Kaiser-windowed sinc): all below 0.7 of the new Nyquist frequency passes, what
    would come back as false slow motion is removed. Gaps stay gaps: a moment is observed where
    the frames on either side of it are. Confidence is interpolated linearly.

    Parameters
    ----------
    recording : Motion or Tracks
    frame_rate : float, hertz

    Returns
    -------
    Motion or Tracks
        As the recording; one of one frame stays one of one frame.

    Raises
    ------
    InvalidMotionError
        No recording has this frame rate.
    """
    check_frame_rate(frame_rate)
    times = _moments(recording.n_frames, recording.frame_rate, frame_rate)
    slowdown = frame_rate / recording.frame_rate
    if isinstance(recording, Motion):
        rotations = _sampled_rotations(recording.rotations, times, slowdown)
        places = _sampled(recording.root_positions, times, slowdown)
        return Motion(recording.skeleton, rotations, places, frame_rate)
    confidence = recording.confidence
    if confidence is not None:
        frames = np.arange(recording.n_frames)
        confidence = np.stack([np.interp(times, frames, one) for one in confidence.T], axis=-1)
    positions = _sampled(recording.positions, times, slowdown)
    return replace(recording, positions=positions, confidence=confidence, frame_rate=frame_rate)


def _moments(n_frames: int, old_rate: float, new_rate: float) -> NDArray[np.float64]:
    """Return the new frames' times, counted in old frames."""
    n_new = int(np.floor((n_frames - 1) * new_rate / old_rate + 1e-6)) + 1
    times = np.arange(n_new) * (old_rate / new_rate)
    nearest = np.round(times)
    times = np.where(np.abs(times - nearest) < 1e-6, nearest, times)
    return np.asarray(np.minimum(times, n_frames - 1))


def _sampled_rotations(
    rotations: NDArray[np.float64], times: NDArray[np.float64], slowdown: float
) -> NDArray[np.float64]:
    """Return rotations at fractional frames, some joints at a time."""
    result = np.empty((len(times), *rotations.shape[1:]))
    step = max(NUMBERS_AT_ONCE // (4 * len(rotations)), 1)
    for joint in range(0, rotations.shape[1], step):
        some = slice(joint, joint + step)
        result[:, some] = normalize(_sampled(unroll(rotations[:, some]), times, slowdown))
    return result


def _sampled(
    values: NDArray[np.float64], times: NDArray[np.float64], slowdown: float
) -> NDArray[np.float64]:
    """Return `values`, shape (n_frames, ..., n), at fractional frames; gaps stay NaN."""
    observed = np.isfinite(values).all(axis=-1)
    filled = np.nan_to_num(fill_gaps(values))
    step = round(1.0 / slowdown)
    if slowdown >= 1.0 or len(values) < 2:
        result = _interpolated(filled, times)
    elif len(times) > 1 and np.array_equal(times, step * np.arange(len(times))):
        result = _low_passed(filled, slowdown, step)
    else:
        result = _interpolated(_low_passed(filled, slowdown), times)
    seen = observed[np.floor(times).astype(int)] & observed[np.ceil(times).astype(int)]
    result[~seen] = np.nan
    return result


def _low_passed(
    values: NDArray[np.float64], slowdown: float, step: int = 1
) -> NDArray[np.float64]:
    """Remove what lies above the new Nyquist frequency; the ends keep their trend.

    With `step`, return that many-th frames only.
    """
    kernel = _kernel(slowdown)
    half = len(kernel) // 2
    width = [(half, half)] + [(0, 0)] * (values.ndim - 1)
    padded = np.pad(values, width, mode="reflect", reflect_type="odd")
    flat = padded.reshape(len(padded), -1)
    passed = np.empty((-(-len(values) // step), flat.shape[1]))
    rows = _kernel_rows(slowdown, step)
    for first in range(0, len(passed), ROWS_AT_ONCE):
        n_rows = min(ROWS_AT_ONCE, len(passed) - first)
        n_seen = (n_rows - 1) * step + len(kernel)
        seen = flat[first * step : first * step + n_seen]
        np.matmul(rows[:n_rows, :n_seen], seen, out=passed[first : first + n_rows])
    return passed.reshape(len(passed), *values.shape[1:])


@lru_cache(maxsize=16)
def _kernel_rows(slowdown: float, step: int) -> NDArray[np.float64]:
    """Return the kernel once in each row, `step` further on than in the one above.

    A product with it is several times as fast as a convolution, though half of it is zeros.
    """
    kernel = _kernel(slowdown)
    rows = np.zeros((ROWS_AT_ONCE, (ROWS_AT_ONCE - 1) * step + len(kernel)))
    for number, row in enumerate(rows):
        row[number * step : number * step + len(kernel)] = kernel
    return rows


@lru_cache(maxsize=16)
def _kernel(slowdown: float) -> NDArray[np.float64]:
    from scipy.signal import firwin, kaiserord  # takes a second: only when needed

    n_taps, beta = kaiserord(STOPBAND, (1.0 - PASSED) * slowdown)
    cutoff = (1.0 + PASSED) / 2 * slowdown
    return np.asarray(firwin(2 * (n_taps // 2) + 1, cutoff, window=("kaiser", beta)))


def _interpolated(
    values: NDArray[np.float64], times: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Lagrange's polynomial through the nearest frames, at fractional frames."""
    n_nodes = min(STENCIL, len(values))
    first = np.clip(np.floor(times).astype(int) - 1, 0, len(values) - n_nodes)
    inside = times - first
    result = np.zeros((len(times), *values.shape[1:]))
    for node in range(n_nodes):
        others = [other for other in range(n_nodes) if other != node]
        weight = np.prod([(inside - other) / (node - other) for other in others], axis=0)
        weight = np.broadcast_to(weight, times.shape)
        result += weight.reshape(-1, *[1] * (values.ndim - 1)) * values[first + node]
    return result
