"""Constrain the markers of rigid clusters, and fill in missing ones."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Tracks
from ..progress import Progress, unwatched
from .rigid_clusters import Cluster
from .rigid_transform import MARKER_NOISE_M, fit_rigid_transform, transform_shape


@dataclass(frozen=True, eq=False)
class ConstrainedMarkers:
    """A take with rigid clusters."""

    tracks: Tracks
    filled: NDArray[np.bool_]
    """True where a missing marker was filled in, shape (n_frames, n_markers)."""
    moved: Array
    """Displacement of each marker, same shape, meters; 0 where unchanged."""


def constrain_clusters(
    tracks: Tracks,
    clusters: Sequence[Cluster],
    *,
    progress: Progress = unwatched,
) -> ConstrainedMarkers:
    """Move the markers of each cluster onto the rigid shape that fits them best.

    With three or more observed markers, all markers of the cluster are moved to the shape,
    including the missing ones. The two markers of a pair move along their line. Otherwise
    nothing changes. An outlier in a cluster of four or more hardly affects the others.

    Parameters
    ----------
    tracks : Tracks
    clusters : sequence of Cluster
        From this take (`find_rigid_clusters`) or another of the same markers and actor.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        A cluster has a marker that the take lacks.
    SolveCancelled
        Raised by `progress`.
    """
    index = {name: index for index, name in enumerate(tracks.names)}
    missing = sorted({name for each in clusters for name in each.names if name not in index})
    if missing:
        raise InvalidMotionError(
            f"The take lacks markers of the clusters: {', '.join(missing)}. Find its own"
            " clusters."
        )
    positions = tracks.positions.copy()
    progress(0.0, "Constraining rigid clusters")
    for number, cluster in enumerate(clusters):
        members = [index[name] for name in cluster.names]
        positions[:, members] = _fit_cluster(cluster.template, positions[:, members])
        progress((number + 1) / len(clusters), "Constraining rigid clusters")
    if not clusters:
        progress(1.0, "Constraining rigid clusters")
    filled = tracks.with_positions(positions).visible & ~tracks.visible
    step = np.nan_to_num(np.linalg.norm(positions - tracks.positions, axis=-1))
    return ConstrainedMarkers(tracks.with_positions(positions), filled, step)


def _fit_cluster(template: Array, positions: Array) -> Array:
    """Return the markers of a cluster on its fitted shape, where enough are observed."""
    observed = np.isfinite(positions).all(axis=-1)
    rotations, shifts = fit_rigid_transform(template, positions)
    shape = transform_shape(template, rotations, shifts)
    determined = _is_determined(template, observed)
    if len(template) == 2:
        determined = observed.all(axis=1)
    return np.where(determined[:, None, None], shape, positions)


def _is_determined(template: Array, observed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return whether the observed markers, three or more not on a line, fix the shape."""
    weights = observed[..., None] / np.maximum(observed.sum(axis=1), 1)[:, None, None]
    arms = template - (weights * template).sum(axis=1, keepdims=True)
    spread = np.einsum("fpk,fpi,fpj->fij", weights, arms, arms)
    thickness = np.sqrt(np.linalg.eigvalsh(spread)[:, 1].clip(min=0.0))
    return np.asarray(thickness > MARKER_NOISE_M)
