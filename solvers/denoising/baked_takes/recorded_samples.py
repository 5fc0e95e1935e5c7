"""The samples that a take was interpolated from, and the way back to its frames."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ...arrays import Array
from ...motion import Motion, Tracks, sample_at
from ...motion.skeletons import shot_ranges
from ...rotations import (
    inverse,
    multiply,
    normalize,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
    slerp,
    unroll,
)
from ...signals import fill_gaps
from .find_baking import Baking

MIXTURE_WEIGHT = 1e-6
"""Weight of a frame between two samples, relative to one that is a sample. It guards repeated
samples, which a mixture that is not exact would change
(`test_frames_that_were_dropped_before_are_filled_too`)."""
N_CORRECTIONS = 3
"""Corrections from quaternions that are mixed linearly to slerp. It bounds the rounding: after
three, turns of 20 degrees from sample to sample leave 1e-6 radians."""


def recorded_samples(recording: Motion | Tracks, baking: Baking) -> Motion | Tracks:
    """Return the recording at the rate at which it was recorded, by least squares.

    A sample is missing if any frame in which it has a weight is.
    """
    rate = recording.frame_rate * baking.n_samples / baking.n_frames
    if isinstance(recording, Tracks):
        return Tracks(recording.names, _samples_of(recording.positions, baking), rate)
    roots = _samples_of(recording.root_positions[:, None], baking)[:, 0]
    return Motion(recording.skeleton, _rotations_of(recording, baking), roots, rate)


def restore_rate(
    recording: Motion | Tracks,
    samples: Motion | Tracks,
    cuts: tuple[int, ...],
    baking: Baking,
) -> Motion | Tracks:
    """Return the cleaned samples, which have these cuts, at the frames of the recording.

    Between two samples it follows a cubic. Frames between two shots keep what was recorded.
    """
    low, high, weight = baking.neighbors(recording.n_frames)
    for start, stop in shot_ranges(samples, cuts):
        frames = np.flatnonzero((low >= start) & (high < stop))
        times = low[frames] - start + weight[frames]
        shot = sample_at(samples.slice(start, stop), times, recording.frame_rate)
        recording = _with_frames(recording, frames, shot)
    return recording


def describe_baking(recording: Motion | Tracks, baking: Baking) -> str:
    """Return a sentence for the animator."""
    rate = recording.frame_rate * baking.n_samples / baking.n_frames
    return (
        f"The take was recorded at {rate:.4g} Hz and interpolated to"
        f" {recording.frame_rate:.4g} Hz; it was cleaned at {rate:.4g} Hz."
    )


def _rotations_of(recording: Motion, baking: Baking) -> Array:
    """Return the rotations of which those of the recording are mixtures (slerp)."""
    rotations = normalize(_samples_of(unroll(recording.rotations), baking))
    low, high, weight = baking.neighbors(recording.n_frames)
    for _ in range(N_CORRECTIONS):
        mixed = slerp(rotations[low], rotations[high], weight[:, None])
        left = rotation_vector_from_quaternion(multiply(inverse(mixed), recording.rotations))
        # Missing samples stay so, and correct no others.
        correction = _samples_of(np.nan_to_num(left), baking)
        rotations = multiply(rotations, quaternion_from_rotation_vector(correction))
    return rotations


def _samples_of(values: Array, baking: Baking) -> Array:
    """Return the samples of which these values are linear mixtures; NaN where missing.

    Parameters
    ----------
    values : shape (n_frames, n_parts, n)
    """
    missing = ~np.isfinite(values).all(axis=2)
    low, high, weight = baking.neighbors(len(values))
    n_samples = int(high[-1]) + 1
    complete = np.nan_to_num(fill_gaps(values)).reshape(len(values), -1)
    # The normal equations are tridiagonal: a frame is a mixture of two neighboring samples.
    diagonal, beside = np.zeros(n_samples), np.zeros(n_samples)
    right = np.zeros((n_samples, complete.shape[1]))
    is_missing = np.zeros((n_samples, missing.shape[1]), dtype=np.bool_)
    reliability = np.where(low == high, 1.0, MIXTURE_WEIGHT)
    for sample, share in ((low, 1.0 - weight), (high, weight)):
        np.add.at(diagonal, sample, reliability * share**2)
        np.add.at(right, sample, (reliability * share)[:, None] * complete)
        np.logical_or.at(is_missing, sample, missing)
    np.add.at(beside, high, reliability * weight * (1.0 - weight))
    samples: Array = solveh_banded(np.stack([beside, diagonal]), right)
    samples = samples.reshape(n_samples, *values.shape[1:])
    samples[is_missing] = np.nan
    return samples


def _with_frames(
    recording: Motion | Tracks, frames: NDArray[np.intp], other: Motion | Tracks
) -> Motion | Tracks:
    """Return the recording with these frames of another one."""
    if isinstance(recording, Motion) and isinstance(other, Motion):
        rotations, roots = recording.rotations.copy(), recording.root_positions.copy()
        rotations[frames], roots[frames] = other.rotations, other.root_positions
        return recording.with_poses(rotations, roots)
    assert isinstance(recording, Tracks)
    assert isinstance(other, Tracks)
    positions = recording.positions.copy()
    positions[frames] = other.positions
    return recording.with_positions(positions)
