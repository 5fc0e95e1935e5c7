"""An index on workers: clips per minute, what grows with the clips, and searches of shards."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from time import perf_counter

import numpy as np
from clusters.dask_cluster import local_cluster

from solvers.recordings import read_tracked, write_bvh
from solvers.retrieval import (
    Clip,
    ClipLibrary,
    FindSettings,
    FoundClip,
    describe_clip,
    find_in_libraries,
    find_similar,
    load_clip_library,
    open_clip_library,
)
from solvers.samples import GaitSettings, walking_gait

from ..shared.clips import HDM05
from ..shared.tables import table

N_DIFFERENT = 100
"""Different made walks; others are copies under names of their own."""
CLIP_S = 2.0
N_TIMED = 400
"""Clips that are indexed with each number of workers."""
N_BEFORE = 40
"""Clips that the workers of a cluster read before, so that they have imported all modules."""
SIZES = (500, 1_000, 2_000, 4_000)
N_SHARDS = 4
FILES_STEP = 6
"""Every sixth clip of HDM05 is cut into the clips of the shards."""
N_EXCERPTS = 32
"""Clips that are cut from each."""
N_QUERIES = 20
FOUND = FindSettings(n_matches=10)


def measure_index(folder: Path) -> list[str]:
    """Return the tables."""
    walks = _write_walks(folder / "walks", max(SIZES))
    return [_throughput(folder, walks[:N_TIMED]), _growth(folder, walks), _shards(folder)]


def _throughput(folder: Path, walks: Sequence[Path]) -> str:
    """Return the table of clips per minute, with what a library differs in."""
    takes, few = (
        _link_walks(folder / "timed", walks),
        _link_walks(folder / "few", walks[:N_BEFORE]),
    )
    first, rows = b"", {}
    for n_workers in (1, 2):
        local, cluster = folder / f"local{n_workers}.clips", folder / f"{n_workers}.clips"
        seconds = _index(local, takes, "--jobs", str(n_workers))[0]
        with local_cluster(n_workers) as address:
            _index(folder / f"before{n_workers}.clips", few, "--cluster", address)
            on_cluster = _index(cluster, takes, "--cluster", address)[0]
        first = first or local.read_bytes()
        same = [path.read_bytes() == first for path in (local, cluster)]
        rows[str(n_workers)] = [
            f"{60 * len(walks) / seconds:,.0f}",
            f"{60 * len(walks) / on_cluster:,.0f}",
            f"{on_cluster - seconds:+.1f}",
            "yes" if all(same) else "no",
        ]
    head = [
        "workers", "--jobs, clips/min", "--cluster, clips/min", "--cluster takes longer, s",
        "same bytes",
    ]  # fmt: skip
    return f"**Index of {len(walks)} walks of {CLIP_S:g} s at 30 Hz**\n\n{table(head, rows)}\n"


def _growth(folder: Path, walks: Sequence[Path]) -> str:
    """Return the table of one library that grows."""
    takes, library, before, rows = folder / "growing", folder / "growing.clips", 0, {}
    for size in SIZES:
        _link_walks(takes, walks[before:size])
        seconds, memory_mb = _index(library, takes, "--jobs", "2")
        with load_clip_library(library) as opened:
            search_ms = _search_ms(opened, walks)
        rows[f"{size:,}"] = [
            f"{1000 * seconds / (size - before):.1f}",
            f"{library.stat().st_size / size / 1000:.1f}",
            f"{memory_mb:.0f}",
            f"{search_ms:.1f}",
        ]
        before = size
    head = ["clips", "to add one, ms", "size of one, kB", "memory, MB", "to search, ms"]
    return f"**A library that grows, with --jobs 2**\n\n{table(head, rows)}\n"


def _search_ms(library: ClipLibrary, walks: Sequence[Path]) -> float:
    """Return the median time of a search once the library is open."""
    queries = [read_tracked(path) for path in walks[:N_QUERIES]]
    find_similar(queries[0], library, settings=FOUND)
    times = []
    for query in queries:
        began = perf_counter()
        find_similar(query, library, settings=FOUND)
        times.append(perf_counter() - began)
    return 1000.0 * float(np.median(times))


def _shards(folder: Path) -> str:
    """Return the table of the same clips in one library and in several."""
    excerpts = _excerpts()
    clips = [describe_clip(clip) for clip in excerpts]
    with open_clip_library(folder / "first.clips") as first:
        first.add_described(clips[::N_SHARDS])
        vocabulary = first.vocabulary
    assert vocabulary is not None
    bounds = np.linspace(0, len(clips), N_SHARDS + 1).astype(int)
    layouts = {
        "1 library": [(0, len(clips))],
        f"{N_SHARDS} libraries": list(pairwise(bounds)),
    }
    rows, expected = {}, list[list[FoundClip]]()
    chosen = np.linspace(0, len(excerpts) - 1, N_QUERIES).astype(int)
    queries = [excerpts[number].recording for number in chosen]
    for name, ranges in layouts.items():
        paths = [folder / f"{name} {number}.clips" for number in range(len(ranges))]
        for path, (start, stop) in zip(paths, ranges, strict=True):
            with open_clip_library(path) as library:
                library.freeze_vocabulary(vocabulary)
                library.add_described(clips[start:stop])
        times, found = [], []
        for query in queries:
            began = perf_counter()
            found.append(list(find_in_libraries(query, paths, settings=FOUND)))
            times.append(perf_counter() - began)
        expected = expected or found
        n_same = sum(map(_is_same, found, expected))
        rows[name] = [f"{1000 * np.median(times):.0f}", f"{n_same} of {len(queries)}"]
    head = ["", "to open and search, ms", "same ten results"]
    title = f"**{len(clips):,} excerpts of takes of HDM05, with one vocabulary**"
    return f"{title}\n\n{table(head, rows)}\n"


def _is_same(found: Sequence[FoundClip], expected: Sequence[FoundClip]) -> bool:
    one, other = (
        [(each.match.clip, each.match.frames, round(each.match.score, 5)) for each in results]
        for results in (found, expected)
    )
    return one == other


def _excerpts() -> list[Clip]:
    """Return clips of one second that overlap."""
    found = list[Clip]()
    for path in sorted(HDM05.glob("*.amc"))[::FILES_STEP]:
        take = read_tracked(path)
        length = min(round(take.frame_rate), take.n_frames)
        starts = np.linspace(0, take.n_frames - length, N_EXCERPTS).astype(int)
        for number, start in enumerate(starts.tolist()):
            excerpt = take.slice(start, start + length)
            found.append(Clip(f"{path.stem} {number:02}", excerpt))
    return found


def _write_walks(folder: Path, n_walks: int) -> list[Path]:
    """Write made walks, all under different names."""
    folder.mkdir()
    rng, paths = np.random.default_rng(0), [folder / f"{n:05}.bvh" for n in range(n_walks)]
    for number, path in enumerate(paths):
        if number < N_DIFFERENT:
            settings = GaitSettings(
                duration=CLIP_S, frame_rate=30.0, seed=number,
                speed=rng.uniform(0.6, 1.5), cadence=rng.uniform(100.0, 140.0),
            )  # fmt: skip
            write_bvh(walking_gait(settings), path)
        else:
            shutil.copy(paths[number % N_DIFFERENT], path)
    return paths


def _link_walks(folder: Path, walks: Sequence[Path]) -> Path:
    """Return a folder with links to walks."""
    folder.mkdir(exist_ok=True)
    for path in walks:
        os.link(path, folder / path.name)
    return folder


def _index(library: Path, takes: Path, *options: str) -> tuple[float, float]:
    """Run `index`; return its seconds, and its peak memory in megabytes."""
    words = [sys.executable, "-m", "solvers", "index", str(library), str(takes), *options]
    began = perf_counter()
    process = subprocess.Popen([*words, "--json"], stdout=subprocess.PIPE)
    assert process.stdout
    assert not json.loads(process.stdout.read())["refused"]
    used = os.wait4(process.pid, 0)[2]
    return perf_counter() - began, used.ru_maxrss / 1000.0
