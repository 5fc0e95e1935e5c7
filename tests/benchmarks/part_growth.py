r"""How a clip library grows: 300 to 100,000 clips, built in one file and searched.

    python -m tests.benchmarks.part_growth                          # up to 10,000: ten minutes
    python -m tests.benchmarks.part_growth --sizes 300 1000 100000  # an hour

The clips are those of HDM05 and the CMU walks, varied: faster or slower (0.7 to 1.4), joints
turned by some degrees, shaken, other bone lengths, mirrored. Each query is a clip of the
library, at another speed and shaken again; it is found when that clip comes first, or among
the first ten. At each size a process of its own searches, so that its memory can be told.
"""

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

from solvers.motion import Motion
from solvers.motion.posture_joints import MIRROR_IMAGES
from solvers.motion.rotations import multiply, quaternion_from_rotation_vector
from solvers.retrieval import (
    Clip,
    ClipLibrary,
    DescribedClip,
    FindSettings,
    describe_clip,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.retrieval.clip_postures import clip_postures
from solvers.retrieval.spans import RATE, describe

from . import clips
from .tables import table

SIZES = (300, 1_000, 3_000, 10_000)
BATCH = 100
N_QUERIES = 30
TOLD = 20
SLOWEST, FASTEST = 0.7, 1.4
TURNED, SHAKEN, ASKED = np.radians([6.0, 1.0, 1.5])
"""Standard deviations by which joints are turned for good, and from frame to frame."""
LENGTHS = 0.1


@dataclass(frozen=True)
class Row:
    """What is measured at one size."""

    n_clips: int
    hours: float
    """Of motion."""
    describe_s: float
    """Seconds for all clips until now, without reading their files."""
    add_s: float
    file_mb: float
    build_mb: float
    """Peak memory of the process that builds; 100 clips are described at a time."""
    open_ms: float
    search_mb: float
    """Peak memory of the process that searches."""
    ask_ms: float
    """Median: describing the query."""
    find_ms: float
    """Median: all the rest."""
    first: float
    """Share of queries whose clip comes first."""
    in_ten: float
    kin: float
    """Share, in the first ten, of variations of the clip that the query varies."""


def run(sizes: Sequence[int] = SIZES, n_queries: int = N_QUERIES) -> list[Row]:
    """Build a library up to each size, and search it at each."""
    rows: list[Row] = []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "growing.clips"
        describing, adding, seconds, done = 0.0, 0.0, 0.0, 0
        with open_clip_library(path) as library:
            for size in sizes:
                while done < size:
                    began = perf_counter()
                    numbers = range(done, min(done + BATCH, size))
                    found = [described(number) for number in numbers]
                    described_at = perf_counter()
                    library.add_described(found)
                    describing += described_at - began
                    adding += perf_counter() - described_at
                    seconds += sum(clip.entry.seconds for clip in found)
                    done += len(found)
                built = (size, seconds / 3600.0, describing, adding)
                rows.append(Row(*built, _megabytes(path), _peak(), *_searched(path, n_queries)))
                print(rows[-1], flush=True)
    return rows


def described(number: int) -> DescribedClip:
    """Return the clip of this number."""
    motion, mirrored = varied(number)
    clip = describe_clip(Clip(f"{number:06d}", motion))
    if not mirrored:
        return clip
    positions = clip.postures.positions[:, MIRROR_IMAGES] * (-1.0, 1.0, 1.0)
    course = clip.postures.course * (-1.0, 1.0, 1.0, -1.0)
    return DescribedClip(clip.entry, type(clip.postures)(positions, course, RATE))


def varied(number: int) -> tuple[Motion, bool]:
    """Return a clip that is varied, and whether it is to be mirrored as well."""
    rng = np.random.default_rng(number)
    motion = originals()[number % len(originals())]
    factors = np.exp(LENGTHS * rng.normal(size=(motion.n_joints, 1)))
    skeleton = type(motion.skeleton)(
        motion.skeleton.names, motion.skeleton.parents, motion.skeleton.offsets * factors
    )
    turned = quaternion_from_rotation_vector(TURNED * rng.normal(size=(motion.n_joints, 3)))
    rotations = multiply(motion.rotations, turned)
    speed = np.exp(rng.uniform(np.log(SLOWEST), np.log(FASTEST)))
    changed = Motion(skeleton, rotations, motion.root_positions, motion.frame_rate * speed)
    return shaken(changed, SHAKEN, rng), bool(rng.integers(2))


def shaken(motion: Motion, by: float, rng: np.random.Generator) -> Motion:
    """Return a motion all of whose joints shake."""
    shape = (*motion.rotations.shape[:2], 3)
    noise = quaternion_from_rotation_vector(by * rng.normal(size=shape))
    return motion.with_poses(rotations=multiply(motion.rotations, noise))


def originals() -> list[Motion]:
    """Return the clips that are varied, at 30 Hz."""
    if not _ORIGINALS:
        _ORIGINALS.extend(clips.walks().values())
        for name in clips.hdm05_classes():
            _ORIGINALS.extend(clips.hdm05(name).values())
    return _ORIGINALS


_ORIGINALS: list[Motion] = []


def search(path: Path, n_queries: int) -> dict[str, float]:
    """Open a library, ask it for some of its clips, and tell what came of it."""
    began = perf_counter()
    library = load_clip_library(path)
    entries = library.entries
    assert library.blocks
    opened = perf_counter() - began
    rng = np.random.default_rng(len(entries))
    asked = [number for number in rng.permutation(len(entries)) if not varied(number)[1]]
    told = [_asked(library, int(number)) for number in asked[:n_queries]]
    ask, find, first, in_ten, kin = (np.array(column) for column in zip(*told, strict=True))
    return {
        "open_ms": 1000.0 * opened,
        "search_mb": _peak(),
        "ask_ms": 1000.0 * float(np.median(ask)),
        "find_ms": 1000.0 * float(np.median(find)),
        "first": float(first.mean()),
        "in_ten": float(in_ten.mean()),
        "kin": float(kin.mean()),
    }


def _asked(library: ClipLibrary, number: int) -> tuple[float, float, bool, bool, float]:
    rng = np.random.default_rng([number, 1])
    motion = shaken(varied(number)[0], ASKED, rng)
    query = Motion(
        motion.skeleton, motion.rotations, motion.root_positions,
        motion.frame_rate * rng.uniform(0.95, 1.05),
    )  # fmt: skip
    vocabulary = library.vocabulary
    assert vocabulary is not None
    began = perf_counter()
    features = vocabulary.features(clip_postures(query, RATE))
    describe(features, np.array([[0, len(features)]], dtype=np.int32), vocabulary)
    asked = perf_counter()
    matches = find_similar(query, library, settings=FindSettings(n_matches=TOLD))
    found = perf_counter()
    ten = [int(match.clip) for match in matches[:10]]
    kin = np.mean([one % len(originals()) == number % len(originals()) for one in ten])
    description = asked - began
    return description, found - asked - description, ten[0] == number, number in ten, float(kin)


def _searched(path: Path, n_queries: int) -> tuple[float, ...]:
    words = [sys.executable, "-m", "tests.benchmarks.part_growth", "--search", str(path)]
    said = subprocess.run(
        [*words, "--queries", str(n_queries)], check=True, capture_output=True, text=True
    ).stdout
    return tuple(json.loads(said).values())


def _megabytes(path: Path) -> float:
    return path.stat().st_size / 1e6


def _peak() -> float:
    """Return the most memory that this process has had, less what it was started from."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return float(status.split("VmHWM:")[1].split()[0]) / 1e3


def markdown(rows: Sequence[Row]) -> str:
    """Return the table."""
    header = list(asdict(rows[0]))
    cells = {f"{row.n_clips:,}": [f"{each:.3g}" for each in list(asdict(row).values())[1:]]
             for row in rows}  # fmt: skip
    return table(header, cells)


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--queries", type=int, default=N_QUERIES)
    parser.add_argument("--search", type=Path, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.search is not None:
        print(json.dumps(search(chosen.search, chosen.queries)))
    else:
        print(markdown(run(sorted(chosen.sizes), chosen.queries)))


if __name__ == "__main__":
    main()
