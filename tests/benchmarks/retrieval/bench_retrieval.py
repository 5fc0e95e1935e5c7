"""Finding clips of the same class: ours, [ZLLS14] as published, and peers.

make bench-retrieval                                # some 20 minutes
make bench-retrieval ARGUMENTS="--method DTW"       # those with this in their name
make bench-retrieval ARGUMENTS=--docs               # into docs/benchmarks/retrieval.md
make bench-retrieval ARGUMENTS=--choose             # settings of pyramids, training classes
make bench-retrieval ARGUMENTS=--pursuit            # sparse codes, against scikit-learn's
make bench-retrieval ARGUMENTS=--times              # one search, step by step

Answers of methods are stored under build/retrieval; tables show all stored methods.
"""

import argparse
import sys
from collections.abc import Callable
from time import perf_counter

from ..shared.report import DOCS, Report
from . import part_retrieval as part
from .part_retrieval_choice import choose
from .part_retrieval_times import time_searches
from .part_sparse_codes import compare_pursuits
from .retrieval_methods import METHODS


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--method", default="", help="query only those with this in their name again"
    )
    parser.add_argument("--jobs", type=int, default=2, help="methods at a time")
    parser.add_argument("--choose", action="store_true", help="settings of pyramids")
    parser.add_argument("--pursuit", action="store_true", help="time of sparse codes")
    parser.add_argument("--times", action="store_true", help="one search, step by step")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/retrieval.md"
    )
    chosen = parser.parse_args()
    report = Report(chosen.docs, DOCS / "benchmarks" / "retrieval.md")
    started = perf_counter()
    separate: dict[str, Callable[[], str]] = {
        "choice": lambda: choose()[1], "pursuit": compare_pursuits, "times": time_searches,
    }  # fmt: skip
    requested = {"choice": chosen.choose, "pursuit": chosen.pursuit, "times": chosen.times}
    for name in [name for name, wanted in requested.items() if wanted]:
        tables = [separate[name]()]
        report.part(name, tables, perf_counter() - started)
        return
    names = [name for name in METHODS if chosen.method.lower() in name.lower()]
    part.find_all(names, chosen.jobs, _report_done)
    found = part.cached_results()
    tables = [part.accuracy(found), part.damaged(found), part.accuracy_on_kinect(found),
              part.each_class(found)]  # fmt: skip
    if chosen.docs:
        tables.append(part.pictures(found))
    report.part("retrieval", tables, perf_counter() - started)


def _report_done(what: str) -> None:
    print(f"Done: {what}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
