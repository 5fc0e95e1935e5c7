"""Child process of job.py: a script for a Python without bpy."""

import gc
import importlib
import os
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from time import monotonic
from types import ModuleType
from typing import Any

REPORT_INTERVAL_S = 0.1
"""Seconds between two reports of progress. It bounds the load of the pipe."""
OURS = Path(__file__).parents[1]
"""The folder `mocap_assist`, whose modules `solve_…` hold all that is called here."""
IMPORTED_LATE = tuple(
    f"scipy.{name}"
    for name in (
        "cluster.hierarchy", "cluster.vq", "fft", "interpolate", "linalg", "ndimage",
        "optimize", "signal", "sparse.csgraph", "spatial", "special",
    )
)  # fmt: skip
"""What the solvers import only when they need it."""


def main(folder: Path, extension: str) -> int:
    """Run the request in `folder` and write its complete result there, or none.

    Returns
    -------
    int
        An `Ending`, for the exit status.
    """
    protocol = importlib.import_module(f"{extension}.mocap_assist.jobs.protocol")
    try:
        write_outcome(folder, protocol, outcome_of(folder, protocol))
    except MemoryError:
        return int(protocol.Ending.OUT_OF_MEMORY)
    except OSError as error:
        if error.errno in protocol.DISK_FULL:
            return int(protocol.Ending.DISK_FULL)
        traceback.print_exc()
        return int(protocol.Ending.FAILED)
    except BaseException:  # SystemExit too: Blender may hang at a regular exit
        traceback.print_exc()
        return int(protocol.Ending.FAILED)
    return int(protocol.Ending.ANSWERED)


def outcome_of(folder: Path, protocol: ModuleType) -> Any:
    """Return the solver's result in a tuple, or the exception that it raises."""
    solve = protocol.read_value(folder / protocol.REQUEST)
    gc.enable()
    try:
        return (solve(progress=reporter(protocol), **more_arguments(solve, folder, protocol)),)
    except MemoryError:
        raise
    except Exception as error:  # passed on complete, to be raised in Blender
        error.add_note(traceback.format_exc())
        return error


def write_outcome(folder: Path, protocol: ModuleType, outcome: Any) -> None:
    """Write the result to the file that job.py reads."""
    partial_path = folder / "part"
    protocol.write_value(partial_path, outcome)
    partial_path.replace(folder / protocol.RESULT)


def make_importable(extension: str, folder: Path) -> None:
    """Make `bl_ext.user_default.mocap_assist.solvers` importable without add-on code."""
    parts = extension.split(".")
    for n in range(1, len(parts) + 1):
        package = ModuleType(".".join(parts[:n]))
        package.__path__ = [str(folder)] if n == len(parts) else []
        sys.modules[package.__name__] = package


def reporter(protocol: ModuleType) -> Callable[..., None]:
    """Return a Progress that prints at most once per interval."""
    printed_at = -1.0

    def report(fraction: float, message: str = "") -> None:
        nonlocal printed_at
        if monotonic() - printed_at < REPORT_INTERVAL_S:
            return
        printed_at = monotonic()
        with suppress(OSError):  # a full disk: only the result matters
            print(protocol.progress_line(fraction, message), flush=True)

    return report


def more_arguments(
    solve: Any, folder: Path, protocol: ModuleType
) -> dict[str, Callable[..., Any]]:
    """Return the arguments `show=` and `is_ended=` of solves that are called with them."""
    arguments: dict[str, Callable[..., Any]] = {}
    if isinstance(solve, protocol.EndableSolve):
        goes_on = folder / protocol.GOES_ON
        arguments["show"] = protocol.EndlessPreviews(folder)
        arguments["is_ended"] = lambda: not goes_on.exists()
    elif isinstance(solve, protocol.PreviewSolve):
        file = (folder / protocol.PREVIEWS).open("wb")
        arguments["show"] = partial(protocol.append_preview, file)
    return arguments


def import_ahead(extension: str) -> None:
    """Import what solves need: their modules, and what these import only when called."""
    names = [
        ".".join([extension, "mocap_assist", *path.relative_to(OURS).with_suffix("").parts])
        for path in sorted(OURS.glob("*/solve_*.py"))
    ]
    for name in (*names, *IMPORTED_LATE):
        with suppress(Exception):  # A solve that needs it will say so.
            importlib.import_module(name)
    gc.freeze()  # What stays is not searched for garbage in each collection.


def solve_and_exit(folder: Path, extension: str, *, waits: bool) -> None:
    """Solve, and exit with the result, or as soon as Blender exits."""
    gc.disable()  # Imports leave no garbage; collecting takes a tenth of the time.
    make_importable(extension, OURS.parent)
    processes = f"{extension}.solvers.processes"
    parent = importlib.import_module(f"{processes}.parent")
    scratch = importlib.import_module(f"{processes}.scratch")
    if waits:
        import_ahead(extension)
        if not os.read(parent.STDIN, 1):
            scratch.remove_orphaned(folder)
            parent.exit_at_once(parent.ORPHANED)
    parent.end_with_stdin(partial(scratch.remove_orphaned, folder))
    parent.exit_at_once(main(folder, extension))


if __name__ == "__mp_main__":  # a worker of this process, for which names are the same
    make_importable(sys.argv[2], OURS.parent)
if __name__ == "__main__":
    # The word of `protocol`, which cannot be imported yet.
    solve_and_exit(Path(sys.argv[1]), sys.argv[2], waits="wait" in sys.argv[3:])
