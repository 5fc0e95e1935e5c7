"""How far each optical marker can be trusted: the terms of [SHJT13] for optical systems."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import Tracks
from ...progress import Progress, unwatched
from .scores import Reliability
from .settings import USUAL, ReliabilitySettings
from .terms import behaviour_term, gaussian_mean, lengths_of

Array = NDArray[np.float64]

NEIGHBOURS = 5
"""Asked for their distance; the second worst answer counts, so that one may be wrong."""
MOST_FRAMES = 400
FEWEST = 5
"""Frames in which two markers must be seen together, for their distance to be known."""
NORMAL = 1.4826
"""Standard deviations in a median absolute deviation of a normal distribution."""
LEAST_SPREAD = 0.003
"""Metres: no distance is held to be steadier than that."""
USUAL_SPREADS, MOST_SPREADS = 4.0, 12.0
"""Standard deviations of a distance that are still right, and that leave no trust."""
ONE_CAMERA, ENOUGH_CAMERAS = 1.0, 4.0
"""One camera tells no place; more than four add little."""


def measure_marker_reliability(
    tracks: Tracks,
    n_cameras: NDArray[np.integer[Any]] | None = None,
    *,
    settings: ReliabilitySettings = USUAL,
    progress: Progress = unwatched,
) -> Reliability:
    """Measure how far each marker of an optical recording can be trusted.

    The behaviour term is that of joints. The kinematics term tells how far the distances to
    the neighbours that keep theirs best are off their medians over the take, in units of their
    usual spread; the second worst of five neighbours counts. The tracking term counts cameras:
    0 for one, 1 from four on. Combined is the least of them, averaged over the window, whatever
    the method: there were no known errors of markers to learn from.

    Parameters
    ----------
    tracks : Tracks
        NaN where not seen.
    n_cameras : integer array, shape (n_frames, n_markers), optional
        By how many cameras each marker was seen.
    settings : ReliabilitySettings
    progress : Progress

    Returns
    -------
    Reliability
        A marker that is NaN has 0 everywhere; one without neighbours has a kinematics term
        of 1.

    Raises
    ------
    InvalidMotionError
        The counts of cameras do not have one number for each marker and frame.
    SolveCancelled
        Raised by `progress`.
    """
    positions, visible = tracks.positions, tracks.visible
    tracking = _seen_by(n_cameras, visible.shape)
    behaviour = behaviour_term(positions, tracks.frame_rate, settings)
    progress(0.4, "Measuring reliability")
    kinematics = 1.0 - _off_their_neighbours(positions)
    behaviour, kinematics, tracking = (
        np.where(visible, term, 0.0) for term in (behaviour, kinematics, tracking)
    )
    least = np.minimum(np.minimum(behaviour, kinematics), tracking)
    combined = np.where(visible, gaussian_mean(least, tracks.frame_rate, settings), 0.0)
    progress(1.0, "Measuring reliability")
    return Reliability(combined, behaviour, kinematics, tracking)


def _seen_by(n_cameras: NDArray[np.integer[Any]] | None, shape: tuple[int, ...]) -> Array:
    if n_cameras is None:
        return np.ones(shape)
    counts = np.asarray(n_cameras, dtype=np.float64)
    if counts.shape != shape:
        raise InvalidMotionError(
            f"Counts of cameras need shape {shape}, not {counts.shape}: one for each frame and"
            " marker."
        )
    return np.clip((counts - ONE_CAMERA) / (ENOUGH_CAMERAS - ONE_CAMERA), 0.0, 1.0)


def _off_their_neighbours(positions: Array) -> Array:
    """Return 0 where distances to neighbours are as usual, 1 where they are far off."""
    usual, spread = _usual_distances(positions[:: max(1, len(positions) // MOST_FRAMES)])
    off = np.zeros(positions.shape[:2])
    for marker, spreads in enumerate(spread):
        steadiest = np.argsort(spreads)[:NEIGHBOURS]
        near = steadiest[np.isfinite(spreads[steadiest])]
        apart = lengths_of(positions[:, [marker]] - positions[:, near])
        odd = np.abs(apart - usual[marker, near]) / np.maximum(spreads[near], LEAST_SPREAD)
        off[:, marker] = _second_greatest(odd)
    return np.clip((off - USUAL_SPREADS) / (MOST_SPREADS - USUAL_SPREADS), 0.0, 1.0)


def _second_greatest(values: Array) -> Array:
    """Return the second greatest of each row that is known; 0 where nothing is."""
    ordered = np.sort(values, axis=-1)  # NaN last
    n_known = np.isfinite(values).sum(axis=-1)
    if not values.shape[-1]:
        return np.zeros(len(values))
    place = np.maximum(n_known - 2, 0)
    return np.nan_to_num(np.take_along_axis(ordered, place[:, None], axis=-1)[:, 0])


def _usual_distances(positions: Array) -> tuple[Array, Array]:
    """Return medians and robust standard deviations of distances, (n_markers, n_markers).

    NaN for a marker and itself, and for two that are hardly seen together.
    """
    n_markers = positions.shape[1]
    usual, spread = np.full((2, n_markers, n_markers), np.nan)
    for marker in range(n_markers):
        apart = lengths_of(positions - positions[:, [marker]])
        usual[marker] = _middle(apart.T)
        spread[marker] = NORMAL * _middle(np.abs(apart - usual[marker]).T)
        few = np.isfinite(apart).sum(axis=0) < min(FEWEST, len(positions))
        spread[marker, few] = np.nan
    np.fill_diagonal(spread, np.nan)
    return usual, spread


def _middle(values: Array) -> Array:
    """Return medians over the last axis of what is known; NaN where nothing is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of nothing but NaN
        return np.asarray(np.nanmedian(values, axis=-1))
