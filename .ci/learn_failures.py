"""Learn when a tracked pose is wrong, and print the numbers of failure_test.py.

    python .ci/learn_failures.py

From trackers that follow the sequences of tests/benchmarks/depth_tuning.py, whose true joints
are known.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from solvers.depth_tracking.failure_test import FEATURES  # noqa: E402
from tests.benchmarks.depth_tuning import TAKES, tuning_sequence  # noqa: E402
from tests.benchmarks.failures import WRONG, judged, learned  # noqa: E402


def main() -> None:
    """Track, learn and print."""
    found = judged(tuning_sequence(name) for name in TAKES)
    failed = found.errors > WRONG
    print(f"{failed.sum()} of {len(failed)} poses have failed")
    *weights, bias = learned(found.features, failed)
    for name, weight in zip(FEATURES, weights, strict=True):
        print(f"{weight:7.2f}  {name}")
    print(f"{bias:7.2f}  bias")


if __name__ == "__main__":
    main()
