"""Optical markers at 120 Hz: one or five missing for half a second or two, in clean takes."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from solvers.arrays import Array
from solvers.denoising import DenoiseMethod, DenoiseSettings, denoise
from solvers.motion import Tracks
from solvers.recordings import read_c3d, read_recording

from ..peers import gap_fillers, marker_fillers
from ..peers.model_averaging import model_averaging
from ..shared import clips
from ..shared.noise import seeded
from ..shared.tables import Scores

TAKES = ("85_02", "HDM_bd_05-01_01_120")
"""Published figures are of these alone."""
DEV_TAKES = {
    "mocap/05_13.c3d": 41,
    "formats/c3d/Dance.c3d": 40,
    "formats/c3d/PiG_Motion-FlatFoot-Hole.c3d": 35,
    "formats/trc/SprintMotion.trc": 55,
    "formats/trc/dataWithNaNsWithSpaces.trc": 42,
    "formats/trc/static_walk_2.trc": 41,
    "formats/trc/subject02_running.trc": 41,
}
"""Settings are chosen on these alone. By file, the number of points that are markers: what
follows them is computed."""
MAX_GAP_FRACTION = 0.5
"""Of a take: longer gaps leave too little to learn from."""
GAPS = ((1, 0.5), (1, 2.0), (5, 0.5), (5, 2.0))
"""Number of markers and seconds."""
Filler = Callable[[Array, float], Array]


def compare_markers(fillers: Mapping[str, Filler], draws: int, dev: bool) -> list[Scores]:
    """Cut the same random gaps for all methods; distance from the truth where it was cut."""
    takes = _development() if dev else _scored()
    scores = Scores(
        f"Gaps of optical markers, {draws} in each of {len(takes)} takes",
        "mean distance, millimeters; spread over gaps",
    )
    for take, tracks in takes.items():
        for n_markers, seconds in GAPS:
            if seconds > MAX_GAP_FRACTION * tracks.n_frames / tracks.frame_rate:
                continue
            for draw in range(draws):
                gapped = _cut(tracks, take, n_markers, seconds, draw)
                missing = np.isnan(gapped).any(axis=2)
                for name, fill in fillers.items():
                    error = fill(gapped, tracks.frame_rate) - tracks.positions
                    distance = 1000.0 * np.linalg.norm(error, axis=2)[missing].mean()
                    column = f"{n_markers}, {seconds:g} s"
                    scores.add(name, column, f"{take} {draw}", float(distance))
            print(f"  {take}: {n_markers} markers for {seconds:g} s", flush=True)
    return [scores]


def _scored() -> dict[str, Tracks]:
    paths = {take: clips.DATA / "markers" / f"{take}.c3d" for take in TAKES}
    return {take: without_copies(read_c3d(path)) for take, path in paths.items()}


def _development() -> dict[str, Tracks]:
    """Select the markers that are observed in all frames, for which the truth is available."""
    takes = {}
    for file, n_markers in DEV_TAKES.items():
        tracks = read_recording(clips.DATA / file)
        assert isinstance(tracks, Tracks)
        complete = np.flatnonzero(tracks.visible[:, :n_markers].all(axis=0))
        names = tuple(tracks.names[point] for point in complete)
        takes[Path(file).stem] = Tracks(names, tracks.positions[:, complete], tracks.frame_rate)
    return takes


def without_copies(tracks: Tracks) -> Tracks:
    """Leave out *0, *1 and *2 of the HDM05 take: they are copies of three other markers."""
    complete = [index for index, name in enumerate(tracks.names) if not name.startswith("*")]
    names = tuple(tracks.names[index] for index in complete)
    return Tracks(names, tracks.positions[:, complete], tracks.frame_rate)


def _cut(tracks: Tracks, take: str, n_markers: int, seconds: float, draw: int) -> Array:
    rng = seeded(take, n_markers, seconds, draw)
    length = round(seconds * tracks.frame_rate)
    start = int(rng.integers(1, tracks.n_frames - length - 1))
    gapped = tracks.positions.copy()
    chosen = rng.choice(tracks.n_points, n_markers, replace=False)
    gapped[start : start + length, chosen] = np.nan
    return gapped


def ours(
    gapped: Array, frame_rate: float, method: DenoiseMethod = DenoiseMethod.DEFAULT
) -> Array:
    """Denoise without examples; observed samples count fully."""
    names = tuple(f"marker {number}" for number in range(gapped.shape[1]))
    settings = DenoiseSettings(method=method)
    done = denoise(Tracks(names, gapped, frame_rate), settings=settings).recording
    assert isinstance(done, Tracks)
    return np.where(np.isnan(gapped), done.positions, gapped)


FILLERS: dict[str, Filler] = {
    "linear interpolation": marker_fillers.each_coordinate(gap_fillers.linear),
    "PCHIP": marker_fillers.each_coordinate(gap_fillers.pchip),
    "cubic spline": marker_fillers.each_coordinate(gap_fillers.cubic),
    "soft-impute, relative to the mean marker": marker_fillers.centered(
        marker_fillers.soft_impute
    ),
    "subspace Kalman (from the paper)": marker_fillers.centered(marker_fillers.subspace_kalman),
    "PMA-R2 (after the authors' program)": marker_fillers.centered(
        marker_fillers.principal_markers
    ),
    "model averaging (after the authors' program)": marker_fillers.centered(model_averaging),
    "[LC10] as published, no examples": partial(ours, method=DenoiseMethod.PUBLISHED),
    "ours": ours,
}
