"""Optical markers of a real take: labels that are swapped, and rigid clusters."""

from typing import Any

import numpy as np

from solvers.arrays import Array
from solvers.markers import constrain_clusters, find_rigid_clusters, unswap_markers
from solvers.motion import Tracks
from solvers.recordings import read_c3d

from ...shared import clips
from ..takes import missed_or_false, point_error

MARKERS = 41
"""Of CMU 05_13; what follows them in the file is computed."""


def prepare() -> dict[str, Any]:
    """Swap labels of a take, and add noise to it."""
    clean = _clean()
    return {"swaps": _swaps(clean), "rigid": _shaken(clean)}


def measure(
    swaps: dict[str, tuple[Tracks, Tracks]], rigid: tuple[Tracks, Tracks]
) -> dict[str, float]:
    """Samples still wrong, and noise that the clusters leave."""
    figures = {}
    for name, (given, truth) in swaps.items():
        result = unswap_markers(given).tracks.positions
        changed = _differ(result, given.positions)
        wrong = _differ(truth.positions, given.positions)
        figures[f"{name}: missed or false %"] = 1.0 + missed_or_false(changed, wrong)
    clean, noisy = rigid
    clusters = find_rigid_clusters(noisy)
    kept = constrain_clusters(noisy, clusters).tracks.positions
    figures["rigid: mm"] = point_error(kept, clean.positions)
    figures["rigid: markers in clusters"] = float(sum(len(each.names) for each in clusters))
    return figures


def _clean() -> Tracks:
    tracks = read_c3d(clips.DATA / "mocap" / "05_13.c3d").slice(200, 440)
    observed = np.flatnonzero(tracks.visible[:, :MARKERS].all(axis=0))
    names = tuple(tracks.names[point] for point in observed)
    return Tracks(names, tracks.positions[:, observed], tracks.frame_rate)


def _swaps(clean: Tracks) -> dict[str, tuple[Tracks, Tracks]]:
    """Exchange pairs of near markers, at 60 Hz, and at 30 Hz with gaps and noise."""
    slow = Tracks(clean.names, clean.positions[::4].copy(), clean.frame_rate / 4)
    fast = Tracks(clean.names, clean.positions[::2].copy(), clean.frame_rate / 2)
    rng = np.random.default_rng(3)
    for marker in range(slow.n_points):
        first = int(rng.integers(0, slow.n_frames - 12))
        slow.positions[first : first + int(rng.integers(3, 12)), marker] = np.nan
    slow.positions[:] += rng.normal(scale=0.001, size=slow.positions.shape)
    return {
        "swaps 60 Hz": (_swapped(fast, 12, 4), fast),
        "swaps 30 Hz, gaps": (_swapped(slow, 12, 5), slow),
    }


def _swapped(tracks: Tracks, n_swaps: int, seed: int) -> Tracks:
    rng = np.random.default_rng(seed)
    positions = tracks.positions.copy()
    for number, length in enumerate(np.geomspace(0.04, 1.2, n_swaps)):
        first = int(rng.integers(tracks.n_points))
        distance = np.linalg.norm(tracks.positions - tracks.positions[:, [first]], axis=-1)
        near = np.argsort(np.nanmean(distance, axis=0))[1:5]
        pair = [first, int(rng.choice(near))]
        last = max(1, round(length * tracks.frame_rate))
        start = int(rng.integers(1, tracks.n_frames - last - 1))
        stop = tracks.n_frames if number == n_swaps - 1 else start + last
        positions[start:stop, pair] = positions[start:stop, pair[::-1]]
    return tracks.with_positions(positions)


def _shaken(clean: Tracks) -> tuple[Tracks, Tracks]:
    noise = np.random.default_rng(6).normal(scale=0.003, size=clean.positions.shape)
    positions = clean.positions + noise
    positions[100:160, clean.names.index("LFHD")] = np.nan
    return clean, clean.with_positions(positions)


def _differ(a: Array, b: Array) -> np.ndarray:
    return np.asarray((np.nan_to_num(a) != np.nan_to_num(b)).any(axis=-1))
