"""Time and memory on long takes: one BLAS thread, median of five, ratio to a peer."""

import tracemalloc
from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np

from solvers.denoising import DenoiseMethod, DenoiseSettings, denoise, learn_filter_bases
from solvers.motion import Motion

from ..peers import kalman, smoothers
from ..shared import clips
from ..shared.noise import Channels, corrupt, learn_channels, seeded
from ..shared.tables import number, table

REPEATS = 5
WINDOW = 20
JOINTS = 20
"""Moving joints kept; with the root's motion about the 62 channels of [LC10]."""


def measure_speed() -> str:
    """Return a table in Markdown."""
    short, long = _take(2000), _take(60_000)
    channels = learn_channels([short])
    print(f"  takes with {channels.kept.sum()} moving channels", flush=True)
    rows: dict[str, list[str]] = {}
    trajectory = _timed(lambda: _trajectory_svd(channels.values(short)))
    _row(rows, "SVD of the trajectory matrix, 2,000 frames (as published)", trajectory, None)
    _row(rows, "ours: learn bases, 2,000 frames", _timed(lambda: learn_filter_bases([short])),
         trajectory)  # fmt: skip
    _row(rows, "ours: learn bases, 60,000 frames", _timed(lambda: learn_filter_bases([long])),
         trajectory)  # fmt: skip
    noisy, values = _noisy(short.slice(0, 1000), channels)
    learned = [channels.values(short)]
    peer = _timed(lambda: smoothers.hampel_gcv_spline(values, 30.0))
    _row(rows, "Hampel + GCV spline, 1,000 frames", peer, None)
    _row(rows, "data-driven Kalman RTS, 1,000 frames",
         _timed(lambda: kalman.learned_dynamics(values, 30.0, 3.0, learned)), peer)  # fmt: skip
    bases = learn_filter_bases([short])
    for title, settings, examples in (
        ("ours: denoise 1,000 frames", DenoiseSettings(), bases),
        ("ours: denoise 1,000 frames, no prior", DenoiseSettings(), None),
        (
            "[LC10] as published, 1,000 frames",
            DenoiseSettings(method=DenoiseMethod.PUBLISHED),
            bases,
        ),
    ):
        timed = _timed(lambda e=examples, s=settings: denoise(noisy, e, settings=s))
        _row(rows, title, timed, peer)
    head = ["task", "seconds", "times the peer above", "peak memory, MB"]
    return "**Speed** (median of 5, one BLAS thread)\n\n" + table(head, rows) + "\n"


def _take(n_frames: int) -> Motion:
    """Walks one after the other, as often as needed; 30 Hz."""
    walks = list(clips.walks().values())
    n_walks = sum(walk.n_frames for walk in walks)
    rotations = np.concatenate([walk.rotations for walk in walks] * (1 + n_frames // n_walks))
    positions = np.concatenate(
        [walk.root_positions for walk in walks] * (1 + n_frames // n_walks)
    )
    joints = np.flatnonzero(learn_channels(walks).joints)[:JOINTS]
    return Motion(
        walks[0].skeleton.select(joints.tolist()),
        rotations[:n_frames, joints],
        positions[:n_frames],
        30.0,
    )


def _noisy(motion: Motion, channels: Channels) -> tuple[Motion, np.ndarray]:
    clean = channels.values(motion)
    values = corrupt(clean, 3.0, 0.1, seeded("speed"))
    return channels.motion(values, motion), values


def _trajectory_svd(values: np.ndarray) -> np.ndarray:
    windows = np.lib.stride_tricks.sliding_window_view(values - values.mean(axis=0), WINDOW, 0)
    return np.linalg.svd(windows.reshape(len(windows), -1), full_matrices=False)[2]


def _timed(work: Callable[[], object]) -> tuple[float, float]:
    """Median seconds, and peak megabytes of one more run."""
    seconds = []
    for _ in range(REPEATS):
        started = perf_counter()
        work()
        seconds.append(perf_counter() - started)
        if seconds[-1] > 60.0:
            break
    tracemalloc.start()
    work()
    peak = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    return median(seconds), peak


def _row(
    rows: dict[str, list[str]],
    title: str,
    timed: tuple[float, float],
    peer: tuple[float, float] | None,
) -> None:
    seconds, peak = timed
    ratio = number(seconds / peer[0]) if peer else "1 (the peer)"
    rows[title] = [f"{seconds:.3f}", ratio, f"{peak:.0f}"]
    print(f"  {title}: {seconds:.3f} s, {ratio}, {peak:.0f} MB", flush=True)
