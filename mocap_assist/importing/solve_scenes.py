"""Read files of other programs, all in one background Blender, whose start takes a second."""

from collections.abc import Sequence
from pathlib import Path

from ...solvers.errors import InvalidFileError, MocapAssistError
from ...solvers.faults import Failure, attempt
from ...solvers.progress import Progress, unwatched
from ..jobs.in_blender import BackgroundBlender, BlendRead, read_blends
from ..jobs.job import ProcessDied


def read_scenes(
    paths: Sequence[Path],
    blender: BackgroundBlender,
    *,
    meshes: bool = False,
    progress: Progress = unwatched,
) -> list[BlendRead | MocapAssistError]:
    """Return the content of FBX, glTF, USD and Collada files, or why one cannot be read.

    A Blender that crashed does not say at which file: each half is read again, until the
    damaged file is alone.
    """
    if not paths:
        return []
    names = [str(path) for path in paths]
    found = attempt(paths[0], _read, names, blender, meshes, progress)
    if not isinstance(found, Failure):
        return list(found)
    if len(paths) == 1:
        return [found.as_error()]
    middle = len(paths) // 2
    return [
        each
        for half in (paths[:middle], paths[middle:])
        for each in read_scenes(half, blender, meshes=meshes, progress=progress)
    ]


def _read(
    names: Sequence[str], blender: BackgroundBlender, meshes: bool, progress: Progress
) -> list[BlendRead]:
    try:
        return read_blends(blender, names, meshes=meshes, progress=progress)
    except ProcessDied as error:
        raise InvalidFileError(
            f"Reading {names[0]} crashed Blender: {error.cause}. Export it again where it was"
            " made, or in another format."
        ) from None
