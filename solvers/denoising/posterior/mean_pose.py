"""Where a take's mean pose lies, told by the take itself and by the examples like it.

How people hold themselves differs more from clip to clip than a pose varies within one (on
walks, by 11 degrees at the arms against 4). So the mean pose of a take is a hidden quantity of
its own: its prior is a Gaussian process over the examples' mean poses, which knows the person
again if the examples hold clips of them, and says that it does not know where they do not.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LIKENESS = 4.0
"""Root mean square difference of two mean poses, degrees or centimetres per channel, over which
one tells of the other."""
UNLIKE = 0.1
"""Variance that two clips of one person in one mood still have, as a share of all clips'."""
MEMORY = 10.0
"""Frames of the examples' patterns after which a pose tells something new of the mean pose."""
MOST = 300
"""Clips, nearest first, that tell of the mean pose: others are too unlike to say anything."""
SMALLEST = 1e-3
"""Variance below which no mean is known, square degrees or centimetres."""
USUAL = 8.0
"""Standard deviation of mean poses, degrees or centimetres, which few examples cannot tell."""
WIDEST = 2.0
"""Of the variance over the examples' mean poses, that a stranger's is expected to have."""


def take_offset(
    means: Array, own: Array, n_seen: Array, n_frames: float, variance: Array, noise: Array
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
    expected, spread = _foretold(means, own, n_seen > 0.5 * n_frames)
    share_seen = 1.0 / np.maximum(n_seen, 1e-9)
    of_own = variance * MEMORY * (share_seen - 1.0 / n_frames) + noise * share_seen + SMALLEST
    share = spread / (spread + of_own)
    return expected + share * np.where(n_seen > 0, own - expected, 0.0), share * of_own


def _foretold(means: Array, own: Array, seen: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return mean and variance that the examples' mean poses foretell from what is seen."""
    middle = means.mean(axis=0)
    n_distinct = len(np.unique(np.round(means), axis=0))
    spread = WIDEST * np.maximum(means.var(axis=0), (USUAL / n_distinct) ** 2) + SMALLEST
    if not seen.any():
        return middle, spread
    apart = _apart(means[:, seen], own[None, seen])[:, 0]
    nearest = np.argsort(apart, kind="stable")[:MOST]
    near = means[nearest]
    kernel = _alike(_apart(near[:, seen], near[:, seen]))
    towards = _alike(apart[nearest])
    weights = np.linalg.solve(kernel + UNLIKE * np.eye(len(near)), towards)
    unknown = 1.0 + UNLIKE - float(weights @ towards)
    return middle + weights @ (near - middle), spread * unknown


def _apart(some: Array, others: Array) -> Array:
    """Return the mean square difference per channel of each of some poses to each of others."""
    square = (some**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2.0 * some @ others.T
    return np.asarray(np.maximum(square, 0.0) / some.shape[1])


def _alike(apart: Array) -> Array:
    """Return how much poses tell of each other, 0 to 1."""
    return np.asarray(np.exp(-0.5 * apart / LIKENESS**2))
