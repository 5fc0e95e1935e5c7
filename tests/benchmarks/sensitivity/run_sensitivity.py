"""Vary each tuned constant by x0.5 and x2, and print how much the errors change.

    python -m tests.benchmarks.sensitivity.run_sensitivity                    # all families
    python -m tests.benchmarks.sensitivity.run_sensitivity --family feet      # one, a minute
    python -m tests.benchmarks.sensitivity.run_sensitivity --only window_estimates  # some
    python -m tests.benchmarks.sensitivity.run_sensitivity --docs   # benchmarks/sensitivity.md

What was measured is kept in build/sensitivity, one JSON file per family; a constant is measured
again when its value, the metric or the baseline has changed, and all are with `--again`.
"""

import argparse
import importlib
import json
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from . import evaluate as children
from .constants import FAMILIES, ROOT, Constant, constants_of, scaled
from .evaluate import Outcome
from .fixed_constants import reason
from .guards import WITHOUT
from .tables import Row, family_text, write_docs

BUILD = ROOT / "build" / "sensitivity"
FACTORS = (0.5, 2.0)


def main() -> None:
    """Measure the chosen families, print their tables, and perhaps write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--family", nargs="+", default=[], choices=FAMILIES)
    parser.add_argument("--only", default="", help="constants whose module and name hold this")
    parser.add_argument("--again", action="store_true", help="measure also what is known")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/sensitivity.md"
    )
    chosen = parser.parse_args()
    _import_what_solvers_need()
    for family in chosen.family or FAMILIES:
        if (Path(__file__).parent / "metrics" / f"{family}.py").exists():
            print(family_text(family, vary(family, chosen.only, chosen.again)))
    if chosen.docs:
        write_docs({family: known_rows(family) for family in FAMILIES})


def vary(family: str, only: str = "", again: bool = False) -> list[Row]:
    """Return a row per constant of a family; the baseline is measured twice."""
    inputs = children.prepare(family)
    baseline, repeated = (children.evaluate(family, inputs) for _ in range(2))
    if baseline.failure or baseline.figures != repeated.figures:
        raise SystemExit(f"{family}: {baseline.failure or 'two runs differ'}")
    stored = {} if again else _stored(family, baseline)
    print(f"{family}: {baseline.cpu_s:.1f} s each", file=sys.stderr, flush=True)
    for constant in _varied(family):
        if only in constant.key and _is_new(constant, stored):
            outcomes = [_outcome(family, inputs, constant, factor) for factor in FACTORS]
            if constant.key in WITHOUT:
                value = WITHOUT[constant.key]
                outcomes.append(children.evaluate(family, inputs, constant, value))
            stored[constant.key] = {
                "value": repr(constant.value),
                "outcomes": [asdict(each) for each in outcomes],
            }
            _store(family, baseline, stored)
    return known_rows(family)


def known_rows(family: str) -> list[Row]:
    """Return a row for each constant of a family that was measured and is still there."""
    path = BUILD / f"{family}.json"
    if not path.exists():
        return []
    found = json.loads(path.read_text(encoding="utf-8"))
    baseline = Outcome(**found["baseline"])
    rows = []
    for constant in _varied(family):
        if not _is_new(constant, found["constants"]):
            outcomes = found["constants"][constant.key]["outcomes"]
            rows.append(Row(constant, baseline, *(Outcome(**each) for each in outcomes)))
    return rows


def _varied(family: str) -> list[Constant]:
    return [each for each in constants_of(family) if not reason(each.key)]


def _outcome(family: str, inputs: bytes, constant: Constant, factor: float) -> Outcome:
    if scaled(constant.value, factor) == constant.value:
        return Outcome(failure="no smaller whole number")
    return children.evaluate(family, inputs, constant, scaled(constant.value, factor))


def _is_new(constant: Constant, stored: dict[str, Any]) -> bool:
    found = stored.get(constant.key, {})
    n_outcomes = len(FACTORS) + (constant.key in WITHOUT)
    return found.get("value") != repr(constant.value) or len(found["outcomes"]) != n_outcomes


def _stored(family: str, baseline: Outcome) -> dict[str, Any]:
    path = BUILD / f"{family}.json"
    found = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    same = found.get("baseline", {}).get("figures") == baseline.figures
    return dict(found["constants"]) if same else {}


def _store(family: str, baseline: Outcome, stored: dict[str, Any]) -> None:
    BUILD.mkdir(parents=True, exist_ok=True)
    now = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())
    outcome = {"measured": now, "baseline": asdict(baseline), "constants": stored}
    (BUILD / f"{family}.json").write_text(json.dumps(outcome, indent=1), encoding="utf-8")


def _import_what_solvers_need() -> None:
    """Import what children share by having been forked; no solver is among it."""
    for module in ("interpolate", "ndimage", "optimize", "signal", "sparse.linalg", "stats"):
        importlib.import_module(f"scipy.{module}")


if __name__ == "__main__":
    main()
