"""Path properties, and the paths that a file browser passes to an operator."""

from pathlib import Path
from typing import Any

import bpy

from ...solvers.errors import InvalidFileError

FILE, FOLDER = "FILE_PATH", "DIR_PATH"
HIDDEN = {"HIDDEN", "SKIP_SAVE"}
"""Options of properties that a file browser or a caller sets: not shown, not remembered."""
RELATIVE = "PATH_SUPPORTS_BLEND_RELATIVE"
"""Without it Blender warns about `//` paths, and may raise the warning in a later call."""


def path_property(
    subtype: str = FILE, options: set[str] | None = None, **described: Any
) -> Any:
    """Return a string property for a path, which may begin with `//`.

    Parameters
    ----------
    subtype : FILE or FOLDER
    options : more options of `bpy.props.StringProperty`
    described : its other arguments, for example name and description
    """
    return bpy.props.StringProperty(
        subtype=subtype, options={RELATIVE} | (options or set()), **described
    )


def absolute(path: str) -> Path:
    """Return an absolute path; `//` is the folder of the open .blend file."""
    return Path(bpy.path.abspath(path))


def file_to_write(path: str, ending: str) -> Path:
    """Return the chosen file with its ending; raise InvalidFileError if there is none."""
    chosen = absolute(path)
    if not chosen.name or path.endswith(("/", "\\")):
        raise InvalidFileError(
            f"{path!r} does not name a file. Choose the {ending} file to write."
        )
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
