"""Handle the boundaries of a gap: dense training frames, and no step where the fill begins."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...signals import DIFFERENCE_GAIN, DIFFERENCE_ORDER, find_runs
from .predict_marker import PredictedMarker

MAX_TRAINING_FRAMES = 200
"""Number of training frames, in addition to those at the boundaries of gaps. It bounds the run
time of long takes with many gaps: x0.2 gains 1.2 %."""
MAX_TRAINING_RATE_HZ = 60.0
"""Hertz: bodies move too slowly for more frames per second to add information. Half and twice
gain less than 1 % (`make sensitivity`)."""
BOUNDARY_FRAMES = (1, 2, 3, 5, 8)
"""Distances in frames from a gap that are always training frames. Half and twice are no better
(`make sensitivity`)."""
FADE_TIME_S = 0.2
"""Seconds over which the error at a boundary fades. Half and twice gain less than 1 %
(`make sensitivity`)."""
MIN_NOISE_M = 1e-5
"""Meters: the smallest noise of a trajectory; it guards a division."""
MEDIAN_NORM = 1.538
"""Ratio of the median length of 3D vectors to the standard deviation of their Gaussian
coordinates. By definition: the root of the median of chi-square with 3 degrees of freedom."""
N_DEPTHS = 5
"""Number of depths into a gap with separate expected errors. Half and twice gain less than 1 %
(`make sensitivity`)."""


def select_training_frames(
    training_frames: NDArray[np.intp],
    observed: Flags,
    gap: Flags,
    frame_rate: float,
) -> NDArray[np.intp]:
    """Return some of the training frames, indices, and all those near the gaps.

    `observed` and `gap` have the shape (n_frames,); the frame rate is in hertz.
    """
    n_steps = -(-len(training_frames) // MAX_TRAINING_FRAMES)
    step = max(round(frame_rate / MAX_TRAINING_RATE_HZ), n_steps, 1)
    selected = np.zeros(len(observed), dtype=bool)
    selected[training_frames[::step]] = True
    for start, stop in find_runs(gap):
        near_boundary = np.array(
            [start - distance for distance in BOUNDARY_FRAMES]
            + [stop - 1 + distance for distance in BOUNDARY_FRAMES]
        )
        selected[near_boundary[(near_boundary >= 0) & (near_boundary < len(observed))]] = True
    return np.flatnonzero(selected & observed)


def estimate_jitter(trajectory: Array) -> float:
    """Return the standard deviation of a coordinate's noise, independent of orientation.

    Parameters
    ----------
    trajectory : shape (n_frames, 3), meters
        NaN where not observed.
    """
    sizes = np.linalg.norm(np.diff(trajectory, DIFFERENCE_ORDER, axis=0), axis=1)
    sizes = sizes[np.isfinite(sizes)]
    return float(np.median(sizes)) / (MEDIAN_NORM * DIFFERENCE_GAIN) if len(sizes) else 0.0


def extrapolate_boundary_errors(
    boundary_errors: Array,
    training_frames: NDArray[np.intp],
    gap_frames: NDArray[np.intp],
    noise: float,
    frame_rate: float,
) -> Array:
    """Extrapolate the errors around a gap into it, shape (n_gap_frames, 3), meters.

    The model of the errors is an Ornstein-Uhlenbeck process, a random walk with a pull to zero,
    observed with noise. A smooth process would extrapolate their slope, which is mere chance.
    """
    near_boundary = np.abs(training_frames[:, None] - gap_frames[None]).min(axis=1) <= max(
        BOUNDARY_FRAMES
    )
    if not near_boundary.any():
        return np.zeros((len(gap_frames), 3))
    frames_near, errors_near = training_frames[near_boundary], boundary_errors[near_boundary]
    power = float((errors_near**2).mean()) + MIN_NOISE_M**2
    decay_rate = -1.0 / (frame_rate * FADE_TIME_S)
    covariance = power * np.exp(np.abs(frames_near[:, None] - frames_near) * decay_rate)
    covariance += (noise + MIN_NOISE_M) ** 2 * np.eye(len(frames_near))
    cross_covariance = power * np.exp(np.abs(gap_frames[:, None] - frames_near) * decay_rate)
    return np.asarray(cross_covariance @ np.linalg.solve(covariance, errors_near))


def estimate_gap_error(prediction: PredictedMarker, gap: Flags) -> Array:
    """Return the expected error of a coordinate, meters, in each frame of the gaps, (n_gap,).

    `gap` has the shape (n_frames,).
    """
    n_frames = len(gap)
    frames = np.arange(n_frames)
    before = np.maximum.accumulate(np.where(gap, -n_frames, frames))
    after = np.minimum.accumulate(np.where(gap, 2 * n_frames, frames)[::-1])[::-1]
    depth = np.minimum(frames - before, after - frames)[gap]
    squared_error = (prediction.held_out_error**2).mean(axis=1)
    order = np.argsort(prediction.held_out_depth, kind="stable")
    parts = np.array_split(order, min(N_DEPTHS, len(order)))
    errors = [float(np.sqrt(squared_error[part].mean())) for part in parts]
    return np.interp(
        depth, [float(prediction.held_out_depth[part].mean()) for part in parts], errors
    )
