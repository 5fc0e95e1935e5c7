"""Learn when a tracked pose is wrong, and print the numbers of failure_test.py.

    make failures

From trackers that follow the sequences of tests/benchmarks/depth/depth_tuning.py; true joints
are known.
"""

from solvers.depth_tracking.tracking.failure_test import FEATURES

from ..benchmarks.depth.depth_tuning import TAKES, tuning_sequence
from ..benchmarks.depth.failures import MIN_FAILURE_ERROR_M, failure_cases, learned


def main() -> None:
    """Track, learn and print."""
    found = failure_cases(tuning_sequence(name) for name in TAKES)
    failed = found.errors > MIN_FAILURE_ERROR_M
    print(f"{failed.sum()} of {len(failed)} poses have failed")
    *weights, bias = learned(found.features, failed)
    for name, weight in zip(FEATURES, weights, strict=True):
        print(f"{weight:7.2f}  {name}")
    print(f"{bias:7.2f}  bias")


if __name__ == "__main__":
    main()
