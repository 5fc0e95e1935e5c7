"""Rebuilding what a Kinect saw, against the published methods and peers.

    make bench-reconstruct                                   # an hour
    make bench-reconstruct ARGUMENTS="--takes 1"             # a tenth of the takes
    make bench-reconstruct ARGUMENTS="--part kinect --docs"  # docs/benchmarks/reconstruction.md

Priors are learned without the tested subject, and cached in build/reconstruct.
"""

import argparse
from collections.abc import Callable, Sequence
from time import perf_counter

from ..shared.report import DOCS, Report
from . import (
    part_blender,
    part_figures,
    part_kinect,
    part_losses,
    part_real,
    part_subsets,
    part_terms,
    part_twist,
)
from .bench_reliability import report_reliability

Part = Callable[[int], Sequence[str]]

PARTS: dict[str, Part] = {
    "blender": part_blender.blender,
    "rest": part_blender.rest,
    "kinect": part_kinect.accuracy,
    "losses": part_losses.losses,
    "damages": part_losses.damages,
    "subsets": part_subsets.subsets,
    "terms": part_terms.terms,
    "confidence": part_terms.confidence,
    "twist": part_twist.twist,
    "real": part_real.recordings,
    "search-figures": part_figures.search_figures,
    "motion-figures": part_figures.motion_figures,
}
RELIABILITY = "reliability"
"""Its tables are in docs/technical/reliability.md; `make bench-reliability` makes only them."""


def main() -> None:
    """Print the tables of the requested parts."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parts = [*PARTS, RELIABILITY]
    parser.add_argument("--part", choices=parts, action="append", help="all by default")
    parser.add_argument("--takes", type=int, default=10, help="repetitions of each exercise")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/reconstruction.md"
    )
    chosen = parser.parse_args()
    report = Report(chosen.docs, DOCS / "benchmarks" / "reconstruction.md")
    for name in chosen.part or parts:
        if name == RELIABILITY:
            report_reliability(chosen.docs)
            continue
        started = perf_counter()
        tables = PARTS[name](chosen.takes)
        report.part(name, tables, perf_counter() - started)


if __name__ == "__main__":
    main()
