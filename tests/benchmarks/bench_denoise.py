r"""Denoising and gap filling against every filter that an animator has, side by side.

    python -m tests.benchmarks.bench_denoise                 # a few minutes, quick selection
    python -m tests.benchmarks.bench_denoise --full          # all scored clips
    python -m tests.benchmarks.bench_denoise --part gaps     # one part only
    python -m tests.benchmarks.bench_denoise --docs          # also writes docs/benchmarks.md

While working on the method, on development clips only, a run of seconds:

    python -m tests.benchmarks.bench_denoise --dev --clips 4 --only ours,published \
        --levels 3:0,3:0.1

`--only` takes ours, alone (ours without a prior), published, or any part of a peer's name;
`--levels` takes sigma:fraction pairs, `--clean-root` leaves the root's position unspoilt.
Which clips are for development is fixed in clips.py, what is spoilt in noise.py.
"""

import argparse
from collections.abc import Callable
from time import perf_counter

from threadpoolctl import threadpool_limits

from . import clips
from .cases import LEVELS, Level
from .methods import Method
from .ours import OURS, SHORT_NAMES
from .part_denoise import compare, leave_one_out, peers
from .tables import Scores


def main() -> None:
    """Run the chosen parts and print their tables."""
    chosen = _arguments()
    started = perf_counter()
    with threadpool_limits(1):
        for name, part in PARTS.items():
            if name in chosen.part or "all" in chosen.part:
                for scores in part(chosen):
                    print(f"\n{scores.markdown()}", flush=True)
    print(f"{perf_counter() - started:.0f} s in all")


def walking(chosen: argparse.Namespace) -> list[Scores]:
    """Noise and outliers on CMU walks."""
    select = clips.development if chosen.dev else clips.scored
    names = select(chosen.full)[: chosen.clips]
    cases = leave_one_out(clips.walks(), names, chosen.levels, chosen.clean_root)
    return compare(cases, _wanted(chosen, cases), f"CMU walks, {len(names)} clips")


def _wanted(chosen: argparse.Namespace, cases: list) -> dict[str, Method]:
    if not chosen.only:
        return {**peers(cases), **OURS}
    asked = [SHORT_NAMES.get(one, one) for one in chosen.only.split(",")]
    everything = {**peers(cases, blender="lender" in chosen.only), **OURS}
    return {
        name: method
        for name, method in everything.items()
        if any(one == name or (one not in OURS and one in name) for one in asked)
    }


PARTS: dict[str, Callable[[argparse.Namespace], list[Scores]]] = {"walks": walking}


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
    return parser.parse_args()


if __name__ == "__main__":
    main()
