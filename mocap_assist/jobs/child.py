"""The other end of job.py: a script for a bare Python, which has no bpy to misuse."""

import gc
import importlib
import pickle
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from time import monotonic
from types import ModuleType
from typing import Any

BETWEEN_REPORTS = 0.1  # seconds


def main(folder: Path, extension: str) -> int:
    """Run the request in `folder` and leave the result there, whole or not at all.

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
    except BaseException:  # SystemExit, too: Blender may hang at a regular end
        traceback.print_exc()
        return int(protocol.Ending.FAILED)
    return int(protocol.Ending.ANSWERED)


def outcome_of(folder: Path, protocol: ModuleType) -> Any:
    """Return what the solver returns, in a tuple, or the exception that it raises."""
    gc.disable()  # Importing makes no rubbish; looking for it takes a tenth of the time.
    solve = pickle.loads((folder / protocol.REQUEST).read_bytes())
    gc.enable()
    try:
        return (solve(progress=reporter(protocol), **onlooker(solve, folder, protocol)),)
    except MemoryError:
        raise
    except Exception as error:  # handed over whole, to be raised in Blender
        error.add_note(traceback.format_exc())
        return error


def write_outcome(folder: Path, protocol: ModuleType, outcome: Any) -> None:
    """Leave the result where job.py looks for it."""
    part = folder / "part"
    with part.open("wb") as file:  # large arrays go straight into it, without a copy
        pickle.dump(outcome, file, protocol=pickle.HIGHEST_PROTOCOL)
    part.replace(folder / protocol.RESULT)


def make_importable(extension: str, folder: Path) -> None:
    """Let `bl_ext.user_default.mocap_assist.solvers` be found without running add-on code."""
    parts = extension.split(".")
    for n in range(1, len(parts) + 1):
        package = ModuleType(".".join(parts[:n]))
        package.__path__ = [str(folder)] if n == len(parts) else []
        sys.modules[package.__name__] = package


def reporter(protocol: ModuleType) -> Callable[..., None]:
    """Return a Progress that prints now and then."""
    spoken = -1.0

    def report(fraction: float, message: str = "") -> None:
        nonlocal spoken
        if monotonic() - spoken < BETWEEN_REPORTS:
            return
        spoken = monotonic()
        with suppress(OSError):  # a full disk: the result matters, if there is room for it
            print(protocol.progress_line(fraction, message), flush=True)

    return report


def onlooker(solve: Any, folder: Path, protocol: ModuleType) -> dict[str, Callable[..., None]]:
    """Return what shows meanwhile, for solves that have something to show."""
    if not isinstance(solve, protocol.PreviewSolve):
        return {}
    return {"show": partial(protocol.append_shown, (folder / protocol.SHOWN).open("wb"))}


def solve_and_leave(folder: Path, extension: str) -> None:
    """Solve, and end with the result, or as soon as Blender ends."""
    make_importable(extension, Path(__file__).parents[2])
    processes = f"{extension}.solvers.processes"
    parent = importlib.import_module(f"{processes}.parent")
    scratch = importlib.import_module(f"{processes}.scratch")
    parent.end_with_stdin(partial(scratch.remove_orphaned, folder))
    parent.leave(main(folder, extension))


if __name__ == "__main__":
    solve_and_leave(Path(sys.argv[1]), sys.argv[2])
