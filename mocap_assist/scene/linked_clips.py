"""Actions and armatures of another .blend file, linked only while they are read."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidFileError

ENDING = ".blend"


class Linked(NamedTuple):
    """Actions and armatures of another file."""

    actions: tuple[bpy.types.Action, ...]
    armatures: tuple[bpy.types.Object, ...]
    """Linked to the current scene meanwhile, so that Blender evaluates their positions."""


def is_blend(path: Path) -> bool:
    """Whether the name of a file is that of a .blend file."""
    return path.suffix.lower() == ENDING


@contextmanager
def linked_clips(
    path: Path, actions: Sequence[str] | None = None, objects: Sequence[str] | None = None
) -> Iterator[Linked]:
    """Link the content of a file, and remove it again at the end.

    Parameters
    ----------
    path : Path
    actions, objects : names
        Of those to be linked; without them all are.

    Raises
    ------
    InvalidFileError
        Blender cannot read the file.
    """
    scene = bpy.context.scene
    libraries = {each.session_uid for each in bpy.data.libraries}
    present = {each.session_uid for each in scene.objects}
    try:
        with bpy.data.libraries.load(str(path), link=True) as (there, into):
            into.actions = _chosen_names(there.actions, actions)
            into.objects = _chosen_names(there.objects, objects)
    except OSError:
        raise InvalidFileError(
            f"{path} cannot be read as a .blend file. Save it again, or choose another."
        ) from None
    armatures = [each for each in into.objects if each is not None and each.type == "ARMATURE"]
    strangers = [each for each in armatures if each.session_uid not in present]
    try:
        for each in strangers:
            scene.collection.objects.link(each)
        yield Linked(tuple(filter(None, into.actions)), tuple(armatures))
    finally:
        for each in strangers:
            scene.collection.objects.unlink(each)
        for library in list(bpy.data.libraries):
            if library.session_uid not in libraries:
                bpy.data.libraries.remove(library)


def _chosen_names(there: Sequence[str], names: Sequence[str] | None) -> list[str]:
    return [name for name in there if names is None or name in names]
