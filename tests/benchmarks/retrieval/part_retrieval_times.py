"""Time of one search, step by step: what the machine can do, not what others left of it."""

from collections.abc import Callable, Sequence
from functools import partial
from time import process_time

import numpy as np

from solvers.motion import resample
from solvers.retrieval import FindSettings, find_similar

from ..shared.tables import number, table
from ..shared.timing import run_times
from .retrieval_clips import library
from .retrieval_default import Default

REPEATS = 10
QUERY_STEP = 4
"""Clips from one query to the next."""
N_MATCHES = 20
RATES = (120.0, 30.0)


def time_searches() -> str:
    """Return the table: for each step the median over queries of the shortest of ten times."""
    clips = library()
    prepared = Default().prepare([clip.tracks for clip in clips])
    allowed = ~np.eye(len(clips), dtype=bool)
    indices = range(0, len(clips), QUERY_STEP)
    rows = {}
    for rate in RATES:
        tracks = {index: resample(clips[index].tracks, rate) for index in indices}
        times = [_shortest(partial(prepared.describe, tracks[at])) for at in indices]
        rows[f"describing a query of {rate:.0f} Hz"] = times
    described = {at: prepared.describe(clips[at].tracks) for at in indices}
    rows["search: all clips ranked"] = [
        _shortest(partial(prepared.distances, described[at], allowed[at])) for at in indices
    ]
    for n_aligned in (0, FindSettings().n_aligned):
        settings = FindSettings(n_matches=N_MATCHES, n_aligned=n_aligned)
        name = f"find_similar, {N_MATCHES} matches, {n_aligned} aligned frame by frame, 120 Hz"
        rows[name] = [
            _shortest(
                partial(find_similar, clips[at].tracks, prepared.library, settings=settings)
            )
            for at in indices
        ]
    return (
        f"**Time of one search of {len(clips)} clips**, one thread, ms: median over"
        f" {len(indices)} queries of the shortest of {REPEATS}\n\n{_table(rows)}\n"
    )


def _shortest(describe: Callable[[], object]) -> float:
    return 1e3 * min(run_times(describe, REPEATS, process_time))


def _table(rows: dict[str, Sequence[float]]) -> str:
    cells = {name: [number(float(np.median(times)))] for name, times in rows.items()}
    return table(["step", "ms"], cells)
