"""`capture`: import depth recordings and track their actors."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import get_type_hints

import bpy

from ...solvers.command_line.arguments import (
    arguments_from,
    find_recordings,
    settings_from_arguments,
)
from ...solvers.command_line.batches import Screen
from ...solvers.errors import InvalidFileError, InvalidSettingError
from ...solvers.faults import Failure, attempt
from ...solvers.settings import Settings
from ..importing.button_settings import ImportChoices
from ..importing.depth_folders import depth_recordings_in, is_take
from ..importing.importing import import_files
from ..scene.scene_objects import select_only
from ..track.tracking import (
    TrackBundle,
    WatchChoices,
    read_tracking,
    selected_preview,
    write_tracked,
)
from .pictures import draw_result
from .saving import report_figures, save, target_file
from .solving import solve_in_subprocess

HELP = "Track the actors of depth recordings: armatures with actions in the .blend file."


def add_capture_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `capture`: those of the button, and of the files."""
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE",
        help="depth recordings: files, folders of depth images, or folders of such takes",
    )  # fmt: skip
    arguments_from(parser, ImportChoices, *button_settings().values())


def button_settings() -> dict[str, type[Settings]]:
    """Return the settings of the button, without those of the preview."""
    classes = get_type_hints(TrackBundle)
    return {name: classes[name] for name in classes if name != "watching"}


def perform_capture(arguments: argparse.Namespace, screen: Screen) -> None:
    """Track all recordings that can be tracked, and save the file.

    Raises
    ------
    InvalidFileError
        A recording could not be tracked, or the file could not be saved.
    InvalidSettingError
        --other-cameras is given for other files than those of several cameras.
    """
    target = target_file(arguments)
    given: dict[str, Settings] = {
        name: settings_from_arguments(arguments, each)
        for name, each in button_settings().items()
    }
    given["watching"] = WatchChoices()
    settings = TrackBundle._make(given[name] for name in TrackBundle._fields)
    made, messages, failed = [], [], []
    paths = [path for given in arguments.files for path in _recordings_of(given)]
    if settings.choices.other_cameras:
        _check_cameras(paths, settings)
    for cameras in [paths] if settings.choices.other_cameras else [[path] for path in paths]:
        path = cameras[0]
        screen.title = path.name
        before = {*bpy.data.objects}
        sentence = attempt(path, _import_and_track, cameras, arguments, settings, screen)
        if isinstance(sentence, Failure):
            failed.append(sentence.sentence)
            continue
        messages.append(sentence)
        added = {*bpy.data.objects} - before - {bpy.context.object}
        people = [each for each in added if each.type == "ARMATURE"]
        made += [bpy.context.object, *sorted(people, key=lambda each: each.name)]
    screen.clear()
    if made:
        save(target)
    figures = {"objects": [each.name for each in made], "said": messages, "failed": failed}
    report_figures(arguments, figures, messages)
    if arguments.picture is not None and made:
        draw_result(bpy.context.scene, made[0], arguments.picture, screen)
    if failed:
        raise InvalidFileError(" ".join(failed))


def _recordings_of(given: Path) -> list[Path]:
    """Return a take that is named, or the takes in a folder; raises InvalidFileError."""
    if is_take(given):
        return [given]
    return [path for path, _ in find_recordings([given], list_recordings=depth_recordings_in)]


def _check_cameras(paths: Sequence[Path], settings: TrackBundle) -> None:
    """Raise InvalidSettingError if the files are not those of several cameras."""
    if settings.choices.all_people:
        raise InvalidSettingError(
            "--other-cameras tracks one person. Leave out --all-people or --other-cameras."
        )
    if len(paths) < 2:
        raise InvalidSettingError(
            "--other-cameras joins recordings of one take. Name those of the other cameras,"
            " too, or leave it out."
        )
    if len({path.resolve() for path in paths}) < len(paths):
        raise InvalidSettingError(
            "The same recording is named twice. With --other-cameras, name one of each camera."
        )


def _import_and_track(
    cameras: Sequence[Path],
    arguments: argparse.Namespace,
    settings: TrackBundle,
    screen: Screen,
) -> str:
    """Import the recordings of one take and track it; the new armature becomes active."""
    previews = [_imported(path, arguments, screen) for path in cameras]
    select_only(bpy.context, previews, previews[0])
    scene, preview = bpy.context.scene, previews[0]
    result = solve_in_subprocess(
        read_tracking(scene, preview, settings), arguments, screen.progress
    )
    return write_tracked(scene, preview, settings, result)


def _imported(path: Path, arguments: argparse.Namespace, screen: Screen) -> bpy.types.Object:
    """Import a recording; return its points."""
    choices = settings_from_arguments(arguments, ImportChoices)
    imported = import_files(bpy.context, [path], choices, progress=screen.progress)
    if imported.failed:
        raise InvalidFileError(imported.failed[0])
    preview = selected_preview(bpy.context)
    if preview is None:
        raise InvalidFileError("It has no depth images. Use import.")
    return preview
