"""Save the .blend file of a command, and write its figures."""

import argparse
import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from shutil import disk_usage

import bpy

from ...solvers.command_line.batches import printable
from ...solvers.errors import InvalidFileError
from ...solvers.files import real_path, write_atomically

STDOUT = Path("-")


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
    error states also the free space.
    """
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ").removesuffix(".")
        free = disk_usage(target.parent).free / 1e6
        raise InvalidFileError(
            f"{target} was not saved: {reason}. {free:.1f} MB are free on its disk."
        ) from error


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
