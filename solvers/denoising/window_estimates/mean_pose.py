"""Estimate the mean pose of a take from the take itself and from similar examples.

Posture differs more from clip to clip than a pose varies within one (on walks, by 11 degrees at
the arms against 4). The mean pose of a take is therefore a hidden quantity of its own. Its
prior is a Gaussian process over the examples' mean poses. It recognizes an actor whose clips
are among the examples, and is uncertain for other actors.
"""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..averaging import MIN_NOISE

KERNEL_WIDTH = 4.0
"""Root mean square difference of two mean poses, degrees or centimeters per channel, at which
their correlation falls to exp(-1/2): clips of unlike poses do not count. Sweep: x10 costs 0.1
%, x1000 costs 0.2 %."""
CLIP_VARIANCE_FRACTION = 0.1
"""Variance between clips of one actor in one mood, relative to that between all clips. It
guards against examples that are copies, which make the matrix singular."""
CORRELATION_FRAMES = 10.0
"""Frames of the examples' patterns after which a pose is independent evidence of the mean. Half
and twice gain less than 1 % (`make sensitivity`)."""
MAX_NEIGHBORS = 300
"""Clips, nearest first, that predict the mean pose: others are too different to matter. It
bounds the run time of large libraries."""
DEFAULT_DEVIATION = 8.0
"""Standard deviation of mean poses, degrees or centimeters, if there are too few examples.
It guards a single example, which would make an actor's posture seem certain."""
VARIANCE_INFLATION = 2.0
"""Expected variance of an unknown actor's mean pose, relative to that of the examples. It
guards actors unlike all examples, whose posture would be pulled to that of the examples."""


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
    n_observed : shape (n_channels,)
        Number of these frames.
    n_frames : float
        Of the complete take.
    variance : shape (n_channels,)
        Of a channel about its clip's mean.
    noise : shape (n_channels,)
        Variance of the noise of each observation.
    """
    predicted, prior_variance = _predict_mean_pose(means, own, n_observed > 0.5 * n_frames)
    inverse_count = 1.0 / np.maximum(n_observed, 1e-9)
    own_variance = (
        variance * CORRELATION_FRAMES * (inverse_count - 1.0 / n_frames)
        + noise * inverse_count
        + MIN_NOISE**2
    )
    own_fraction = prior_variance / (prior_variance + own_variance)
    return predicted + own_fraction * np.where(
        n_observed > 0, own - predicted, 0.0
    ), own_fraction * own_variance


def _predict_mean_pose(
    means: Array, own: Array, observed: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Return mean and variance of the prediction from the examples' mean poses."""
    overall_mean = means.mean(axis=0)
    n_distinct = len(np.unique(np.round(means), axis=0))
    prior_variance = (
        VARIANCE_INFLATION
        * np.maximum(means.var(axis=0), (DEFAULT_DEVIATION / n_distinct) ** 2)
        + MIN_NOISE**2
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
    """Return the mean squared difference per channel between all pairs of poses."""
    squared = (
        (poses**2).sum(axis=1)[:, None]
        + (other_poses**2).sum(axis=1)
        - 2.0 * poses @ other_poses.T
    )
    return np.asarray(np.maximum(squared, 0.0) / poses.shape[1])


def _kernel(distances: Array) -> Array:
    """Return the correlation of poses at these squared distances, 0 to 1."""
    return np.asarray(np.exp(-0.5 * distances / KERNEL_WIDTH**2))
