"""Tracks as channels: each point relative to its mean place in the frame of the body."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...motion import Tracks
from ...signals import interpolated
from .channels import CENTIMETRES, Channels
from .travel_path import Path, smooth_path, turned

Array = NDArray[np.float64]

N_FITS = 4
"""Times that the body's mean shape and its place in every frame are fitted in turn."""


def encode_tracks(tracks: Tracks, references: Mapping[str, Array] | None = None) -> Channels:
    """Tell every point, in centimetres, by its place in a frame that travels with the body.

    The frame is fitted to the mean shape of the points by turning about Z and moving over the
    ground, and smoothed: a walk in another direction or at another place has the same channels.

    Parameters
    ----------
    tracks : Tracks
    references : mapping of point name to array, shape (3,), optional
        Mean places to use where the name is known; elsewhere, the tracks' own.
    """
    references = references or {}
    path, shape = _fit_body(tracks, references)
    means = {
        name: np.asarray(references.get(name, place))[:3]
        for name, place in zip(tracks.names, shape, strict=True)
    }
    inside = _seen_from(tracks.positions, path)
    anchors = np.array([means[name] for name in tracks.names])
    values = CENTIMETRES * (inside - anchors)
    return Channels(tracks.names, values, np.arange(tracks.n_points), means, path)


def decode_tracks(tracks: Tracks, channels: Channels, values: Array) -> Tracks:
    """Return the tracks that have these channel values; undoes `encode_tracks`."""
    path = channels.path
    anchors = np.array([channels.references[key] for key in channels.keys])
    inside = values / CENTIMETRES + anchors
    positions = inside.copy()
    for point in range(inside.shape[1]):
        positions[:, point, :2] = turned(inside[:, point, :2], path.headings) + path.places
    return tracks.with_positions(positions)


def _fit_body(tracks: Tracks, references: Mapping[str, Array]) -> tuple[Path, Array]:
    """Fit mean shape (n_points, 3) and path to each other, starting without turning."""
    positions = tracks.positions
    filled = interpolated(positions.reshape(len(positions), -1)).reshape(positions.shape)
    known = np.array([name in references for name in tracks.names])
    given = np.array([references.get(name, np.zeros(3))[:3] for name in tracks.names])
    ever_seen = tracks.visible.any(axis=0)
    weights = np.where(tracks.visible, 1.0, 1e-6) * ever_seen
    if (known & ever_seen).sum() >= 2:
        weights = weights * known
        shape = given
    else:
        shape = _along_x(filled[0])
    places, headings = _rigid_fits(filled, shape, weights)
    for _ in range(N_FITS):
        inside = _seen_from(positions, Path(places, headings))
        middle = _medians(inside)
        if not (known & ever_seen).any():
            shape = middle
        places, headings = _rigid_fits(filled, shape, weights)
    path = smooth_path(places, headings, tracks.frame_rate)
    return path, _medians(_seen_from(positions, path))


def _along_x(points: Array) -> Array:
    """Centre points, shape (n_points, 3), over the origin, their main direction along X.

    So the axes of the channels, for each of which outliers are judged, are those of the body
    and not those of the room.
    """
    flat = points[:, 0] + 1j * points[:, 1]
    flat = flat - flat.mean()
    flat = flat * np.exp(-0.5j * np.angle((flat**2).sum()))
    return np.stack([flat.real, flat.imag, points[:, 2]], axis=-1)


def _rigid_fits(positions: Array, shape: Array, weights: Array) -> tuple[Array, Array]:
    """Lay the shape (n_points, 3) over every frame by turning about Z and moving."""
    total = weights.sum(axis=1, keepdims=True)
    total = np.where(total > 0.0, total, 1.0)
    flat, plan = positions[..., 0] + 1j * positions[..., 1], shape[:, 0] + 1j * shape[:, 1]
    centre = (weights * flat).sum(axis=1, keepdims=True) / total
    middle = (weights * plan).sum(axis=1, keepdims=True) / total
    agreement = (weights * (flat - centre) * np.conj(plan - middle)).sum(axis=1)
    headings = np.angle(agreement + 1e-12)
    places = centre[:, 0] - np.exp(1j * headings) * middle[:, 0]
    return np.stack([places.real, places.imag], axis=-1), headings


def _medians(inside: Array) -> Array:
    """Return the median place of each point; the middle of all where it is never seen."""
    seen = np.isfinite(inside).all(axis=2)
    places = [inside[seen[:, point], point] for point in range(inside.shape[1])]
    found = [np.median(place, axis=0) for place in places if len(place)]
    middle = np.mean(found, axis=0) if found else np.zeros(3)
    return np.array([np.median(place, axis=0) if len(place) else middle for place in places])


def _seen_from(positions: Array, path: Path) -> Array:
    inside = positions.copy()
    for point in range(positions.shape[1]):
        inside[:, point, :2] = turned(positions[:, point, :2] - path.places, -path.headings)
    return inside
