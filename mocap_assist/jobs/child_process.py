"""Start the process of a solve: at once, or ahead of it, with its imports done.

A process that waits reads its standard input: a byte means that its request has been written,
the end means that Blender has ended.
"""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from ...solvers.errors import MocapAssistError
from ...solvers.processes import ScratchFolder, thread_environment
from .protocol import LOG, WAIT

EXTENSION = __name__.rsplit(".", 3)[0]
CHILD = Path(__file__).with_name("child.py")
CHILD_ENVIRONMENT = {"PYTHONUTF8": "1", "PYTHONNOUSERSITE": "1"}
# Ignores user site-packages and the folder of the script.
ISOLATION_FLAGS = ("-s", "-P")
NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # no console flashes up on Windows


class ChildProcess:
    """A folder for a request and its result, and the process that works in it once begun.

    Raises
    ------
    InvalidFileError
        The folder cannot be made.
    """

    def __init__(self) -> None:
        self._scratch = ScratchFolder()
        self.path = self._scratch.path
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def process(self) -> "subprocess.Popen[bytes]":
        """The process; it must have been started."""
        assert self._process is not None
        return self._process

    def start(self, program: Sequence[str] = (), n_threads: int = 1, *more: str) -> None:
        """Start a process that solves the request in the folder; `more` is for child.py.

        Raises
        ------
        OSError
            The process cannot be started.
        """
        environment = (
            thread_environment(n_threads) | CHILD_ENVIRONMENT | {"PYTHONPATH": _search_path()}
        )
        with (self.path / LOG).open("wb") as log:
            self._process = subprocess.Popen(
                [*(program or isolated_command(CHILD)), str(self.path), EXTENSION, *more],
                bufsize=0,
                stdin=subprocess.PIPE,  # open until this process ends
                stdout=log,
                stderr=subprocess.STDOUT,
                creationflags=NO_WINDOW,
                env=os.environ | environment,
            )

    def start_waiting(self) -> None:
        """Start a process that imports what solves need, and waits for `wake`."""
        self.start((), 1, WAIT)

    def is_waiting(self) -> bool:
        """Return whether the process is there to be woken, with its folder."""
        return self.process.poll() is None and self.path.is_dir()

    def wake(self) -> bool:
        """Let a process that waits solve the request in the folder; False if there is none."""
        if self._process is None or self._process.stdin is None:
            return False
        try:
            self._process.stdin.write(b"\n")
        except OSError:
            self._process.wait()
            self._process.stdin.close()
            return False
        return True

    def abandon(self) -> None:
        """End the process, if any, and remove the folder."""
        if self._process is not None:
            self._process.kill()
        self.tidy_up()

    def tidy_up(self) -> None:
        """Wait for the end of the process, if any, and remove the folder."""
        if self._process is not None:
            self._process.wait()
            if self._process.stdin is not None:
                self._process.stdin.close()
        self._scratch.remove()


def isolated_command(script: Path) -> tuple[str, ...]:
    """Return the command that runs a script in an isolated Python."""
    return (_python(), *ISOLATION_FLAGS, str(script))


def _python() -> str:
    if not sys.executable:
        raise MocapAssistError("Blender's Python executable was not found. Reinstall Blender.")
    return sys.executable


def _search_path() -> str:
    """Return the module path of this process, with the extension's wheels.

    The current folder is left out. Blender's scripts come last: they would hide a Blender that
    is a Python module.
    """
    paths = sorted(filter(None, sys.path), key=lambda path: "scripts" in Path(path).parts)
    return os.pathsep.join(paths)
