"""The other end of job.py: a script for a bare Python, which has no bpy to misuse."""

import gc
import importlib
import os
import pickle
import shutil
import sys
import threading
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import monotonic
from types import ModuleType
from typing import Any

BETWEEN_REPORTS = 0.1  # seconds


def main(folder: Path, extension: str) -> None:
    """Run the request in `folder` and leave the result there, whole or not at all."""
    make_importable(extension, Path(__file__).parents[2])
    gc.disable()  # Importing makes no rubbish; looking for it takes a tenth of the time.
    protocol = importlib.import_module(f"{extension}.mocap_assist.jobs.protocol")
    solve = pickle.loads((folder / protocol.REQUEST).read_bytes())
    gc.enable()
    outcome: Any
    try:
        outcome = (
            solve(progress=reporter(folder, protocol), **onlooker(solve, folder, protocol)),
        )
    except Exception as error:  # handed over whole, to be raised in Blender
        error.add_note(traceback.format_exc())
        outcome = error
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


def reporter(folder: Path, protocol: ModuleType) -> Callable[..., None]:
    """Return a Progress that prints now and then."""
    spoken = -1.0

    def report(fraction: float, message: str = "") -> None:
        nonlocal spoken
        if monotonic() - spoken < BETWEEN_REPORTS:
            return
        spoken = monotonic()
        print(protocol.progress_line(fraction, message), flush=True)

    return report


def onlooker(solve: Any, folder: Path, protocol: ModuleType) -> dict[str, Callable[..., None]]:
    """Return what shows meanwhile, for solves that have something to show."""
    if not isinstance(solve, protocol.Showing):
        return {}
    return {"show": partial(protocol.append_shown, (folder / protocol.SHOWN).open("wb"))}


def end_with_blender(folder: Path) -> None:
    """Wait until the pipe from Blender closes, which it does however Blender ends."""
    sys.stdin.buffer.read()
    shutil.rmtree(folder, ignore_errors=True)
    os._exit(1)


if __name__ == "__main__":
    threading.Thread(target=end_with_blender, args=(Path(sys.argv[1]),), daemon=True).start()
    main(Path(sys.argv[1]), sys.argv[2])
