"""The clock by which images are followed."""

from collections.abc import Callable
from time import monotonic, sleep, time
from typing import NamedTuple


class Clock(NamedTuple):
    """The time; a benchmark has one of its own."""

    now: Callable[[], float]
    """Returns seconds that always rise."""
    written: Callable[[], float]
    """Returns seconds as file systems count them."""
    sleep: Callable[[float], None]


SYSTEM_CLOCK = Clock(monotonic, time, sleep)
