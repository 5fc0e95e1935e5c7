"""A solve running in a process of its own. Knows nothing about Blender."""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep
from typing import Any, Generic, TypeVar

from ...solvers.errors import MocapAssistError, SolveCancelled
from ...solvers.progress import Progress, unwatched
from .protocol import LOG, REQUEST, RESULT, last_progress, last_words, read_shown

Result = TypeVar("Result")
EXTENSION = __name__.rsplit(".", 3)[0]
CHILD = Path(__file__).with_name("child.py")
BETWEEN_LOOKS = 0.05  # seconds
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
}
OURS = {"PYTHONUTF8": "1", "PYTHONNOUSERSITE": "1"}
# Neither what the user installed for a Python of his own, nor the script's folder is looked in.
ALONE = ("-s", "-P")
NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # no console flashes up on Windows


class ProcessDied(MocapAssistError):
    """The process of a solve ended without an answer.

    Parameters
    ----------
    cause : str
        How it ended: "with status 1".
    said : str
        The last line that it printed, if any.
    """

    def __init__(self, cause: str, said: str) -> None:
        self.cause = cause
        self.last_words = f" Its last words: {said}" if said else ""
        super().__init__(
            f"The solver process ended early, {cause}. Nothing was changed.{self.last_words}"
        )


class Quick(partial[Result]):
    """A solve that is so short that it needs no process of its own."""


def run(
    solve: Callable[..., Result],
    progress: Progress = unwatched,
    program: Sequence[str] = (),
) -> Result:
    """Solve and wait for the result, in a process of its own unless the solve is quick.

    In that process linear algebra has one thread, whatever Blender's has: on matrices of this
    size two threads were seen to take thirty times as long, and give other last bits.
    """
    if isinstance(solve, Quick):
        return solve(progress=progress)
    job = Job(solve, program)
    try:
        while not job.done():
            progress(*job.progress())
            sleep(BETWEEN_LOOKS)
    except BaseException:  # such as SolveCancelled, or Ctrl C
        job.cancel()
        job.tidy_up()
        raise
    return job.result()


class Job(Generic[Result]):
    """Start `solve(progress=…)`; ask `done` now and then; fetch `result` once.

    `solve` must be picklable. A crash of its process, or a lack of memory, leaves this one
    unharmed. `program` is the command that runs it, by default a bare Python with child.py.
    """

    def __init__(self, solve: Callable[..., Result], program: Sequence[str] = ()) -> None:
        self.cancelled = False
        self._n_shown = 0
        # On Windows a file that is still open cannot be removed; that is no reason to fail.
        self._folder = TemporaryDirectory(prefix="mocap_assist_", ignore_cleanup_errors=True)
        self._path = Path(self._folder.name)
        (self._path / REQUEST).write_bytes(pickle.dumps(solve))
        with (self._path / LOG).open("wb") as log:
            self._process = subprocess.Popen(
                [*(program or alone(CHILD)), str(self._path), EXTENSION],
                stdin=subprocess.PIPE,  # nothing is said: it closes when this process ends
                stdout=log,
                stderr=subprocess.STDOUT,
                creationflags=NO_WINDOW,
                env=os.environ | ONE_THREAD | OURS | {"PYTHONPATH": _search_path()},
            )

    def progress(self) -> tuple[float, str]:
        """Return the last fraction, 0 to 1, and message of the solver."""
        return last_progress(self._path)

    def shown(self) -> list[Any]:
        """Return what a `Showing` solve has shown since this was asked last."""
        things, self._n_shown = read_shown(self._path, self._n_shown)
        return things

    def all_shown(self) -> list[Any]:
        """Wait for the end, and return all that a `Showing` solve has shown."""
        self._process.wait()
        return read_shown(self._path, 0)[0]

    def done(self) -> bool:
        """Whether the process has ended, in whatever way."""
        return self._process.poll() is not None

    def cancel(self) -> None:
        """End the process at once; `result` then raises SolveCancelled."""
        self.cancelled = True
        self._process.kill()

    def tidy_up(self) -> None:
        """Remove the job's folder once its process has ended."""
        self._process.wait()
        if self._process.stdin is not None:
            self._process.stdin.close()
        self._folder.cleanup()

    def result(self) -> Result:
        """Wait for the end, tidy up, and return what the solver returned.

        Raises
        ------
        SolveCancelled
            `cancel` was called.
        ProcessDied
            It has left no answer.
        MocapAssistError
            Or whatever the solver itself raised.
        """
        status = self._process.wait()
        said, answer = last_words(self._path), self._path / RESULT
        outcome: Any = None
        if answer.exists() and not self.cancelled:
            with answer.open("rb") as file:
                outcome = pickle.load(file)
        self.tidy_up()
        if self.cancelled:
            raise SolveCancelled("Cancelled.")
        if outcome is None:
            raise ProcessDied(_cause(status), said)
        if isinstance(outcome, Exception):
            raise outcome
        result: Result = outcome[0]
        return result


def alone(script: Path) -> tuple[str, ...]:
    """Return the command that runs a script in a Python that sees nothing of the user's."""
    return (_python(), *ALONE, str(script))


def _python() -> str:
    if not sys.executable:
        raise MocapAssistError("This Blender does not say where its Python is; reinstall it.")
    return sys.executable


def _search_path() -> str:
    """Where this process finds modules, the extension's wheels too; not the present folder.

    Blender's scripts come last: in one that is a module of Python they would hide that.
    """
    paths = sorted(filter(None, sys.path), key=lambda path: "scripts" in Path(path).parts)
    return os.pathsep.join(paths)


def _cause(status: int) -> str:
    cause = f"with status {status}"
    if status < 0:
        cause = f"by signal {signal.Signals(-status).name}"
        if -status == signal.SIGKILL:
            cause += ", which often means that memory ran out"
    return cause
