r"""How a clip library grows: 300 to 100,000 clips, built in one file and searched.

    python -m tests.benchmarks.retrieval.part_growth  # up to 10,000: ten minutes
    python -m tests.benchmarks.retrieval.part_growth --sizes 300 1000 100000  # an hour
    python -m tests.benchmarks.retrieval.part_growth --log growth.log --docs  # of a run

The clips are those of HDM05 and the CMU walks, varied: faster or slower (0.7 to 1.4), bones
rotated by some degrees, shaken, mirrored. They are varied as postures of the standard body, in
which all actors have the same bone lengths; to read and describe a real clip of two seconds
takes about 15 ms more. Each query is a clip of the library, at another speed and shaken again;
it is found when that clip comes first, or among the first ten. At each size a process of its
own searches, so that its memory can be measured. Times are CPU times, with one thread.
"""

import argparse
import json
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

import numpy as np
from scipy.interpolate import interp1d

from solvers.arrays import Array
from solvers.motion import Tracks
from solvers.motion.humanoid.posture_joints import (
    MIRROR_JOINTS,
    N_JOINTS,
    PARENTS,
    POSTURE_JOINTS,
)
from solvers.retrieval import (
    ClipEntry,
    ClipLibrary,
    DescribedClip,
    FindSettings,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.index.clip_segments import CLIP_RATE_HZ, describe_segments
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.rotations.representations import (
    IDENTITY,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)

from ..shared import clips
from ..shared.report import BENCHMARK_PICTURES, DOCS, Report, show
from ..shared.tables import table
from .retrieval_pictures import draw_growth

SIZES = (300, 1_000, 3_000, 10_000)
BATCH = 100
N_QUERIES = 30
N_MATCHES = 20
SLOWEST, FASTEST = 0.7, 1.4
ROTATION_NOISE, POSITION_NOISE, QUERY_NOISE = np.radians(6.0), 0.005, 0.01
"""Standard deviations: of constant bone rotations, radians; of jitter of joints in the library,
meters; and of added jitter in queries, meters."""
SHOWN = {
    "hours": "hours", "add_s": "to add all, s", "file_mb": "file, MB", "open_ms": "to open, ms",
    "describe_ms": "describe, ms", "find_ms": "search, ms", "search_mb": "memory, MB",
    "first": "found first", "in_ten": "in the first ten", "kin": "of its kind in ten",
}  # fmt: skip
DRAWN = ("search_mb", "open_ms", "find_ms", "describe_ms")
PICTURE = BENCHMARK_PICTURES / "retrieval" / "growth.png"


@dataclass(frozen=True)
class Row:
    """What is measured at one size."""

    n_clips: int
    hours: float
    """Of motion."""
    add_s: float
    """Seconds for all clips until now."""
    file_mb: float
    build_mb: float
    """Peak memory of the process that builds; 100 clips are described at a time."""
    open_ms: float
    search_mb: float
    """Peak memory of the process that searches."""
    describe_ms: float
    """Median: describing the query."""
    find_ms: float
    """Median: all the rest."""
    first: float
    """Fraction of queries whose clip comes first."""
    in_ten: float
    kin: float
    """Fraction of variations of the same clip among the first ten."""


def run(sizes: Sequence[int] = SIZES, n_queries: int = N_QUERIES) -> list[Row]:
    """Build a library up to each size, and search it at each."""
    rows: list[Row] = []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "growing.clips"
        adding, seconds, done = 0.0, 0.0, 0
        with open_clip_library(path) as library:
            for size in sizes:
                while done < size:
                    numbers = range(done, min(done + BATCH, size))
                    found = [described(number) for number in numbers]
                    began = process_time()
                    library.add_described(found)
                    adding += process_time() - began
                    seconds += sum(clip.entry.seconds for clip in found)
                    done += len(found)
                built = (size, seconds / 3600.0, adding)
                rows.append(Row(*built, _megabytes(path), _peak(), *_searched(path, n_queries)))
                print(rows[-1], flush=True)
    return rows


def described(number: int) -> DescribedClip:
    """Return the clip of this number."""
    postures = varied(number)
    entry = ClipEntry(f"{number:06d}", (), None, postures.n_frames, CLIP_RATE_HZ)
    return DescribedClip(entry, postures)


def varied(number: int) -> ClipPostures:
    """Return postures of a clip that are varied."""
    rng = np.random.default_rng(number)
    original = originals()[number % len(originals())]
    speed = np.exp(rng.uniform(np.log(SLOWEST), np.log(FASTEST)))
    last = original.n_frames - 1.0
    times = np.arange(0.0, last + 1e-9, speed)
    positions, root_velocity = (
        interp1d(np.arange(last + 1.0), values, axis=0)(times)
        for values in (original.positions, original.root_velocity)
    )
    posed = rotate_bones(positions, ROTATION_NOISE * rng.normal(size=(N_JOINTS, 3)))
    posed += POSITION_NOISE * rng.normal(size=posed.shape)
    if rng.integers(2):
        posed = posed[:, MIRROR_JOINTS] * (-1.0, 1.0, 1.0)
        root_velocity = root_velocity * (-1.0, 1.0, 1.0, -1.0)
    return ClipPostures(posed, speed * root_velocity, CLIP_RATE_HZ)


def rotate_bones(positions: Array, vectors: Array) -> Array:
    """Return postures with each bone rotated, and its descendants with it."""
    rotations, result = [IDENTITY], positions.copy()
    for joint in range(1, N_JOINTS):
        above = PARENTS[joint]
        rotations.append(
            multiply(rotations[above], quaternion_from_rotation_vector(vectors[joint]))
        )
        bones = positions[:, joint] - positions[:, above]
        result[:, joint] = result[:, above] + rotate(rotations[joint], bones)
    return result


def query_tracks(number: int) -> Tracks:
    """Return what is searched with: a clip of the library, shaken and at another speed."""
    rng = np.random.default_rng([number, 1])
    clip = varied(number)
    headings = np.cumsum(clip.root_velocity[:, 3]) / CLIP_RATE_HZ
    rotations = quaternion_from_rotation_vector(headings[:, None] * (0.0, 0.0, 1.0))
    path = np.cumsum(rotate(rotations, clip.root_velocity[:, :3]), axis=0) / CLIP_RATE_HZ
    positions = rotate(rotations[:, None], clip.positions) + path[:, None]
    positions += QUERY_NOISE * rng.normal(size=positions.shape)
    return Tracks(POSTURE_JOINTS, positions, CLIP_RATE_HZ * rng.uniform(0.95, 1.05))


def originals() -> list[ClipPostures]:
    """Return the clips that are varied."""
    if not _ORIGINALS:
        motions = list(clips.walks().values())
        for name in clips.hdm05_classes():
            motions += clips.hdm05(name).values()
        _ORIGINALS.extend(clip_postures(motion, CLIP_RATE_HZ) for motion in motions)
    return _ORIGINALS


_ORIGINALS: list[ClipPostures] = []


def search(path: Path, n_queries: int) -> dict[str, float]:
    """Open a library, search for some of its clips, and return the figures."""
    began = process_time()
    library = load_clip_library(path)
    entries = library.entries
    assert library.blocks
    opened = process_time() - began
    rng = np.random.default_rng(len(entries))
    numbers = rng.permutation(len(entries))[:n_queries]
    answers = [_search(library, int(number)) for number in numbers]
    describe, find, first, in_ten, kin = (
        np.array(column) for column in zip(*answers, strict=True)
    )
    return {
        "open_ms": 1000.0 * opened,
        "search_mb": _peak(),
        "describe_ms": 1000.0 * float(np.median(describe)),
        "find_ms": 1000.0 * float(np.median(find)),
        "first": float(first.mean()),
        "in_ten": float(in_ten.mean()),
        "kin": float(kin.mean()),
    }


def _search(library: ClipLibrary, number: int) -> tuple[float, float, bool, bool, float]:
    query = query_tracks(number)
    vocabulary = library.vocabulary
    assert vocabulary is not None
    began = process_time()
    features = vocabulary.features(clip_postures(query, CLIP_RATE_HZ))
    describe_segments(features, np.array([[0, len(features)]], dtype=np.int32), vocabulary)
    start = process_time()
    matches = find_similar(query, library, settings=FindSettings(n_matches=N_MATCHES))
    found = process_time()
    ten = [int(match.clip) for match in matches[:10]]
    kin = np.mean([one % len(originals()) == number % len(originals()) for one in ten])
    description = start - began
    return description, found - start - description, ten[0] == number, number in ten, float(kin)


def _searched(path: Path, n_queries: int) -> tuple[float, ...]:
    words = [
        sys.executable,
        "-m",
        "tests.benchmarks.retrieval.part_growth",
        "--search",
        str(path),
    ]
    output = subprocess.run(
        [*words, "--queries", str(n_queries)], check=True, capture_output=True, text=True
    ).stdout
    return tuple(json.loads(output).values())


def _megabytes(path: Path) -> float:
    return path.stat().st_size / 1e6


def _peak() -> float:
    """Return the most memory that this process has had, less what it was started from."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return float(status.split("VmHWM:")[1].split()[0]) / 1e3


def rows_of(path: Path) -> list[Row]:
    """Read the rows that a run printed, which may have been cut short."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if "Row(" in line]
    answers = [dict(re.findall(r"(\w+)=([^,)]+)", line)) for line in lines]
    return [
        Row(int(one.pop("n_clips")), **{name: float(value) for name, value in one.items()})
        for one in answers
    ]


def tables(rows: Sequence[Row]) -> list[str]:
    """Return the table, and the line that shows the picture."""
    cells = {
        f"{row.n_clips:,}": [
            f"{getattr(row, name):,.{max(2 - int(np.log10(max(getattr(row, name), 1))), 0)}f}"
            for name in SHOWN
        ]
        for row in rows
    }
    return [
        f"**Growth of a library**\n\n{table(['clips', *SHOWN.values()], cells)}\n",
        f"{show(PICTURE, 'growth')}\n",
    ]


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--queries", type=int, default=N_QUERIES)
    parser.add_argument("--search", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--log", type=Path, help="rows that an earlier run printed")
    parser.add_argument("--docs", action="store_true", help="into docs/benchmarks/retrieval.md")
    chosen = parser.parse_args()
    if chosen.search is not None:
        print(json.dumps(search(chosen.search, chosen.queries)))
        return
    began = perf_counter()
    rows = rows_of(chosen.log) if chosen.log else run(sorted(chosen.sizes), chosen.queries)
    if chosen.docs:
        drawn = {SHOWN[name]: [getattr(row, name) for row in rows] for name in DRAWN}
        draw_growth([row.n_clips for row in rows], drawn, "Growth of a library", PICTURE)
    report = Report(chosen.docs, DOCS / "benchmarks" / "retrieval.md")
    report.part("growth", tables(rows), perf_counter() - began)


if __name__ == "__main__":
    main()
