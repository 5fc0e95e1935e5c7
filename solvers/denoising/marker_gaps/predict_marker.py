"""Predict a missing marker from reference markers: Gaussian processes over pose and time."""

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array
from .blend_estimates import MIN_SQUARED_ERROR, blend_weights
from .reference_markers import MIN_DEVIATION_M, ReferenceMarkers, fit_rigid_frames

VARIANTS = ((3, 8), (3, 16), (8, 24), (3, 5), (5, 12))
"""Numbers of reference markers that span the frame, and that describe the pose. Half and twice
are no better (`make sensitivity`)."""


class FrameKernel(NamedTuple):
    """Covariance of two frames; variances are relative to that of the marker in its frame."""

    linear_variance: float
    pose_variance: float
    pose_length_scale: float
    """Of similar poses, relative to the root mean square size of the poses."""
    time_variance: float
    time_scale: float
    """Seconds over which the part that depends on time alone is correlated."""
    noise_variance: float


KERNELS = (
    FrameKernel(1.0, 0.0, 1.0, 0.01, 0.3, 1e-3),
    FrameKernel(1.0, 0.3, 1.0, 0.01, 0.3, 1e-2),
    FrameKernel(1.0, 0.3, 0.5, 0.01, 0.1, 3e-2),
    FrameKernel(0.05, 0.02, 1.0, 0.02, 0.1, 1e-2),
    FrameKernel(1.0, 1.0, 2.0, 0.1, 0.03, 1e-4),
    FrameKernel(1.0, 1.0, 2.0, 0.1, 0.1, 1e-4),
)
"""Kernels whose predictions are blended, with units in `FrameKernel`. Chosen by hand, mostly a
factor of 2 to 10 apart: the blend weighs each by its errors on the take itself."""


class PredictedMarker(NamedTuple):
    """A predicted marker, meters."""

    positions: Array
    """Shape (n_frames, 3), training frames first, then those of the gap."""
    held_out_error: Array
    """Error of training frames, held out in blocks as long as the gap, shape (n_training,
    3)."""
    held_out_depth: Array
    """Frames from each of these to the nearest end of its block, shape (n_training,)."""


class RegressionProblem(NamedTuple):
    """One choice of frame and pose, for any kernel."""

    targets: Array
    """The marker in the frame, relative to its mean, shape (n_training, 3)."""
    mean: Array
    rotations: Array
    origins: Array
    products: Array
    """Of all poses with all training poses, shape (n_frames, n_training)."""
    squared_distances: Array
    time_differences: Array


def predict_marker(
    positions: Array, point: int, references: ReferenceMarkers, frame_rate: float, length: int
) -> PredictedMarker:
    """Average the predictions of several frames and kernels, weighted by held-out errors.

    In a frame that travels with its reference markers, a marker is a smooth function of their
    pose (linear, and similar for similar poses) and of time. The average of such estimates
    follows Tits, Tilmanne and Dutoit [1]_. Their weights come from the errors of held-out
    blocks. These errors are exact without another solve: K_BB^-1 (K^-1 y)_B, from the block of
    the inverse [2]_.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), meters
    point : int
    references : ReferenceMarkers
        All of their `training_frames` and `gap_frames` are used.
    frame_rate : float, hertz
    length : int
        Frames of the gap.

    References
    ----------
    .. [1] Tits, Tilmanne, Dutoit (2018). Robust and automatic motion-capture data recovery
       using soft skeleton constraints and model averaging. doi:10.1371/journal.pone.0199744
    .. [2] Rasmussen, Williams (2006). Gaussian Processes for Machine Learning, 5.4.2.
    """
    rows = np.concatenate([references.training_frames, references.gap_frames])
    poses = positions[np.ix_(rows, references.points)]
    truth = positions[references.training_frames, point]
    blocks, held_out_depth = _split_into_blocks(references.training_frames, length)
    estimates, errors = [], []
    for n_frame, n_pose in _variants(len(references.points)):
        weights = 1.0 / (references.deviation**2 + MIN_DEVIATION_M**2)
        problem = _build_problem(
            poses[:, :n_pose], truth, weights[:n_pose], n_frame, rows / frame_rate
        )
        for kernel in KERNELS:
            local, error = _solve(problem, kernel, blocks)
            rotated = np.einsum("fij,fj->fi", problem.rotations, local + problem.mean)
            estimates.append(rotated + problem.origins)
            errors.append(np.einsum("fij,fj->fi", problem.rotations[: len(error)], error))
    weights = blend_weights(errors)
    predicted = np.tensordot(weights, estimates, 1)
    return PredictedMarker(predicted, np.tensordot(weights, errors, 1), held_out_depth)


def _variants(n_references: int) -> list[tuple[int, int]]:
    """Return the distinct variants for this number of reference markers."""
    possible = [
        (min(n_frame, n_references), min(n_pose, n_references)) for n_frame, n_pose in VARIANTS
    ]
    return list(dict.fromkeys(possible))


def _build_problem(
    positions: Array, truth: Array, weights: Array, n_frame: int, time_scale: Array
) -> RegressionProblem:
    n_learned = len(truth)
    rotations, origins = fit_rigid_frames(positions[:, :n_frame], weights[:n_frame])
    local = np.einsum("fij,fi->fj", rotations[:n_learned], truth - origins[:n_learned])
    pose = np.einsum("fij,fpi->fpj", rotations, positions - origins[:, None])
    pose -= pose[:n_learned].mean(axis=0)
    pose = (pose * np.sqrt(weights)[:, None]).reshape(len(pose), -1)
    pose /= np.sqrt((pose[:n_learned] ** 2).sum(axis=1).mean() + MIN_SQUARED_ERROR)
    products = pose @ pose[:n_learned].T
    sizes = (pose**2).sum(axis=1)
    squares = np.maximum(sizes[:, None] + sizes[:n_learned] - 2.0 * products, 0.0)
    mean = local.mean(axis=0)
    time_distances = np.abs(time_scale[:, None] - time_scale[:n_learned])
    return RegressionProblem(
        local - mean, mean, rotations, origins, products, squares, time_distances
    )


def _solve(
    problem: RegressionProblem, kernel: FrameKernel, blocks: list[NDArray[np.intp]]
) -> tuple[Array, Array]:
    """Return the prediction in all frames, and the errors of held-out blocks."""
    targets, n_learned = problem.targets, len(problem.targets)
    covariance = kernel.linear_variance * problem.products
    if kernel.pose_variance:
        covariance += kernel.pose_variance * np.exp(
            problem.squared_distances / (-2.0 * kernel.pose_length_scale**2)
        )
    covariance += kernel.time_variance * matern(problem.time_differences / kernel.time_scale)
    noise_variance = kernel.noise_variance + MIN_SQUARED_ERROR / (
        (targets**2).mean() + MIN_SQUARED_ERROR
    )
    inverse = _inverse(covariance[:n_learned] + noise_variance * np.eye(n_learned))
    gain = inverse @ targets
    error = np.zeros_like(targets)
    for block in blocks:
        error[block] = np.linalg.solve(inverse[np.ix_(block, block)], gain[block])
    return covariance @ gain, error


def matern(steps: Array) -> Array:
    """Return the Matern covariance of smoothness 5/2 at these distances, of any shape.

    They are relative to the length of the kernel, and contain the factor sqrt(5).
    """
    return np.asarray((1.0 + steps + steps**2 / 3.0) * np.exp(-steps))


def _inverse(matrix: Array) -> Array:
    lower, _ = scipy.linalg.lapack.dpotrf(matrix, lower=1, clean=1, overwrite_a=1)
    inverse = scipy.linalg.lapack.dpotri(lower, lower=1, overwrite_c=1)[0]
    return np.asarray(inverse + np.tril(inverse, -1).T)


def _split_into_blocks(
    frames: NDArray[np.intp], length: int
) -> tuple[list[NDArray[np.intp]], Array]:
    """Split training frames into blocks of the gap's length, at least two of them."""
    length = max(min(length, (int(np.ptp(frames)) + 1) // 2), 1)
    number, offset = np.divmod(frames - frames[0], length)
    held_out_depth = np.minimum(offset + 1, length - offset)
    return [
        np.flatnonzero(number == each) for each in np.unique(number)
    ], held_out_depth.astype(float)
