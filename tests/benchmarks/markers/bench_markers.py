"""Labels, rigid clusters and skeletons from optical markers, compared with simpler methods.

    make bench-markers                                # some minutes
    make bench-markers ARGUMENTS=--docs               # into docs/benchmarks/markers.md
    make bench-markers ARGUMENTS="--part skeleton"

Gaps of markers are measured by bench_denoise --part markers.
"""

import argparse
from collections.abc import Callable, Sequence
from time import perf_counter

from ..shared.report import DOCS, Report
from ..shared.tables import Scores
from .part_rigid import compare_rigid
from .part_skeleton import against_amc, against_simulated_bodies
from .part_swaps import compare_swaps, false_alarms

DRAWS, HARD_DRAWS = 6, 8
PARTS: dict[str, Callable[[], Sequence[Scores | str]]] = {
    "swaps": lambda: [
        compare_swaps(DRAWS, hard=False),
        compare_swaps(HARD_DRAWS, hard=True),
        false_alarms(),
    ],
    "rigid": lambda: [compare_rigid()],
    "skeleton": lambda: [
        *against_amc(),
        *(one.markdown() for one in against_simulated_bodies()),
    ],
}


def main() -> None:
    """Print the tables of each part."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--part", choices=PARTS, help="this part only")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/markers.md"
    )
    chosen = parser.parse_args()
    report = Report(chosen.docs, DOCS / "benchmarks" / "markers.md")
    for name in [chosen.part] if chosen.part else PARTS:
        started = perf_counter()
        report.part(name, PARTS[name](), perf_counter() - started)


if __name__ == "__main__":
    main()
