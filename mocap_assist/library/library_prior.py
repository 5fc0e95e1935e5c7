"""The library of a scene, as what Clean and Reconstruct learn from."""

from pathlib import Path
from typing import Any

import bpy

from ...solvers.errors import InvalidFileError
from ..blender.path_properties import absolute
from ..runtime.selection import played_source
from ..scene.origin import origin_of
from .solve_prior import LibraryPrior, Own
from .sources import background_blender, library_path


def library_prior(scene: bpy.types.Scene, subject: bpy.types.Object) -> LibraryPrior:
    """Return the library, but for what is played; raise InvalidFileError without one."""
    choices = scene.mocap_assist.library.settings().choices
    path = library_path(choices)
    if not path.is_file():
        raise InvalidFileError(
            "There is no clip library to learn from. In the Library panel, add folders, then"
            " press Build Library."
        )
    found = path.stat()
    state = (found.st_size, found.st_mtime_ns)
    blender = background_blender(choices.rig_file)
    return LibraryPrior(str(path), state, own_origins(subject), blender)


def own_origins(subject: bpy.types.Object) -> Own:
    """Return the origins of the subject's action, as a library names them."""
    action = played_source(subject)[0]
    origin: dict[str, Any] = origin_of(action)
    own = [(str(Path(str(origin["file"])).resolve()), "")] if origin.get("file") else []
    holder = action.library.filepath if action.library else bpy.data.filepath
    if holder:
        own.append((str(absolute(holder).resolve()), action.name))
    return tuple(own)
