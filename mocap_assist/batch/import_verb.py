"""The command `import`: what the button Import does, for files and folders."""

import argparse
from pathlib import Path

import bpy

from ...solvers.command_line.arguments import (
    arguments_from,
    find_recordings,
    settings_from_arguments,
)
from ...solvers.command_line.batches import Screen
from ...solvers.errors import InvalidFileError
from ..importing.button_settings import ImportChoices
from ..importing.depth_folders import all_recordings_in, is_take
from ..importing.importing import import_files
from .pictures import draw_result
from .saving import report_figures, save, target_file

HELP = "Import recordings into the .blend file: motion as armatures, markers as empties."


def add_import_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `import`; those of the button."""
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE", help="recordings, or folders of them"
    )
    arguments_from(parser, ImportChoices)


def perform_import(arguments: argparse.Namespace, screen: Screen) -> None:
    """Import all that can be read and save the file.

    Raises
    ------
    InvalidFileError
        Some recordings could not be read, or the file could not be saved.
    """
    target = target_file(arguments)
    takes = [path for path in arguments.files if is_take(path)]
    others = [path for path in arguments.files if path not in takes]
    paths = [
        *takes,
        *(path for path, _ in find_recordings(others, list_recordings=all_recordings_in)),
    ]
    screen.title = "Import"
    imported = import_files(
        bpy.context,
        paths,
        settings_from_arguments(arguments, ImportChoices),
        progress=screen.progress,
    )
    screen.clear()
    if imported.made:
        save(target)
    figures = {
        "objects": [made.name for made in imported.made],
        "said": list(imported.messages),
        "failed": list(imported.failed),
        "figures": list(imported.figures),
    }
    report_figures(arguments, figures, imported.messages)
    if arguments.picture is not None and imported.made:
        draw_result(bpy.context.scene, imported.made[0], arguments.picture, screen)
    if imported.failed:
        raise InvalidFileError(" ".join(imported.failed))
