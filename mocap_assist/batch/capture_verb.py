"""`capture`: Import and Track, to recordings of depth."""

import argparse
from pathlib import Path
from typing import get_type_hints

import bpy

from ...solvers.command_line.files import found_in
from ...solvers.command_line.options import arguments_from, settings_from_arguments
from ...solvers.command_line.screen import Screen
from ...solvers.errors import InvalidFileError
from ...solvers.faults import Failure, attempt
from ...solvers.settings import Settings
from ..importing.choices import ImportChoices
from ..importing.depth_folders import depth_recordings_in, is_take
from ..importing.importing import import_files
from ..track.tracking import TrackBundle, read_tracking, selected_preview, write_tracked
from .pictures import draw_played
from .saving import save, target_file, tell
from .solving import solve_in_subprocess

HELP = "Track the actors of recordings of depth: armatures with actions in the .blend file."


def add_capture_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `capture`: those of the button, and of the files."""
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE",
        help="recordings of depth: files, folders of pictures, or folders of such takes",
    )  # fmt: skip
    arguments_from(parser, ImportChoices, *offered().values())


def offered() -> dict[str, type[Settings]]:
    """Return the settings of the button, but for those of looking on."""
    classes = get_type_hints(TrackBundle)
    return {name: classes[name] for name in classes if name != "watching"}


def perform_capture(arguments: argparse.Namespace, screen: Screen) -> None:
    """Track all that can be tracked and save the file.

    Raises
    ------
    InvalidFileError
        Somebody could not be tracked, or the file could not be saved.
    """
    target = target_file(arguments)
    settings = TrackBundle(**{
        name: settings_from_arguments(arguments, each) for name, each in offered().items()
    })
    made, said, failed = [], [], []
    takes = [path for path in arguments.files if is_take(path)]
    others = [path for path in arguments.files if path not in takes]
    inside = found_in(others, look=depth_recordings_in)
    for path in [*takes, *(path for path, _ in inside)]:
        screen.title = path.name
        sentence = attempt(path, _tracked, path, arguments, settings, screen)
        if isinstance(sentence, Failure):
            failed.append(sentence.sentence)
            continue
        said.append(sentence)
        made.append(bpy.context.object)
    screen.clear()
    if made:
        save(target)
    figures = {"objects": [each.name for each in made], "said": said, "failed": failed}
    tell(arguments, figures, said)
    if arguments.picture is not None and made:
        draw_played(bpy.context.scene, made[0], arguments.picture)
    if failed:
        raise InvalidFileError(" ".join(failed))


def _tracked(
    path: Path, arguments: argparse.Namespace, settings: TrackBundle, screen: Screen
) -> str:
    """Bring in one recording and track it; the new armature becomes active."""
    choices = settings_from_arguments(arguments, ImportChoices)
    imported = import_files(bpy.context, [path], choices, progress=screen.progress)
    if imported.failed:
        raise InvalidFileError(imported.failed[0])
    preview = selected_preview(bpy.context)
    if preview is None:
        raise InvalidFileError("It holds no depth. Bring it in with import.")
    scene = bpy.context.scene
    result = solve_in_subprocess(
        read_tracking(scene, preview, settings), arguments, screen.progress
    )
    return write_tracked(scene, preview, settings, result)
