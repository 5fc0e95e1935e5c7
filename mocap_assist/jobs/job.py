"""Run a solve in a subprocess; independent of Blender."""

import signal
import subprocess
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from time import sleep
from typing import Any, Generic, TypeVar

from ...solvers.errors import MocapAssistError, OutOfMemoryError, SolveCancelled
from ...solvers.files import reason_of
from ...solvers.progress import Progress, unwatched
from .child_process import ChildProcess
from .protocol import (
    GOES_ON,
    REQUEST,
    RESULT,
    EndableSolve,
    Ending,
    last_output,
    last_progress,
    previews_file,
    read_previews,
    read_value,
    write_value,
)
from .waiting_child import is_waiting, take_waiting

Result = TypeVar("Result")
POLL_INTERVAL_S = 0.05
"""Seconds between two looks at a process. It bounds the delay of a result."""
SHORT_WAIT_S = 0.02
"""Seconds that the window waits for a result to be read before it goes on without. Measured:
results of 300 frames are read in less, which saves a look of 0.05 s."""
EXIT_TIMEOUT_S = 0.25
"""Seconds that a process may take to exit after it wrote its result. It bounds the wait for one
that hangs."""


class ProcessDied(MocapAssistError):
    """The process of a solve ended without a result.

    Parameters
    ----------
    cause : str
        How it ended: "exit status 1".
    last_output : str
        The last line that it printed, if any.
    """

    def __init__(self, cause: str, last_output: str) -> None:
        self.cause = cause
        self.last_output = f" Last output: {last_output}" if last_output else ""
        super().__init__(
            f"The solver process ended early: {cause}. Nothing was changed.{self.last_output}"
        )


MAX_SHORT_SOLVE_FRAMES = 5000
"""Number of frames up to which feet are planted, or a take retargeted, without another process
if none waits. Chosen by hand: they are solved in 0.5 s to 2.5 s, and a process needs 1 s to
start."""


class ShortSolve(partial[Result]):
    """A solve that is short enough to run in Blender's process."""


def runs_here(solve: Callable[..., Any]) -> bool:
    """Return whether a press solves in Blender's process: it is short, and no other waits."""
    return isinstance(solve, ShortSolve) and not is_waiting()


def run(
    solve: Callable[..., Result],
    progress: Progress = unwatched,
    program: Sequence[str] = (),
) -> Result:
    """Solve and wait for the result, in a subprocess unless it is a `ShortSolve`."""
    if not isinstance(solve, ShortSolve):
        return run_in_subprocess(solve, progress, program)
    with _convert_memory_errors():
        result: Result = solve(progress=progress)
    return result


def run_in_subprocess(
    solve: Callable[..., Result],
    progress: Progress = unwatched,
    program: Sequence[str] = (),
    *,
    n_threads: int = 1,
) -> Result:
    """Solve in a subprocess, and wait for the result."""
    job = Job(solve, program, n_threads=n_threads)
    try:
        while not job.done():
            progress(*job.progress())
            sleep(POLL_INTERVAL_S)
    except BaseException:  # such as SolveCancelled, or Ctrl C
        job.cancel()
        job.tidy_up()
        raise
    return job.result()


class Job(Generic[Result]):
    """Start `solve(progress=…)`; poll `done`; fetch `result` once.

    A crash or a lack of memory in its process does not affect this process.

    Parameters
    ----------
    solve : callable
        Must be picklable.
    program : sequence of str
        Command that runs it; by default an isolated Python with child.py.
    n_threads : int
        Threads of linear algebra in that process: see `solvers.processes`.

    Raises
    ------
    MocapAssistError
        The process cannot be started: the disk is full, or memory is short.
    """

    def __init__(
        self,
        solve: Callable[..., Result],
        program: Sequence[str] = (),
        *,
        n_threads: int = 1,
    ) -> None:
        self.cancelled = False
        self._preview_offset, self._preview_number = 0, 0
        self._reading: Future[Any] | None = None
        is_default = not program and n_threads == 1
        self._child = (take_waiting() if is_default else None) or ChildProcess()
        self._path = self._child.path
        try:
            with _convert_memory_errors():
                write_value(self._path / REQUEST, solve)
            if isinstance(solve, EndableSolve):
                (self._path / GOES_ON).touch()
            if not self._child.wake():
                self._child.start(program, n_threads)
        except OSError as error:
            self._child.abandon()
            raise MocapAssistError(
                f"The solver process cannot be started: {reason_of(error)}"
                f" ({error.filename or self._path})."
            ) from None
        except BaseException:
            self._child.abandon()
            raise

    def progress(self) -> tuple[float, str]:
        """Return the last fraction, 0 to 1, and message of the solver."""
        return last_progress(self._path)

    def new_previews(self) -> list[Any]:
        """Return the previews of a `PreviewSolve` since the last call."""
        number = self._preview_number
        is_full = previews_file(self._path, number + 1).exists()
        previews, self._preview_offset = read_previews(self._path, self._preview_offset, number)
        if is_full:
            previews_file(self._path, number).unlink(missing_ok=True)
            self._preview_number, self._preview_offset = number + 1, 0
        return previews

    def all_previews(self) -> list[Any]:
        """Wait for the end, and return all previews of a `PreviewSolve`."""
        self._child.process.wait()
        return read_previews(self._path, 0)[0]

    def done(self) -> bool:
        """Return whether the result has been read, or the process ended without one.

        It is read in a thread, so that Blender's window does not wait for it.
        """
        if self._reading is None:
            if self.cancelled or not self._has_ended():
                return self._has_ended()
            reader = ThreadPoolExecutor(1)
            self._reading = reader.submit(self._outcome)
            reader.shutdown(wait=False)
            wait([self._reading], SHORT_WAIT_S)
        return self._reading.done()

    def end_early(self) -> None:
        """Ask an `EndableSolve` for its result so far; may be repeated.

        Raises
        ------
        OSError
            Its file cannot be removed now, such as on Windows while another program reads it.
        """
        (self._path / GOES_ON).unlink(missing_ok=True)

    def cancel(self) -> None:
        """End the process at once; `result` then raises SolveCancelled."""
        self.cancelled = True
        self._child.process.kill()

    def tidy_up(self) -> None:
        """Remove the job's folder once its process has ended."""
        self._child.tidy_up()

    def result(self) -> Result:
        """Wait for the end, remove the folder, and return the solver's result.

        Raises
        ------
        SolveCancelled
            `cancel` was called.
        ProcessDied
            It wrote no result.
        OutOfMemoryError
            It, or this process, has too little memory for the result.
        MocapAssistError
            The solver raised it.
        """
        try:
            reads = self._reading is not None and not self.cancelled
            outcome = self._reading.result() if self._reading and reads else self._outcome()
        finally:
            self.tidy_up()
        if isinstance(outcome, Exception):
            raise outcome
        result: Result = outcome[0]
        return result

    def _end(self) -> int:
        """Wait for the result and then for the end of the process; return its exit status.

        A process that wrote its result has finished: the wait for its exit is short.
        """
        while not self._has_ended():
            sleep(POLL_INTERVAL_S)
        try:
            return self._child.process.wait(EXIT_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._child.process.kill()
            return self._child.process.wait()

    def _has_ended(self) -> bool:
        """Return whether the result exists, or the process ended without one."""
        return (self._path / RESULT).exists() or self._child.process.poll() is not None

    def _outcome(self) -> Any:
        """Return the outcome of the process: an exception, or the result in a tuple."""
        status, result = self._end(), self._path / RESULT
        if self.cancelled:
            return SolveCancelled("Cancelled.")
        if result.exists():
            with _convert_memory_errors():
                return read_value(result)
        if status == Ending.OUT_OF_MEMORY:
            return OutOfMemoryError()
        if status == Ending.DISK_FULL:
            return MocapAssistError(
                f"The disk is full. Make room for temporary files in {self._path.parent}."
            )
        return ProcessDied(_cause(status), last_output(self._path))


@contextmanager
def _convert_memory_errors() -> Iterator[None]:
    """Convert a MemoryError to an OutOfMemoryError."""
    try:
        yield
    except MemoryError:
        raise OutOfMemoryError from None


def _cause(status: int) -> str:
    cause = f"exit status {status}"
    if status < 0:
        cause = f"signal {signal.Signals(-status).name}"
        if -status == signal.SIGKILL:
            cause += ", which often means that memory ran out"
    return cause
