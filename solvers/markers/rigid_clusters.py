"""Find markers that keep their distances: those of the head, the pelvis, a foot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from ..motion import Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .distances import nan_median
from .rigid_fit import fit_rigidly

Array = NDArray[np.float64]
APART = 1.0
"""Metres or so: what is never seen together is no cluster."""
N_TEMPLATES = 4
SEEN = 0.2
"""Of all frames: markers seen together so often may be a cluster."""
ODDEST = (2.0, 50.0, 98.0)
WIDTH = 4.107
"""Standard deviations between the outer two of these percentiles of a normal distribution."""
NORMAL = 1.4826
"""Standard deviations in a median absolute deviation."""
MOVES = 0.01
"""Metres by which half of all distances between markers must vary, for clusters to be told."""


@dataclass(frozen=True, kw_only=True)
class ClusterSettings(Settings):
    """What counts as rigid."""

    slack: float = setting(
        0.003,
        "Distance variation allowed within a rigid cluster; higher makes larger clusters",
        unit="m", minimum=0.0005, maximum=0.05,
    )  # fmt: skip
    widest: float = setting(
        0.5, "Largest distance between markers of one cluster", unit="m", minimum=0.01,
        maximum=10.0, advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Cluster:
    """Markers that keep their distances."""

    names: tuple[str, ...]
    template: Array
    """Their places about their mean, shape (n_markers, 3), metres."""
    slack: float
    """Largest robust standard deviation of a distance between two of them, metres."""


def rigid_clusters(
    tracks: Tracks,
    *,
    settings: ClusterSettings = ClusterSettings(),
    progress: Progress = unwatched,
) -> tuple[Cluster, ...]:
    """Find clusters from how much the distances between markers vary over a take.

    Clusters are joined as long as no distance in them varies more than `slack` (complete
    linkage). A take in which hardly anything moves tells no clusters apart and has none.

    Parameters
    ----------
    tracks : Tracks
        Whose labels are right (`unswap_markers`).
    settings : ClusterSettings
    progress : Progress

    Returns
    -------
    tuple of Cluster
        Of two markers or more, in the order of the take.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    progress(0.0, "Looking for rigid clusters")
    usual, spread = _spreads(tracks.positions)
    clusters = [
        _cluster(tracks, members, usual, spread) for members in _groups(usual, spread, settings)
    ]
    progress(1.0, "Looking for rigid clusters")
    return tuple(clusters)


def _spreads(positions: Array) -> tuple[Array, Array]:
    """Return medians and standard deviations of all distances, (n_markers, n_markers), metres.

    The deviation is that of a normal distribution as wide as all but the oddest frames, less
    what is jitter: distances of jittering markers vary too. NaN where little is seen.
    """
    n_frames, n_markers, _ = positions.shape
    usual, spread = np.full((2, n_markers, n_markers), np.nan)
    for marker in range(n_markers):
        apart = np.linalg.norm(positions - positions[:, [marker]], axis=-1)
        enough = np.isfinite(apart).sum(axis=0) >= max(2.0, SEEN * n_frames)
        apart = apart[:, enough]
        if not apart.size:
            continue
        low, usual[marker, enough], high = np.nanpercentile(apart, ODDEST, axis=0)
        wide = (high - low) / WIDTH
        jitter = NORMAL * nan_median(np.abs(np.diff(apart, n=2, axis=0))) / np.sqrt(6.0)
        spread[marker, enough] = np.sqrt(np.maximum(wide**2 - np.nan_to_num(jitter) ** 2, 0.0))
    return usual, spread


def _groups(usual: Array, spread: Array, settings: ClusterSettings) -> list[list[int]]:
    """Return the members of each cluster."""
    above = spread[np.triu_indices(len(spread), 1)]
    above = above[np.isfinite(above)]
    if not len(above) or np.median(above) < MOVES:
        return []
    apart = np.where(usual <= settings.widest, np.nan_to_num(spread, nan=APART), APART)
    apart = np.round(apart, 6)  # Rounding must not choose between what is equal.
    np.fill_diagonal(apart, 0.0)
    tree = linkage(squareform(np.maximum(apart, apart.T), checks=False), "complete")
    labels = fcluster(tree, settings.slack, "distance")
    groups = [np.flatnonzero(labels == label).tolist() for label in np.unique(labels)]
    return sorted(group for group in groups if len(group) > 1)


def _cluster(tracks: Tracks, members: list[int], usual: Array, spread: Array) -> Cluster:
    """Return the cluster with the median of its shapes, fitted onto each other in turn."""
    places = tracks.positions[:, members]
    whole = places[np.isfinite(places).all(axis=(1, 2))]
    if len(whole) and len(members) > 2:
        template = whole[len(whole) // 2]
        for _ in range(N_TEMPLATES):
            template = template - template.mean(axis=0)
            turns, shifts = fit_rigidly(template, whole)
            template = nan_median(np.einsum("fji,fpj->fpi", turns, whole - shifts[:, None]))
    else:
        template = _from_distances(usual[np.ix_(members, members)])
    inside = spread[np.ix_(members, members)]
    names = tuple(tracks.names[member] for member in members)
    return Cluster(names, template - template.mean(axis=0), float(np.nanmax(inside)))


def _from_distances(usual: Array) -> Array:
    """Return a shape with given distances (classical scaling), for what no frame shows whole.

    Of two markers it is exact; its handedness is anyone's guess, so of more it is not asked.
    """
    n_points = len(usual)
    square = np.nan_to_num(usual) ** 2
    centre = np.eye(n_points) - 1.0 / n_points
    values, vectors = np.linalg.eigh(-0.5 * centre @ square @ centre)
    order = np.argsort(values)[::-1][:3]
    shape = np.zeros((n_points, 3))
    shape[:, : len(order)] = vectors[:, order] * np.sqrt(np.maximum(values[order], 0.0))
    return shape
