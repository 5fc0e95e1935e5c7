"""Time what a benchmark compares."""

from collections.abc import Callable
from time import perf_counter


def run_times(
    work: Callable[[], object], n_runs: int, clock: Callable[[], float] = perf_counter
) -> list[float]:
    """Return the seconds of each of several runs."""
    times = []
    for _ in range(n_runs):
        started = clock()
        work()
        times.append(clock() - started)
    return times
