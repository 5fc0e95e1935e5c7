"""Labels swapped in clean optical takes: how many are corrected, and how many worsened."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array
from solvers.markers import unswap_markers
from solvers.motion import Tracks
from solvers.recordings import read_c3d
from solvers.recordings.joint_files.ui_prmd import read_ui_prmd_pair

from ..peers.label_tracking import by_continuity
from ..shared import clips
from ..shared.noise import seeded
from ..shared.tables import table
from .part_markers import TAKES, without_copies

Untangler = Callable[[Tracks], Array]
HARD_STEP = 4
SECONDS_BETWEEN_GAPS = 3.0
NEAREST = 4
"""A marker is swapped with one of so many nearest ones, or with its mirror image."""


def _ours(tracks: Tracks) -> Array:
    return unswap_markers(tracks).tracks.positions


METHODS: dict[str, Untangler] = {
    "nothing": lambda tracks: tracks.positions,
    "continuity alone (assignment)": lambda tracks: by_continuity(tracks.positions),
    "ours": _ours,
}


@dataclass
class Count:
    """Samples over many draws."""

    wrong: int = 0
    changed: int = 0
    righted: int = 0
    swapped: int = 0
    n_correct: int = 0
    draws: int = 0

    def cell(self) -> str:
        """Return precision, recall and the fraction of draws with a correct result."""
        precision = 100.0 * self.righted / self.changed if self.changed else float("nan")
        recall = 100.0 * self.righted / max(self.wrong, 1)
        shown = "-" if np.isnan(precision) else f"{precision:.1f}"
        return f"{shown} / {recall:.1f} / {100.0 * self.n_correct / max(self.draws, 1):.0f}"


def compare_swaps(draws: int, hard: bool) -> str:
    """Return a table: precision, recall and draws without a fault, by kind of mistake.

    `hard` takes every fourth frame only, and every marker is missing a few times.
    """
    counts = {name: {kind: Count() for kind in MISTAKES} for name in METHODS}
    for take in TAKES:
        clean = without_copies(read_c3d(clips.DATA / "markers" / f"{take}.c3d"))
        clean = clean.slice(0, min(clean.n_frames, 1200))
        for kind, mistake in MISTAKES.items():
            for draw in range(draws):
                rng = seeded(take, kind, draw)
                given = _blinking(clean, rng) if hard else clean
                swapped, truth = mistake(given, rng)
                for name, method in METHODS.items():
                    result = method(given.with_positions(swapped))
                    _add(counts[name][kind], swapped, truth, result)
        print(f"  {take}: swaps", flush=True)
    rows = {name: [counts[name][kind].cell() for kind in MISTAKES] for name in METHODS}
    title = (
        f"**Swapped labels, {'30 Hz, with gaps' if hard else '120 Hz, nothing missing'},"
        f" {draws} draws of each kind in each of {len(TAKES)} takes**"
        " (percent: precision / recall / draws without a remaining error)\n\n"
    )
    return title + table(["method", *MISTAKES], rows) + "\n"


def _blinking(take: Tracks, rng: np.random.Generator) -> Tracks:
    """Return the take at a quarter of its rate, each marker missing for short intervals."""
    positions = take.positions[::HARD_STEP].copy()
    rate = take.frame_rate / HARD_STEP
    n_gaps = round(len(positions) / rate / SECONDS_BETWEEN_GAPS)
    for marker in range(take.n_points):
        for start in rng.integers(0, len(positions), n_gaps):
            positions[start : start + round(rng.uniform(0.1, 0.5) * rate), marker] = np.nan
    return Tracks(take.names, positions, rate)


def _add(count: Count, swapped: Array, truth: Array, result: Array) -> None:
    wrong, remaining, changed = (
        (np.nan_to_num(one) != np.nan_to_num(other)).any(axis=-1)
        for one, other in ((swapped, truth), (result, truth), (result, swapped))
    )
    count.wrong += int(wrong.sum())
    count.changed += int(changed.sum())
    count.righted += int((wrong & ~remaining).sum())
    count.n_correct += int(not remaining.any())
    count.draws += 1


def _pair(take: Tracks, rng: np.random.Generator) -> list[int]:
    """Return a marker and its mirror image, or one of those nearest to it."""
    first = int(rng.integers(take.n_points))
    name = take.names[first]
    twin = {"L": "R", "R": "L"}.get(name[0], "") + name[1:]
    if twin in take.names and rng.random() < 0.4:
        return [first, take.names.index(twin)]
    distances = np.linalg.norm(take.positions[::10] - take.positions[::10, [first]], axis=-1)
    near = np.argsort(np.nanmean(distances, axis=0))[1 : NEAREST + 1]
    return [first, int(rng.choice(near))]


def _stretch(take: Tracks, rng: np.random.Generator, seconds: float) -> tuple[int, int]:
    length = max(1, round(seconds * take.frame_rate))
    start = int(rng.integers(1, take.n_frames - length - 1))
    return start, start + length


def _swapped(seconds: float) -> Callable[[Tracks, np.random.Generator], tuple[Array, Array]]:
    def mistake(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
        swapped, pair = take.positions.copy(), _pair(take, rng)
        start, stop = _stretch(take, rng, seconds)
        swapped[start:stop, pair] = swapped[start:stop, pair[::-1]]
        return swapped, take.positions

    return mistake


def _to_the_end(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
    swapped, pair = take.positions.copy(), _pair(take, rng)
    start = int(rng.integers(take.n_frames // 2 + 1, take.n_frames - 2))
    swapped[start:, pair] = swapped[start:, pair[::-1]]
    return swapped, take.positions


def _several(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
    swapped = take.positions.copy()
    for _ in range(5):
        pair = _pair(take, rng)
        start, stop = _stretch(take, rng, float(rng.uniform(0.05, 2.0)))
        swapped[start:stop, pair] = swapped[start:stop, pair[::-1]]
    return swapped, take.positions


def _three(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
    swapped = take.positions.copy()
    three = rng.choice(take.n_points, 3, replace=False)
    start, stop = _stretch(take, rng, 1.0)
    swapped[start:stop, three] = swapped[start:stop, np.roll(three, 1)]
    return swapped, take.positions


def _between_gaps(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
    """Both are missing for 0.4 s, return swapped for 1 s, and are missing once more."""
    truth, pair = take.positions.copy(), _pair(take, rng)
    start, stop = _stretch(take, rng, 1.8)
    gap = round(0.4 * take.frame_rate)
    truth[start : start + gap, pair] = truth[stop - gap : stop, pair] = np.nan
    swapped = truth.copy()
    swapped[start:stop, pair] = swapped[start:stop, pair[::-1]]
    return swapped, truth


def _swapped_with_missing(take: Tracks, rng: np.random.Generator) -> tuple[Array, Array]:
    """One is missing for 1 s, and another carries its label meanwhile."""
    truth, (missing, other) = take.positions.copy(), _pair(take, rng)
    start, stop = _stretch(take, rng, 1.0)
    truth[start:stop, missing] = np.nan
    swapped = truth.copy()
    swapped[start:stop, [missing, other]] = swapped[start:stop, [other, missing]]
    return swapped, truth


MISTAKES = {
    "1 frame": _swapped(0.0),
    "0.5 s": _swapped(0.5),
    "2 s": _swapped(2.0),
    "to the end": _to_the_end,
    "five at once": _several,
    "three in turn": _three,
    "between gaps": _between_gaps,
    "swapped with a missing one": _swapped_with_missing,
}


def false_alarms() -> str:
    """Return a table of the swaps found in takes that are clean."""
    rows: dict[str, list[str]] = {}
    for title, takes in (("optical, 120 Hz", _optical), ("UI-PRMD, 30 Hz", _ui_prmd)):
        for name, method in list(METHODS.items())[1:]:
            n_takes = samples = touched = 0
            for take in takes():
                after = method(take)
                changed = (np.nan_to_num(after) != np.nan_to_num(take.positions)).any(axis=-1)
                n_takes, samples = n_takes + 1, samples + changed.size
                touched += int(changed.any())
                rows.setdefault(f"{title}, {name}", []).clear()
            rows[f"{title}, {name}"] = [
                str(n_takes),
                f"{samples / 1e6:.2f} million",
                str(touched),
            ]
        print(f"  {title}: false alarms", flush=True)
    title = "**False alarms in clean takes**\n\n"
    return title + table(["", "takes", "samples", "takes with labels changed"], rows) + "\n"


def _optical() -> Iterator[Tracks]:
    for take in TAKES:
        yield without_copies(read_c3d(clips.DATA / "markers" / f"{take}.c3d"))


def _ui_prmd() -> Iterator[Tracks]:
    for path in sorted((clips.DATA / "kinect" / "ui_prmd").glob("*.npz"))[::4]:
        yield read_ui_prmd_pair(path)[1]
