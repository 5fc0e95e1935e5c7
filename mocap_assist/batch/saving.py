"""Save the .blend file of a command, and write its figures."""

import argparse
import json
import shutil
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path

import bpy

from ...solvers.command_line.batches import printable
from ...solvers.errors import InvalidFileError
from ...solvers.files import real_path, write_atomically

STDOUT = Path("-")
LITTLE_SPACE = 100_000_000
"""Bytes on a disk that the saved file may fill. Chosen by hand: more than the largest takes."""


def add_output_options(parser: argparse.ArgumentParser, *, saves: bool) -> None:
    """Add the options for the location of results."""
    parser.add_argument(
        "--json",
        nargs="?",
        type=Path,
        const=STDOUT,
        metavar="FILE",
        help="write one line of JSON per armature to FILE, or to standard output without FILE",
    )
    parser.add_argument(
        "--picture", type=Path, metavar="FILE",
        help="draw the raw motion and the result as stick figures, to a PNG file",
    )  # fmt: skip
    if saves:
        parser.add_argument(
            "--output", type=Path, metavar="FILE",
            help="save the result there [default: in the opened file]",
        )  # fmt: skip


def target_file(arguments: argparse.Namespace) -> Path:
    """Return the file to save; raise InvalidFileError where there is none, or no folder."""
    target = arguments.output or (Path(bpy.data.filepath) if bpy.data.filepath else None)
    if target is None:
        raise InvalidFileError("No file is open: name the file to save with --output FILE.")
    return check_folder(target)


def check_folder(path: Path) -> Path:
    """Return the absolute path; raise an error if its folder is missing."""
    if not real_path(path).parent.is_dir():
        raise InvalidFileError(f"There is no folder {real_path(path).parent} to save in.")
    return real_path(path)


def save(target: Path) -> None:
    """Save the open file; Blender writes it atomically.

    On a disk that becomes full, Blender reports an arbitrary reason, such as "Success". So the
    error states also the free space where it is little.
    """
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ").removesuffix(".")
        raise InvalidFileError(
            f"{target} was not saved: {reason}.{_little_space(target)}"
        ) from error


def _little_space(target: Path) -> str:
    """Return a sentence on the free space if the file may not fit in it; empty otherwise."""
    n_bytes = 0
    for existing in (target, Path(bpy.data.filepath)):
        with suppress(OSError):
            n_bytes = max(n_bytes, existing.stat().st_size)
    with suppress(OSError):
        free = shutil.disk_usage(target.parent).free
        if free < max(LITTLE_SPACE, 2 * n_bytes):
            return (
                f" {free / 1e6:.1f} MB are free on its disk. Free some space, or save elsewhere"
                " with --output."
            )
    return ""


def report_figures(
    arguments: argparse.Namespace, figures: Mapping[str, object], messages: Iterable[str]
) -> None:
    """Print the result as text, or as one line of JSON if requested."""
    line = json.dumps(figures)
    sys.stdout.write(
        "\n".join([line] if arguments.json == STDOUT else map(printable, messages)) + "\n"
    )
    sys.stdout.flush()
    if arguments.json not in {None, STDOUT}:
        with write_atomically(arguments.json) as part:
            part.write_text(line + "\n", encoding="utf-8")
