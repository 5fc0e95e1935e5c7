"""Run long work in time slices of the main thread, so that the window stays responsive."""

from collections.abc import Callable, Generator
from concurrent.futures import ThreadPoolExecutor, wait
from functools import update_wrapper
from math import inf
from time import monotonic
from typing import Any, Generic, ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
Steps = Generator[float, None, Result]
"""Generator that yields the completed fraction whenever `should_yield` is true.

Blender runs between two slices. Pointers to its data are then stale: look them up again.
"""

_deadline, _asked_at = [inf], [inf]


def should_yield() -> bool:
    """Return whether the work should yield now; never while a script waits for it.

    It should before another part as long as the last one, since the question before, would end
    after the time slice.
    """
    now = monotonic()
    last_part, _asked_at[0] = now - _asked_at[0], now
    return now + last_part > _deadline[0]


def runs_in_slices() -> bool:
    """Return whether the window waits for its turn; a script waits for the end."""
    return _deadline[0] < inf


SHORT_WAIT_S = 0.005
"""Seconds that the window waits for work in a thread before it goes on without. Measured: takes
of 300 frames are hashed in 1 ms, so that they need no other time slice."""


class Sliced(Generic[Parameters, Result]):
    """Decorate a generator function. A call runs it to the end and returns its result."""

    def __init__(self, steps: Callable[Parameters, Steps[Result]]) -> None:
        self.steps = steps
        update_wrapper(self, steps)

    def __call__(self, *arguments: Parameters.args, **named: Parameters.kwargs) -> Result:
        return _run_to_end(self.steps(*arguments, **named), inf)


@Sliced
def in_thread(function: Callable[[], Result], fraction: float = 1.0) -> Steps[Result]:
    """Call a function that needs nothing of Blender, while Blender's window works.

    It helps only where Python's lock is released: in NumPy, in hashes and with files.
    """
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(function)
        while True:
            if wait([future], None if _deadline[0] == inf else SHORT_WAIT_S).done:
                break
            yield fraction
    if should_yield():
        yield fraction
    return future.result()


class Work(Generic[Result]):
    """A call that runs in time slices.

    Parameters
    ----------
    function : a `Sliced` function, or another one, which then runs in one slice
    arguments : its arguments
    """

    def __init__(self, function: Callable[..., Result], *arguments: Any) -> None:
        self._steps: Steps[Result] = (
            function.steps(*arguments)
            if isinstance(function, Sliced)
            else _in_one_slice(function, arguments)
        )
        self.fraction = 0.0
        self.result: Result

    def run_slice(self, seconds: float) -> bool:
        """Work for about this many seconds; return whether `result` is complete."""
        _asked_at[0] = monotonic()
        _deadline[0] = _asked_at[0] + seconds
        try:
            self.fraction = next(self._steps)
        except StopIteration as end:
            self.result = end.value
            return True
        finally:
            _deadline[0] = inf
        return False

    def stop(self) -> None:
        """Cancel the work; the function cleans up."""
        self._steps.close()


def _in_one_slice(function: Callable[..., Result], arguments: tuple[Any, ...]) -> Steps[Result]:
    yield from ()
    return function(*arguments)


def _run_to_end(steps: Steps[Result], deadline: float) -> Result:
    before, _deadline[0] = _deadline[0], deadline
    try:
        next(steps)
    except StopIteration as end:
        result: Result = end.value
        return result
    finally:
        _deadline[0] = before
    raise AssertionError("sliced work has yielded in a call that cannot yield")
