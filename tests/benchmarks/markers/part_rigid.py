"""Rigid clusters of real takes: effect of the constraint on noise and on missing markers."""

import numpy as np

from solvers.arrays import Array
from solvers.markers import constrain_clusters, find_rigid_clusters
from solvers.recordings import read_c3d

from ..shared import clips
from ..shared.noise import seeded
from ..shared.tables import table
from .part_markers import TAKES, without_copies

NOISE = (0.0, 0.001, 0.003)
GAP_S = 2.0


def compare_rigid() -> str:
    """Return a table: rms distance to the take without noise, before and after."""
    rows = {}
    for take in TAKES:
        tracks = without_copies(read_c3d(clips.DATA / "markers" / f"{take}.c3d"))
        for noise in NOISE:
            rng = seeded(take, noise)
            noisy = tracks.positions + noise * rng.normal(size=tracks.positions.shape)
            given = tracks.with_positions(noisy)
            clusters = [one for one in find_rigid_clusters(given) if len(one.names) > 2]
            members = [tracks.names.index(name) for one in clusters for name in one.names]
            constrained = constrain_clusters(given, clusters).tracks.positions
            gapped, marker = noisy.copy(), _head(tracks.names)
            length = round(GAP_S * tracks.frame_rate)
            gapped[100 : 100 + length, marker] = np.nan
            found = constrain_clusters(tracks.with_positions(gapped), clusters).tracks.positions
            rows[f"{take}, {1000 * noise:g} mm noise"] = [
                str(len(clusters)),
                _rms(noisy - tracks.positions, members),
                _rms(constrained - tracks.positions, members),
                _rms((found - tracks.positions)[100 : 100 + length], [marker]),
            ]
    header = ["take", "clusters of 3 or more", "before", "after", "LFHD missing for 2 s"]
    title = (
        "**Rigid clusters found in the noisy take** (rms distance to the clean take, mm)\n\n"
    )
    return title + table(header, rows) + "\n"


def _head(names: tuple[str, ...]) -> int:
    return names.index("LFHD")


def _rms(error: Array, members: list[int]) -> str:
    square = (error[:, members] ** 2).sum(axis=-1)
    return f"{1000 * np.sqrt(square.mean()):.2f}" if np.isfinite(square).all() else "-"
