"""Choose the file that Export writes, and check that it may."""

import os
from pathlib import Path

import bpy

from ...solvers.command_line.arguments import check_name_length
from ...solvers.errors import InvalidFileError
from ...solvers.files import real_path
from ..blender.compat import Source
from ..blender.path_properties import absolute
from ..scene import history
from ..scene.origin import origin_of
from .button_settings import ExportChoices
from .file_formats import FileFormat

ENDINGS = {each.ending: each for each in FileFormat}


def format_of(path: Path, choices: ExportChoices) -> FileFormat:
    """Return the format that a file's ending names, or the chosen one."""
    return ENDINGS.get(path.suffix.lower(), choices.file_format)


def with_ending(path: str, file_format: FileFormat) -> str:
    """Return a path with the ending of a format, in place of another one's."""
    ending = Path(path).suffix
    kept = path.removesuffix(ending) if ending.lower() in ENDINGS else path
    return f"{kept}{file_format.ending}"


def target_of(filepath: str, choices: ExportChoices) -> Path:
    """Return the file to write; raise InvalidFileError where it cannot be one."""
    target = absolute(filepath)
    if not target.name or filepath.endswith(("/", "\\")):
        raise InvalidFileError("Choose a file to export to.")
    if target.suffix.lower() not in ENDINGS and not target.is_dir():
        target = target.with_name(f"{target.name}{choices.file_format.ending}")
    check_name_length(target)
    if target.is_dir():
        raise InvalidFileError(f"{target} cannot be written: it is a folder.")
    if not target.is_absolute() or not target.parent.is_dir():
        raise InvalidFileError(
            f"There is no folder {target.parent}. Choose another one for {target.name}."
        )
    if not os.access(target.parent, os.W_OK):
        raise InvalidFileError(
            f"{target} cannot be written: the folder is read-only. Choose another one."
        )
    return target


def refuse_recording(target: Path, armature: bpy.types.Object, source: Source) -> None:
    """Raise InvalidFileError if the target is the file that the take was imported from."""
    raw = history.raw_of(*source)
    noted = [armature, source[0], *([raw[0]] if raw else [])]
    files = [origin_of(each).get("file", "") for each in noted]
    if real_path(target) in [real_path(absolute(file)) for file in files if file]:
        raise InvalidFileError(
            f"{target} is the recording that this take was imported from. Choose another name,"
            " or allow Overwrite Recording."
        )
