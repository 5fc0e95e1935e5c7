r"""Denoising and gap filling against every filter that an animator has, side by side.

    python -m tests.benchmarks.denoise.bench_denoise  # a few minutes, quick selection
    python -m tests.benchmarks.denoise.bench_denoise --full          # all scored clips
    python -m tests.benchmarks.denoise.bench_denoise --part gaps     # one part only
    python -m tests.benchmarks.denoise.bench_denoise --docs  # docs/benchmarks/denoising.md

While working on the method, on development clips only, a run of seconds:

    python -m tests.benchmarks.denoise.bench_denoise --dev --part walks --clips 4 \
        --only ours,published --levels 3:0,3:0.1

`--only` takes ours, alone (ours without examples), published, or any part of a peer's name;
`--levels` takes sigma:fraction pairs, `--clean-root` leaves the root's position unspoilt.
Which clips are for development is fixed in clips.py, what is damaged in noise.py.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from time import perf_counter
from typing import Any

from ..markers.part_markers import FILLERS as MARKER_FILLERS
from ..markers.part_markers import compare_markers
from ..shared import clips
from ..shared.noise import BURSTS as SPAN
from ..shared.report import Report
from ..shared.tables import Scores, table
from .cases import BURSTS, LEVELS, Case, Level
from .methods import Method
from .ours import OURS, SHORT_NAMES
from .part_bases import compare_counts, compare_cycles
from .part_classes import class_cases, compare_classes
from .part_denoise import compare, leave_one_out, peers
from .part_gaps import FILLERS, compare_gaps
from .part_library import compare_libraries
from .part_speed import measure_speed
from .part_windows import compare_priors, compare_windows

QUICK_CLASS_CLIPS, FULL_CLASS_CLIPS = 2, 6
QUICK_LIBRARY_CLIPS, FULL_LIBRARY_CLIPS = 1, 3
QUICK_MARKER_GAPS, FULL_MARKER_GAPS = 6, 25
WINDOW_CLIPS, PRIOR_CLIPS = 3, 6


def main() -> None:
    """Run the chosen parts, print their tables, and perhaps write them down."""
    chosen = _arguments()
    started = perf_counter()
    report = Report(chosen.docs)
    for name, part in PARTS.items():
        if name in chosen.part or "all" in chosen.part:
            began = perf_counter()
            report.part(name, part(chosen), perf_counter() - began)
    print(f"{perf_counter() - started:.0f} s in all")


def walking(chosen: argparse.Namespace) -> list[Scores]:
    """Noise and outliers on CMU walks."""
    names = _walks(chosen)
    cases = leave_one_out(clips.walks(), names, chosen.levels, chosen.clean_root)
    return compare(cases, _wanted(chosen, cases), f"CMU walks, {len(names)} clips")


def strangers(chosen: argparse.Namespace) -> list[Scores]:
    """CMU walks again, but no example is of the person who is cleaned."""
    names = _walks(chosen)
    levels = [Level(3.0), Level(3.0, 0.10), Level(3.0, drifts=True)]
    cases = leave_one_out(clips.walks(), names, levels, chosen.clean_root, other_subjects=True)
    title = f"CMU walks, {len(names)} clips, leave one subject out"
    return compare(cases, _wanted(chosen, cases, blender=False), title)[:1]


def bursts(chosen: argparse.Namespace) -> list[Scores]:
    """CMU walks whose joints are thrown off for a few frames at a time."""
    names = _walks(chosen)
    cases = leave_one_out(clips.walks(), names, BURSTS, chosen.clean_root)
    title = f"CMU walks, {len(names)} clips, joints off for {SPAN[0]} to {SPAN[1]} frames"
    return compare(cases, _wanted(chosen, cases), title)[:1]


def classes(chosen: argparse.Namespace) -> list[Scores]:
    """Noise and outliers on HDM05."""
    most = FULL_CLASS_CLIPS if chosen.full else QUICK_CLASS_CLIPS
    cases = class_cases(chosen.clips or most, chosen.dev)
    flat = [case for several in cases.values() for case in several]
    return compare_classes(cases, _wanted(chosen, flat))


def gaps(chosen: argparse.Namespace) -> list[Scores]:
    """Lost joints on CMU walks."""
    cases = leave_one_out(clips.walks(), _walks(chosen), [Level(0.0)], clean_root=True)
    return compare_gaps(cases, _named(chosen, FILLERS))


def library(chosen: argparse.Namespace) -> list[Scores]:
    """Examples that a library finds."""
    most = FULL_LIBRARY_CLIPS if chosen.full else QUICK_LIBRARY_CLIPS
    return compare_libraries(chosen.clips or most, chosen.dev, chosen.full)


def markers(chosen: argparse.Namespace) -> list[Scores]:
    """Lost optical markers."""
    draws = chosen.clips or (FULL_MARKER_GAPS if chosen.full else QUICK_MARKER_GAPS)
    return compare_markers(_named(chosen, MARKER_FILLERS), draws, chosen.dev)


def speed(chosen: argparse.Namespace) -> list[str]:
    """Seconds and megabytes."""
    return [measure_speed()]


def windows(chosen: argparse.Namespace) -> list[Scores]:
    """Lengths of the patterns."""
    return compare_windows(_walks(chosen)[: None if chosen.full else WINDOW_CLIPS])


def bases(chosen: argparse.Namespace) -> list[Scores | str]:
    """Numbers of filter bases."""
    return compare_counts(_walks(chosen))


def cycles(chosen: argparse.Namespace) -> list[Scores]:
    """Lengths of the patterns on movements of a long and of a short cycle."""
    return compare_cycles()


def priors(chosen: argparse.Namespace) -> list[Scores | str]:
    """Right and wrong examples."""
    scores, priors_used = compare_priors(_walks(chosen)[:PRIOR_CLIPS])
    sentences = {what: [sentence] for what, sentence in priors_used.items()}
    return [*scores, table(["target, examples", "prior in the report"], sentences)]


PARTS: dict[str, Callable[[argparse.Namespace], Sequence[Scores | str]]] = {
    "walks": walking,
    "strangers": strangers,
    "bursts": bursts,
    "classes": classes,
    "gaps": gaps,
    "windows": windows,
    "bases": bases,
    "cycles": cycles,
    "priors": priors,
    "library": library,
    "markers": markers,
    "speed": speed,
}


def _walks(chosen: argparse.Namespace) -> list[str]:
    select = clips.development if chosen.dev else clips.scored
    return select(chosen.full)[: chosen.clips]


def _wanted(
    chosen: argparse.Namespace, cases: list[Case], blender: bool = True
) -> dict[str, Method]:
    blender = blender and (not chosen.only or "lender" in chosen.only)
    return _named(chosen, {**peers(cases, blender), **OURS})


def _named(chosen: argparse.Namespace, methods: Mapping[str, Any]) -> dict[str, Any]:
    """Return the methods that `--only` asks for."""
    if not chosen.only:
        return dict(methods)
    asked = [SHORT_NAMES.get(one, one) for one in chosen.only.split(",")]
    return {
        name: method
        for name, method in methods.items()
        if any(one == name or (one not in OURS and one in name) for one in asked)
    }


def _levels(text: str) -> tuple[Level, ...]:
    return tuple(Level(*map(float, pair.split(":"))) for pair in text.split(","))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", nargs="+", default=["all"], choices=["all", *PARTS])
    parser.add_argument("--full", action="store_true", help="all scored clips")
    parser.add_argument("--dev", action="store_true", help="development clips only")
    parser.add_argument("--clips", type=int, default=None, help="at most this many clips")
    parser.add_argument("--only", default="", help="methods, separated by commas")
    parser.add_argument("--levels", type=_levels, default=LEVELS, help="such as 3:0,3:0.1")
    parser.add_argument("--clean-root", action="store_true")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/denoising.md"
    )
    return parser.parse_args()


if __name__ == "__main__":
    main()
