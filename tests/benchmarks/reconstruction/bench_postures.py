"""Postures from a library: parts used, energies, missing joints; large libraries.

    make bench-postures                       # about five minutes
    make bench-postures ARGUMENTS=--dev       # clips to tune on
    make bench-postures ARGUMENTS=--docs      # into docs/benchmarks/reconstruction.md
    make bench-postures ARGUMENTS=--search    # large libraries alone

Libraries are of other persons than the clips: CMU walkers for development and one actor of
HDM05. "Missing" joints are taken out of the capture; all methods get the mask. Interpolation
knows both ends of a loss, as does ours but for "causal". Only one loss in each take.
"""

import argparse
import sys
from time import perf_counter

import numpy as np

from solvers.arrays import Single
from solvers.motion.humanoid.body_size import ADULT_BONE_LENGTHS_M
from solvers.reconstruction.joint_rotations.library_body import (
    BodyPostures,
    build_body_postures,
)
from solvers.reconstruction.pose_library.neighbors import (
    PostureQuery,
    index_postures,
    nearest_postures,
)
from solvers.reconstruction.pose_library.posture_groups import group_postures
from solvers.reconstruction.pose_library.posture_library import PostureLibrary

from ..shared.report import DOCS, Report
from ..shared.tables import Scores, number, table
from . import part_postures as part

SIZES = (2500, 10_000, 30_000, 100_000)
N_QUERIES = 256


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--dev", action="store_true", help="clips to tune on instead")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/reconstruction.md"
    )
    parser.add_argument("--search", action="store_true", help="search in large libraries")
    chosen = parser.parse_args()
    report = Report(chosen.docs, DOCS / "benchmarks" / "reconstruction.md")
    started = perf_counter()
    tables: list[Scores | str] = []
    if chosen.search:
        found_tables = [growth()]
        report.part("posture search", found_tables, perf_counter() - started)
        return
    optical, kinect = part.optical_clips(chosen.dev), part.kinect_clips(chosen.dev)
    titles = f"{len(optical)} CMU and HDM05 clips", f"{len(kinect)} Kinect takes"
    for title, found in zip(titles, (optical, kinect), strict=True):
        tables.append(part.parts_used(title, found))
    tables.append(part.energies(optical[::3]))
    _report_done("parts, energies")
    for title, found in zip(titles, (optical, kinect), strict=True):
        tables += part.missing_joints(title, found)
        _report_done(f"missing joints, {title}")
    report.part("postures", tables, perf_counter() - started)


def growth() -> str:
    """Time and recall of the search as a library grows (mixed and disturbed real postures)."""
    library = part.optical_clips(True)[0].library
    random = np.random.default_rng(0)
    rows = {}
    for size in SIZES:
        directions, changes = _mixed(library, size, random)
        postures, speeds = _mixed(library, N_QUERIES, random)
        body = build_body_postures(directions, changes, ADULT_BONE_LENGTHS_M)
        query = _query(build_body_postures(postures, speeds, ADULT_BONE_LENGTHS_M), random)
        groups = group_postures(directions)
        index = index_postures(body, groups)
        started = perf_counter()
        found, _ = nearest_postures(index, query)
        fast = perf_counter() - started
        exact = index_postures(body, 0 * groups)
        started = perf_counter()
        truth, _ = nearest_postures(exact, query, n_looked_at=size)
        slow = perf_counter() - started
        overlaps = [len(set(a) & set(b)) / 30 for a, b in zip(found, truth, strict=True)]
        times = [1e3 * each / N_QUERIES for each in (fast, slow)]
        rows[f"{size:,}"] = [*map(number, times), f"{np.mean(overlaps):.3f}"]
    header = ["postures", "ours, ms per frame", "each pose, ms", "true neighbors found"]
    return "**Search in large libraries** (30 neighbors)\n\n" + table(header, rows) + "\n"


def _mixed(
    library: PostureLibrary, size: int, random: np.random.Generator
) -> tuple[Single, Single]:
    """More postures: each between two similar ones of the library, with limbs of others."""
    first = random.integers(library.n_postures, size=size)
    limbs = random.integers(library.n_postures, size=(size, 4))
    directions, changes = library.directions[first].copy(), library.changes[first].copy()
    for limb in range(4):
        bones = slice(4 + 4 * limb, 8 + 4 * limb)
        swapped = random.uniform(size=size) < 0.3
        directions[swapped, bones] = library.directions[limbs[swapped, limb], bones]
        changes[swapped, bones] = library.changes[limbs[swapped, limb], bones]
    directions = directions + random.normal(scale=0.05, size=directions.shape)
    directions[:, 0] = 0.0
    sizes = np.linalg.norm(directions, axis=-1, keepdims=True)
    directions /= np.where(sizes > 0.0, sizes, 1.0)
    return directions.astype(np.float32), changes


def _query(body: BodyPostures, random: np.random.Generator) -> PostureQuery:
    reliability = random.uniform(0.5, 1.0, size=body.positions.shape[:2])
    for frame, limb in enumerate(random.integers(5, size=len(reliability))):
        reliability[frame, 4 + 4 * limb : 8 + 4 * limb] = 0.0
    positions, speeds = body.positions.astype(np.float64), body.speeds.astype(np.float64)
    return PostureQuery(positions, speeds, reliability, 0.2)


def _report_done(what: str) -> None:
    print(f"Done: {what}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
