"""The detector in a process of its own."""

from concurrent.futures import BrokenExecutor, Future
from contextlib import ExitStack
from functools import cache
from types import TracebackType
from typing import Self

from ...depth_tracking.following import Detection, DetectionRequest, detect_in_image
from ...depth_tracking.forest import PixelForest, load_pixel_forest
from ...processes import worker_pool

MAX_CRASHES = 3
"""Number of crashes after which the detector is not started again. It guards a machine without
memory, on which it would only start and end."""


class DetectorProcess:
    """Detects poses with the shipped forest in another process, for `LiveTracker`.

    A process that crashes is started again, up to `MAX_CRASHES` times; the tracker goes on
    meanwhile.
    """

    def __init__(self) -> None:
        self.n_crashes = 0
        self._pending: Future[Detection] | None = None
        self._open()

    def _open(self) -> None:
        self._processes = ExitStack()
        self._pool = self._processes.enter_context(worker_pool(1))
        self._loading = self._pool.submit(_load)

    @property
    def is_idle(self) -> bool:
        """Whether it accepts a request."""
        if self._pending is not None or self.n_crashes >= MAX_CRASHES:
            return False
        return self._loading.done()

    def request(self, request: DetectionRequest) -> None:
        """Begin to detect a pose."""
        try:
            self._pending = self._pool.submit(_detect, request)
        except BrokenExecutor:
            self._restart()

    def poll(self) -> Detection | None:
        """Return the detection once it is ready, and only once; None before."""
        if self._pending is None or not self._pending.done():
            return None
        pending, self._pending = self._pending, None
        try:
            return pending.result()
        except BrokenExecutor:
            self._restart()
            return Detection(None)

    def wait(self) -> None:
        """Wait until it accepts a request, or its detection is ready."""
        (self._pending or self._loading).exception()

    @property
    def issue(self) -> str:
        """Why it does not work any more; empty if it does."""
        if self.n_crashes < MAX_CRASHES:
            return ""
        return (
            f"The process of the detector crashed {self.n_crashes} times, perhaps for lack of"
            " memory; poses after that were tracked without it."
        )

    def _restart(self) -> None:
        self.n_crashes += 1
        self.close()
        if self.n_crashes < MAX_CRASHES:
            self._open()

    def close(self) -> None:
        """End the process; may be repeated."""
        self._processes.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the process."""
        self.close()


@cache
def _forest() -> PixelForest:
    return load_pixel_forest()


def _load() -> None:
    """Import what detection needs, and load the forest."""
    _forest()


def _detect(request: DetectionRequest) -> Detection:
    return detect_in_image(request, _forest())
