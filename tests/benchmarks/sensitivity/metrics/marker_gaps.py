"""Gaps of optical markers in two takes, of one marker or five: jittery, fast and slow."""

import numpy as np

from solvers.denoising import denoise
from solvers.motion import Tracks
from solvers.recordings import read_recording

from ...shared import clips
from ..takes import point_error

TAKES = {"mocap/05_13.c3d": (41, 300), "formats/c3d/Dance.c3d": (40, 0)}
"""Of the takes on which `part_markers` tunes: points that are markers, first frame."""
N_FRAMES = 240
GAPS = ((1, 0.4), (5, 0.7))
"""Number of markers and seconds."""


def prepare() -> dict[str, object]:
    """Cut gaps."""
    cases = {}
    for file, (n_markers, start) in TAKES.items():
        tracks = read_recording(clips.DATA / file)
        assert isinstance(tracks, Tracks)
        tracks = tracks.slice(start, min(start + N_FRAMES, tracks.n_frames))
        observed = np.flatnonzero(tracks.visible[:, :n_markers].all(axis=0))
        names = tuple(tracks.names[point] for point in observed)
        truth = Tracks(names, tracks.positions[:, observed], tracks.frame_rate)
        for number, seconds in GAPS:
            rng = np.random.default_rng(number)
            positions = truth.positions.copy()
            length = round(seconds * truth.frame_rate)
            for first in (20, 130):
                gone = rng.choice(truth.n_points, number, replace=False)
                positions[first : first + length, gone] = np.nan
            if number > 1:
                _disturb(positions, rng)
            name = f"{file.rpartition('/')[2]}, {number} for {seconds:g} s"
            cases[name] = truth, truth.with_positions(positions)
            if number > 1:
                cases[f"{name}, slow"] = _every_fourth(*cases[name])
    return {"cases": cases}


def measure(cases: dict[str, tuple[Tracks, Tracks]]) -> dict[str, float]:
    """Fill them; mean distance where they were cut, and how far off confidence is."""
    figures = {}
    for name, (truth, given) in cases.items():
        result = denoise(given)
        assert isinstance(result.recording, Tracks)
        gone = ~given.visible
        figures[f"{name}: mm"] = point_error(result.recording.positions, truth.positions, gone)
        error = np.linalg.norm(result.recording.positions - truth.positions, axis=-1)
        deserved = 1.0 / (1.0 + (100.0 * error / 5.0) ** 2)
        off = np.abs(result.confidence - deserved)[gone]
        figures[f"{name}: confidence off %"] = 100.0 * float(off.mean())
    return figures


def _every_fourth(*takes: Tracks) -> tuple[Tracks, ...]:
    """Return takes at a quarter of their rate, 30 and 16 Hz, where movement looks jumpy."""
    return tuple(
        Tracks(each.names, each.positions[::4].copy(), each.frame_rate / 4) for each in takes
    )


def _disturb(positions: np.ndarray, rng: np.random.Generator) -> None:
    """Add 0.3 mm of noise, spikes of a frame or two, and gaps of three frames."""
    n_frames, n_points = positions.shape[:2]
    positions += rng.normal(scale=0.0003, size=positions.shape)
    for point in rng.choice(n_points, 8, replace=False):
        frame = int(rng.integers(2, n_frames - 4))
        positions[frame : frame + int(rng.integers(1, 3)), point] += rng.normal(
            scale=0.1, size=3
        )
        frame = int(rng.integers(2, n_frames - 4))
        positions[frame : frame + 3, point] = np.nan
