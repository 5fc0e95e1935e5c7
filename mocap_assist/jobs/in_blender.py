"""Work in a background Blender, for a caller outside Blender."""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ...solvers.errors import InvalidFileError
from ...solvers.faults import attempt
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import is_scene_file
from .child_process import EXTENSION, isolated_command
from .job import run

BLEND_CHILD = Path(__file__).with_name("blend_child.py")
READER = "mocap_assist.library.blend_clips"
BLEND = ".blend"


def is_read_in_blender(path: Path | str) -> bool:
    """Whether a background Blender reads a file, by its content or name."""
    return Path(path).suffix.lower() == BLEND or is_scene_file(path)


@dataclass(frozen=True)
class BackgroundBlender:
    """The Blender that reads .blend, FBX, glTF and USD files."""

    program: str
    """Path; empty if Blender is a Python module."""
    rig: str = ""
    """A .blend file with armatures for files of actions only; empty for none."""

    def command(self) -> tuple[str, ...]:
        """Return the command that starts it, for `job.run`."""
        if not self.program:
            return (*isolated_command(BLEND_CHILD), "--")
        # It finds the extension's wheels by PYTHONPATH, which Blender otherwise ignores.
        start = (self.program, "--python-use-system-env", "--background", "--factory-startup")
        return (*start, "--python-exit-code", "1", "--python", str(BLEND_CHILD), "--")

    def check_rig(self) -> None:
        """Raise InvalidFileError if the rig's file is missing or inaccessible."""
        if self.rig and attempt(self.rig, Path(self.rig).is_file) is not True:
            raise InvalidFileError(
                f"The file of the rig, {self.rig}, does not exist. Choose another."
            )


class LeftOut(NamedTuple):
    """Motion of a body's bones that a recording of rotations cannot hold."""

    shifts: tuple[tuple[str, float], ...] = ()
    """Bones whose distance to the parent changes, and by how much, meters."""
    growing: tuple[str, ...] = ()
    """Bones that change their size."""


@dataclass(frozen=True, eq=False)
class BlendClip:
    """An armature's action in a .blend file."""

    item: str
    """Name of the action, and of the slot if several slots animate armatures."""
    motion: Motion
    tags: tuple[str, ...] = ()
    armature: str = ""
    """Name of the armature."""
    left_out: LeftOut = LeftOut()


class SkinnedMeshes(NamedTuple):
    """Meshes of a file that armatures deform, in the rest pose of the file."""

    content: bytes
    """A .blend file with the objects."""
    owners: dict[str, str]
    """Name of the armature of each object."""
    heads: dict[str, dict[str, tuple[float, ...]]]
    """Head of each bone of each armature, in the world of the file."""


@dataclass(frozen=True, eq=False)
class BlendRead:
    """Clips of a .blend file."""

    clips: tuple[BlendClip, ...]
    refused: tuple[str, ...] = ()
    """A message for each unreadable action, or for the file."""
    is_empty: bool = False
    """Whether the file has no motion at all, so that it need not be read again."""
    meshes: SkinnedMeshes | None = None
    """Only if they were requested."""


def read_blends(
    blender: BackgroundBlender,
    paths: Sequence[str],
    *,
    assets_only: bool = False,
    items: Sequence[str] = (),
    meshes: bool = False,
    progress: Progress = unwatched,
) -> list[BlendRead]:
    """Read the armature actions of .blend, FBX, glTF and USD files in a background Blender.

    Parameters
    ----------
    blender : BackgroundBlender
    paths : of the files
    assets_only : skip actions that are not marked as assets
    items : read only these actions; empty reads all
    meshes : also return skinned meshes

    Raises
    ------
    InvalidFileError
        The file of the rig is missing.
    ProcessDied
        Blender crashed while it read one of the files.
    """
    blender.check_rig()
    request = partial(_read_here, tuple(paths), assets_only, tuple(items), blender.rig, meshes)
    return run(request, progress, blender.command())


def _read_here(
    paths: tuple[str, ...],
    assets_only: bool,
    items: tuple[str, ...],
    rig: str,
    meshes: bool,
    *,
    progress: Progress,
) -> list[BlendRead]:
    """Read in this Blender: the reader can be imported only there."""
    reader: Any = importlib.import_module(f"{EXTENSION}.{READER}")
    read: list[BlendRead] = reader.read_files(
        paths, assets_only, items, rig, meshes=meshes, progress=progress
    )
    return read
