"""Where a take's mean pose lies, told by the take itself and by the examples like it.

How people hold themselves differs more from clip to clip than a pose varies within one (on
walks, by 11 degrees at the arms against 4). So the mean pose of a take is a hidden quantity of
its own: its prior is a Gaussian process over the examples' mean poses, which knows the person
again if the examples hold clips of them, and says that it does not know where they do not.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

KERNEL_WIDTH = 4.0
"""Root mean square difference of two mean poses, degrees or centimetres per channel, over which
one tells of the other."""
CLIP_VARIANCE_FRACTION = 0.1
"""Variance that two clips of one person in one mood still have, as a share of all clips'."""
CORRELATION_FRAMES = 10.0
"""Frames of the examples' patterns after which a pose tells something new of the mean pose."""
MAX_NEIGHBORS = 300
"""Clips, nearest first, that tell of the mean pose: others are too unlike to say anything."""
MIN_VARIANCE = 1e-3
"""Variance below which no mean is known, square degrees or centimetres."""
DEFAULT_DEVIATION = 8.0
"""Standard deviation of mean poses, degrees or centimetres, which few examples cannot tell."""
VARIANCE_INFLATION = 2.0
"""Of the variance over the examples' mean poses, that a stranger's is expected to have."""


def estimate_mean_pose(
    means: Array, own: Array, n_observed: Array, n_frames: float, variance: Array, noise: Array
) -> tuple[Array, Array]:
    """Return the mean pose of a take and its variance, both of shape (n_channels,).

    Parameters
    ----------
    means : shape (n_clips, n_channels)
        Mean poses of the examples.
    own : shape (n_channels,)
        Mean over the frames of the take in which the channel is observed.
    n_seen : shape (n_channels,)
        Number of these frames.
    n_frames : float
        Of the whole take.
    variance : shape (n_channels,)
        Of a channel about its clip's mean.
    noise : shape (n_channels,)
        Variance of what is added to each observation.
    """
    predicted, prior_variance = _predict_mean_pose(means, own, n_observed > 0.5 * n_frames)
    inverse_count = 1.0 / np.maximum(n_observed, 1e-9)
    own_variance = (
        variance * CORRELATION_FRAMES * (inverse_count - 1.0 / n_frames)
        + noise * inverse_count
        + MIN_VARIANCE
    )
    own_fraction = prior_variance / (prior_variance + own_variance)
    return predicted + own_fraction * np.where(
        n_observed > 0, own - predicted, 0.0
    ), own_fraction * own_variance


def _predict_mean_pose(
    means: Array, own: Array, observed: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Return mean and variance that the examples' mean poses foretell from what is seen."""
    overall_mean = means.mean(axis=0)
    n_distinct = len(np.unique(np.round(means), axis=0))
    prior_variance = (
        VARIANCE_INFLATION
        * np.maximum(means.var(axis=0), (DEFAULT_DEVIATION / n_distinct) ** 2)
        + MIN_VARIANCE
    )
    if not observed.any():
        return overall_mean, prior_variance
    distances = _squared_distances(means[:, observed], own[None, observed])[:, 0]
    nearest = np.argsort(distances, kind="stable")[:MAX_NEIGHBORS]
    nearest_means = means[nearest]
    kernel = _kernel(_squared_distances(nearest_means[:, observed], nearest_means[:, observed]))
    similarity = _kernel(distances[nearest])
    weights = np.linalg.solve(
        kernel + CLIP_VARIANCE_FRACTION * np.eye(len(nearest_means)), similarity
    )
    remaining_fraction = 1.0 + CLIP_VARIANCE_FRACTION - float(weights @ similarity)
    return overall_mean + weights @ (
        nearest_means - overall_mean
    ), prior_variance * remaining_fraction


def _squared_distances(poses: Array, other_poses: Array) -> Array:
    """Return the mean square difference per channel of each of some poses to each of others."""
    squared = (
        (poses**2).sum(axis=1)[:, None]
        + (other_poses**2).sum(axis=1)
        - 2.0 * poses @ other_poses.T
    )
    return np.asarray(np.maximum(squared, 0.0) / poses.shape[1])


def _kernel(distances: Array) -> Array:
    """Return how much poses tell of each other, 0 to 1."""
    return np.asarray(np.exp(-0.5 * distances / KERNEL_WIDTH**2))
