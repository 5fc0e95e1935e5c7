"""Convert tracks to channels: each point relative to its mean position in the body's frame."""

from collections.abc import Mapping

import numpy as np

from ...arrays import Array
from ...motion import Tracks
from ...signals import fill_channel_gaps
from .channels import CENTIMETERS, Channels
from .travel_path import TravelPath, fit_travel_path, rotate_on_ground


def encode_tracks(tracks: Tracks, references: Mapping[str, Array] | None = None) -> Channels:
    """Encode every point by its position, in centimeters, in a frame that follows the body.

    The frame is fitted to the mean shape of the points by a rotation about Z and a translation
    over the ground, then smoothed. A walk in another direction or elsewhere therefore has the
    same channels.

    Parameters
    ----------
    tracks : Tracks
    references : mapping of point name to array, shape (3,), optional
        Mean positions of known names; other points use the tracks' own.
    """
    references = references or {}
    path, shape = _fit_shape_and_path(tracks, references)
    means = {
        name: np.asarray(references.get(name, mean_position))[:3]
        for name, mean_position in zip(tracks.names, shape, strict=True)
    }
    local = _to_path_frame(tracks.positions, path)
    mean_positions = np.array([means[name] for name in tracks.names])
    values = CENTIMETERS * (local - mean_positions)
    return Channels(tracks.names, values, np.arange(tracks.n_points), means, path)


def decode_tracks(tracks: Tracks, channels: Channels, values: Array) -> Tracks:
    """Return tracks of channel values (n_frames, n_points, 3); inverts `encode_tracks`."""
    path = channels.path
    mean_positions = np.array([channels.references[key] for key in channels.keys])
    local = values / CENTIMETERS + mean_positions
    positions = local.copy()
    for point in range(local.shape[1]):
        positions[:, point, :2] = (
            rotate_on_ground(local[:, point, :2], path.headings) + path.ground_positions
        )
    return tracks.with_positions(positions)


def _fit_shape_and_path(
    tracks: Tracks, references: Mapping[str, Array]
) -> tuple[TravelPath, Array]:
    """Fit mean shape (n_points, 3) and path to each other, starting without a rotation."""
    positions = tracks.positions
    filled = fill_channel_gaps(positions.reshape(len(positions), -1)).reshape(positions.shape)
    has_reference = np.array([name in references for name in tracks.names])
    given_means = np.array([references.get(name, np.zeros(3))[:3] for name in tracks.names])
    ever_observed = tracks.visible.any(axis=0)
    weights = np.where(tracks.visible, 1.0, 1e-6) * ever_observed
    if (has_reference & ever_observed).sum() >= 2:
        weights = weights * has_reference
        shape = given_means
    else:
        shape = _align_with_x(filled[0])
    ground_positions, headings = _fit_shape(filled, shape, weights)
    if not (has_reference & ever_observed).any():
        local = _to_path_frame(positions, TravelPath(ground_positions, headings))
        ground_positions, headings = _fit_shape(filled, _median_positions(local), weights)
    path = fit_travel_path(ground_positions, headings, tracks.frame_rate)
    return path, _median_positions(_to_path_frame(positions, path))


def _align_with_x(points: Array) -> Array:
    """Center points, shape (n_points, 3), over the origin, with their main direction along X.

    Outliers are classified per axis, so the axes must be those of the body, not of the room.
    """
    flat = points[:, 0] + 1j * points[:, 1]
    flat = flat - flat.mean()
    flat = flat * np.exp(-0.5j * np.angle((flat**2).sum()))
    return np.stack([flat.real, flat.imag, points[:, 2]], axis=-1)


def _fit_shape(positions: Array, shape: Array, weights: Array) -> tuple[Array, Array]:
    """Fit the shape to every frame by a rotation about Z and a translation over the ground."""
    total = weights.sum(axis=1, keepdims=True)
    total = np.where(total > 0.0, total, 1.0)
    flat, plan = positions[..., 0] + 1j * positions[..., 1], shape[:, 0] + 1j * shape[:, 1]
    center = (weights * flat).sum(axis=1, keepdims=True) / total
    medians = (weights * plan).sum(axis=1, keepdims=True) / total
    agreement = (weights * (flat - center) * np.conj(plan - medians)).sum(axis=1)
    headings = np.angle(agreement + 1e-12)
    ground_positions = center[:, 0] - np.exp(1j * headings) * medians[:, 0]
    return np.stack([ground_positions.real, ground_positions.imag], axis=-1), headings


def _median_positions(local: Array) -> Array:
    """Return the median position of each point; the mean of all if it is never observed."""
    observed = np.isfinite(local).all(axis=2)
    samples = [local[observed[:, point], point] for point in range(local.shape[1])]
    known_medians = [np.median(sample, axis=0) for sample in samples if len(sample)]
    medians = np.mean(known_medians, axis=0) if known_medians else np.zeros(3)
    return np.array([
        np.median(sample, axis=0) if len(sample) else medians for sample in samples
    ])


def _to_path_frame(positions: Array, path: TravelPath) -> Array:
    local = positions.copy()
    for point in range(positions.shape[1]):
        local[:, point, :2] = rotate_on_ground(
            positions[:, point, :2] - path.ground_positions, -path.headings
        )
    return local
