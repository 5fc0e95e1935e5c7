"""Import files for the button Import."""

from functools import lru_cache
from pathlib import Path

import bpy

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import MocapAssistError, SolveCancelled
from ...solvers.faults import Failure, attempt
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings import (
    SCENE_SUFFIXES,
    FloorPlacement,
    is_scene_file,
    one_path_per_take,
)
from ...solvers.recordings.conventions import conventions_of
from ..blender.path_properties import absolute, chosen_files
from ..scene.scene_rate import scene_rate
from .button_settings import ImportChoices
from .depth_folders import is_take, readable, take_of
from .recent_files import read_again
from .recording_objects import conversion_from_choices
from .solve_reading import Conversion
from .transaction import READING_FRACTION, Imported, ImportTransaction

MAX_PREVIEW_BYTES = 2_000_000
"""Bytes of a file up to which the dialog reads it, so that it opens without delay."""


EXTENSIONS = (
    *sorted(SCENE_SUFFIXES),
    ".bvh", ".amc", ".asf", ".c3d", ".trc", ".skeleton", ".csv", ".json", ".txt", ".npy",
    ".npz", ".mkv", ".mat", ".mvnx", ".tsv", ".vrma",
)  # fmt: skip
"""File extensions of all supported formats; the content of a file decides."""
PICTURES = (".png", ".exr")
"""File endings of depth images; a folder of them is a recording."""
FILTER = ";".join(f"*{extension}" for extension in (*EXTENSIONS, *PICTURES))


def chosen_paths(operator: bpy.types.Operator) -> list[Path]:
    """Return the files that an operator was given, as a list in a folder or as one path.

    The skeleton of an AMC file may be among them: it is found anyway. A folder of depth images
    may be given itself, as the folder that is shown, or by files in it. Of a take with a file
    per frame, the first one is returned.
    """
    _recordings_of.cache_clear()
    return shown_paths(operator)


def shown_paths(operator: bpy.types.Operator) -> list[Path]:
    """Return `chosen_paths` for the display, which reads files again only for another choice.

    Blender asks for it several times with each redraw.
    """
    paths = chosen_files(operator)
    if not paths and operator.filepath:
        paths = [absolute(operator.filepath)]
    folder = absolute(operator.directory) if operator.directory and not paths else None
    return [*_recordings_of(tuple(paths), folder)]


@lru_cache(maxsize=4)
def _recordings_of(given: tuple[Path, ...], folder: Path | None) -> tuple[Path, ...]:
    """Return the recordings of these files, or the folder if it is one."""
    if folder is not None and is_take(folder):
        given = (folder,)
    paths = one_path_per_take(list(dict.fromkeys(map(take_of, given))))
    if any(path.suffix.lower() == ".amc" for path in paths):
        paths = [path for path in paths if path.suffix.lower() != ".asf"]
    return tuple(paths)


def preview(context: bpy.types.Context, paths: list[Path]) -> str:
    """Return sentences about the first file for the import dialog.

    A large one is not read for it: the dialog would be long in coming.
    """
    path, scene = paths[0], scene_rate(context.scene)
    plays = f"the scene plays at {scene:g} FPS"
    try:
        size = path.stat().st_size
        if size > MAX_PREVIEW_BYTES or is_scene_file(path):
            return f"{path.name}: {size / 1e6:.1f} MB; {plays}."
        content = read_again(path, Conversion(floor=FloorPlacement.AUTO))[0]
    except MocapAssistError as error:
        return str(error)
    except OSError as error:
        return f"{path} cannot be read ({error.strerror})."
    recording = content.recording
    frames = f"{recording.n_frames} frames at {recording.frame_rate:.5g} Hz"
    warnings = content.warnings
    if not isinstance(recording, DepthRecording):
        warnings = (conventions_of(recording).sentence(), *warnings)
    return ". ".join([f"{path.name}: {frames}; {plays}", *warnings]) + "."


def import_files(
    context: bpy.types.Context,
    paths: list[Path],
    choices: ImportChoices,
    *,
    progress: Progress = unwatched,
) -> Imported:
    """Make an armature or empties of each file; those that cannot be read are reported.

    A file that fails leaves nothing behind. Raises SolveCancelled by `progress`; the scene is
    then as it was.
    """
    transaction = ImportTransaction(context, choices)
    conversion = conversion_from_choices(context, transaction.choices)
    try:
        for index, path in enumerate(paths):
            file_progress = within(progress, index / len(paths), (index + 1) / len(paths))
            source = attempt(path, readable, context, path, choices)
            if isinstance(source, Failure):
                transaction.refuse(path, source.as_error())
                continue
            try:
                takes = read_again(
                    source, conversion, within(file_progress, 0.0, READING_FRACTION)
                )
            except SolveCancelled:
                raise
            except MocapAssistError as error:
                transaction.refuse(path, error)
            else:
                making = within(file_progress, READING_FRACTION, 1.0)
                for number, take in enumerate(takes):
                    part = within(making, number / len(takes), (number + 1) / len(takes))
                    transaction.add(context, source, take, part)
    except BaseException:
        transaction.take_back(context)
        raise
    return transaction.end(context)
