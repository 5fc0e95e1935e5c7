"""Properties that hold paths, and the paths that a file browser hands to an operator."""

from pathlib import Path
from typing import Any

import bpy

from ...solvers.errors import InvalidFileError

FILE, FOLDER = "FILE_PATH", "DIR_PATH"
HIDDEN = {"HIDDEN", "SKIP_SAVE"}
"""Options of what a file browser or a caller sets: not shown, and not remembered."""
RELATIVE = "PATH_SUPPORTS_BLEND_RELATIVE"
"""Without it Blender warns when a `//` path is set, and may raise that in a later call."""


def path_property(
    subtype: str = FILE, options: set[str] | None = None, **described: Any
) -> Any:
    """Return a string property for a path, which may begin with `//`.

    Parameters
    ----------
    subtype : FILE or FOLDER
    options : more options of `bpy.props.StringProperty`
    described : its other arguments, such as name and description
    """
    return bpy.props.StringProperty(
        subtype=subtype, options={RELATIVE} | (options or set()), **described
    )


def absolute(path: str) -> Path:
    """Return a path as the system knows it: `//` is the folder of the open .blend file."""
    return Path(bpy.path.abspath(path))


def file_to_write(path: str, ending: str) -> Path:
    """Return the file that is chosen, with its ending; raises InvalidFileError if none is."""
    chosen = absolute(path)
    if not chosen.name or path.endswith(("/", "\\")):
        raise InvalidFileError(f"Choose the {ending} file to write: {path!r} names none.")
    return chosen.with_suffix(ending)


class ChoosesFolder:
    """Mix-in of operators for which the animator first chooses a folder."""

    directory: path_property(FOLDER, HIDDEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Open the file browser, which executes the operator."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class ChoosesFiles(ChoosesFolder):
    """Mix-in of operators for which the animator first chooses files; see `chosen_files`."""

    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement, options=HIDDEN)


def chosen_files(operator: Any) -> list[Path]:
    """Return the files that a file browser has set in `directory` and `files`."""
    folder = absolute(operator.directory)
    return [folder / each.name for each in operator.files if each.name]
