"""Find rigid clusters of markers, such as those of the head, the pelvis or a foot."""

from dataclasses import dataclass

import numpy as np
import scipy

from ..arrays import Array
from ..motion import Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from ..signals import MAD_TO_SIGMA
from .distances import MIN_OBSERVED_FRACTION
from .rigid_transform import fit_rigid_transform
from .vectors import nan_median

UNLINKED_M = 1.0
"""Linkage distance of pairs that are never observed together. It guards such pairs from sharing
a cluster: it is farther than any cluster is wide."""
SPREAD_PERCENTILES = (2.0, 50.0, 98.0)
"""Percentiles of a distance that measure its spread. The outer two bound two standard
deviations, by definition."""
PERCENTILES_TO_SIGMA = 4.107
"""Standard deviations between the outer two of these percentiles of a normal distribution. By
definition."""
MIN_TAKE_SPREAD_M = 0.01
"""Minimum median spread of all distances in a take for clusters to be detectable. It guards an
actor who stands still, who would be one cluster."""


@dataclass(frozen=True, kw_only=True)
class ClusterSettings(Settings):
    """Thresholds of rigidity."""

    slack: float = setting(
        0.003,
        "Distance variation allowed within a rigid cluster; higher makes larger clusters",
        unit="m", minimum=0.0005, maximum=0.05,
    )  # fmt: skip
    max_distance: float = setting(
        0.5, "Largest distance between markers of one cluster", unit="m", minimum=0.01,
        maximum=10.0, advanced=True, former="widest",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Cluster:
    """Markers with constant distances."""

    names: tuple[str, ...]
    template: Array
    """Positions relative to their mean, shape (n_markers, 3), meters."""
    slack: float
    """Largest robust standard deviation of a distance between two of them, meters."""


def find_rigid_clusters(
    tracks: Tracks,
    *,
    settings: ClusterSettings = ClusterSettings(),
    progress: Progress = unwatched,
) -> tuple[Cluster, ...]:
    """Find clusters by the spread of the distances between markers over a take.

    Clusters are joined as long as no distance in them varies more than `slack` (complete
    linkage). A take with little motion has no detectable clusters.

    Parameters
    ----------
    tracks : Tracks
        With correct labels (`unswap_markers`).
    settings : ClusterSettings
    progress : Progress

    Returns
    -------
    tuple of Cluster
        Clusters of two or more markers, in the order of the take.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    progress(0.0, "Finding rigid clusters")
    median, spread = _spreads(tracks.positions)
    clusters = [
        _cluster(tracks, members, median, spread)
        for members in _groups(median, spread, settings)
    ]
    progress(1.0, "Finding rigid clusters")
    return tuple(clusters)


def _spreads(positions: Array) -> tuple[Array, Array]:
    """Return medians and standard deviations of all distances, (n_markers, n_markers), meters.

    The deviation is estimated from percentiles, as for a normal distribution, and jitter is
    subtracted. NaN for rarely observed pairs.
    """
    n_frames, n_markers, _ = positions.shape
    median, spread = np.full((2, n_markers, n_markers), np.nan)
    for marker in range(n_markers):
        distances = np.linalg.norm(positions - positions[:, [marker]], axis=-1)
        enough = np.isfinite(distances).sum(axis=0) >= max(
            2.0, MIN_OBSERVED_FRACTION * n_frames
        )
        distances = distances[:, enough]
        if not distances.size:
            continue
        low, median[marker, enough], high = np.nanpercentile(
            distances, SPREAD_PERCENTILES, axis=0
        )
        total = (high - low) / PERCENTILES_TO_SIGMA
        jitter = (
            MAD_TO_SIGMA * nan_median(np.abs(np.diff(distances, n=2, axis=0))) / np.sqrt(6.0)
        )
        spread[marker, enough] = np.sqrt(np.maximum(total**2 - np.nan_to_num(jitter) ** 2, 0.0))
    return median, spread


def _groups(median: Array, spread: Array, settings: ClusterSettings) -> list[list[int]]:
    """Return the members of each cluster."""
    pairwise = spread[np.triu_indices(len(spread), 1)]
    pairwise = pairwise[np.isfinite(pairwise)]
    if not len(pairwise) or np.median(pairwise) < MIN_TAKE_SPREAD_M:
        return []
    distances = np.where(
        median <= settings.max_distance, np.nan_to_num(spread, nan=UNLINKED_M), UNLINKED_M
    )
    distances = np.round(distances, 6)  # Rounding errors must not decide between ties.
    np.fill_diagonal(distances, 0.0)
    tree = scipy.cluster.hierarchy.linkage(
        scipy.spatial.distance.squareform(np.maximum(distances, distances.T), checks=False),
        "complete",
    )
    labels = scipy.cluster.hierarchy.fcluster(tree, settings.slack, "distance")
    groups = [np.flatnonzero(labels == label).tolist() for label in np.unique(labels)]
    return sorted(group for group in groups if len(group) > 1)


def _cluster(tracks: Tracks, members: list[int], median: Array, spread: Array) -> Cluster:
    """Return the cluster with its median shape, of all frames fitted to the middle one."""
    positions = tracks.positions[:, members]
    complete = positions[np.isfinite(positions).all(axis=(1, 2))]
    if len(complete) and len(members) > 2:
        middle = complete[len(complete) // 2]
        rotations, translations = fit_rigid_transform(middle - middle.mean(axis=0), complete)
        template = nan_median(
            np.einsum("fji,fpj->fpi", rotations, complete - translations[:, None])
        )
    else:
        template = _from_distances(median[np.ix_(members, members)])
    inside = spread[np.ix_(members, members)]
    names = tuple(tracks.names[member] for member in members)
    return Cluster(names, template - template.mean(axis=0), float(np.nanmax(inside)))


def _from_distances(median: Array) -> Array:
    """Return a shape with given distances (classical scaling), if no frame shows all markers.

    It is exact for two markers. For more, its handedness is arbitrary.
    """
    n_points = len(median)
    square = np.nan_to_num(median) ** 2
    center = np.eye(n_points) - 1.0 / n_points
    values, vectors = np.linalg.eigh(-0.5 * center @ square @ center)
    order = np.argsort(values)[::-1][:3]
    shape = np.zeros((n_points, 3))
    shape[:, : len(order)] = vectors[:, order] * np.sqrt(np.maximum(values[order], 0.0))
    return shape
