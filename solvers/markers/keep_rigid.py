"""Hold the markers of rigid clusters at their distances, and find lost ones among them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Tracks
from ..progress import Progress, unwatched
from .rigid_clusters import Cluster
from .rigid_fit import fit_rigidly, moved

Array = NDArray[np.float64]
OFF_LINE = 0.004
"""Metres, rms, that markers lie off the line through them, at least, to place a shape."""


@dataclass(frozen=True, eq=False)
class ConstrainedMarkers:
    """A take whose clusters are rigid."""

    tracks: Tracks
    filled: NDArray[np.bool_]
    """Where a lost marker was found from others, shape (n_frames, n_markers)."""
    moved: Array
    """How far each marker was moved, same shape, metres; 0 where it was not."""


def constrain_clusters(
    tracks: Tracks,
    clusters: Sequence[Cluster],
    *,
    progress: Progress = unwatched,
) -> ConstrainedMarkers:
    """Move the markers of each cluster onto the rigid shape that fits them best.

    Where three or more of a cluster are seen, all of them lie on the shape afterwards, the lost
    ones too. Of a pair, both move along their line. Otherwise nothing is changed. A marker that
    strays from a cluster of four or more hardly moves the others.

    Parameters
    ----------
    tracks : Tracks
    clusters : sequence of Cluster
        Of this take (`rigid_clusters`) or of another with the same markers on the same actor.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        A cluster has a marker that the take has not.
    SolveCancelled
        Raised by `progress`.
    """
    place = {name: index for index, name in enumerate(tracks.names)}
    lost = sorted({name for each in clusters for name in each.names if name not in place})
    if lost:
        raise InvalidMotionError(
            f"The take lacks markers of the clusters: {', '.join(lost)}. Find its own clusters."
        )
    positions = tracks.positions.copy()
    progress(0.0, "Keeping clusters rigid")
    for number, cluster in enumerate(clusters):
        members = [place[name] for name in cluster.names]
        positions[:, members] = _held(cluster.template, positions[:, members])
        progress((number + 1) / len(clusters), "Keeping clusters rigid")
    if not clusters:
        progress(1.0, "Keeping clusters rigid")
    filled = tracks.with_positions(positions).visible & ~tracks.visible
    step = np.nan_to_num(np.linalg.norm(positions - tracks.positions, axis=-1))
    return ConstrainedMarkers(tracks.with_positions(positions), filled, step)


def _held(template: Array, places: Array) -> Array:
    """Return the places of a cluster's markers on its shape, where enough are seen."""
    seen = np.isfinite(places).all(axis=-1)
    turns, shifts = fit_rigidly(template, places)
    shape = moved(template, turns, shifts)
    enough = _placed(template, seen)
    if len(template) == 2:
        enough = seen.all(axis=1)
    return np.where(enough[:, None, None], shape, places)


def _placed(template: Array, seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether the markers seen place the shape: three at least, and not on a line."""
    weights = seen[..., None] / np.maximum(seen.sum(axis=1), 1)[:, None, None]
    arms = template - (weights * template).sum(axis=1, keepdims=True)
    spread = np.einsum("fpk,fpi,fpj->fij", weights, arms, arms)
    thickness = np.sqrt(np.linalg.eigvalsh(spread)[:, 1].clip(min=0.0))
    return np.asarray(thickness > OFF_LINE)
