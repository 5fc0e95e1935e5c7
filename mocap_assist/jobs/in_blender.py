"""Work for a background Blender, asked for by who has none himself."""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ...solvers.errors import InvalidFileError
from ...solvers.faults import attempt
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched
from .job import EXTENSION, isolated_command, run

BLEND_CHILD = Path(__file__).with_name("blend_child.py")
READER = "mocap_assist.library.blend_clips"
BLEND = ".blend"
SCENE_SUFFIXES = frozenset({
    ".fbx",
    ".glb",
    ".gltf",
    ".vrm",
    ".vrma",
    ".usd",
    ".usda",
    ".usdc",
    ".usdz",
    ".dae",
})
"""Files of other programs that Blender's own importers read."""


def is_read_in_blender(path: Path | str) -> bool:
    """Whether a file is one that a background Blender reads, by its name."""
    suffix = Path(path).suffix.lower()
    return suffix == BLEND or suffix in SCENE_SUFFIXES


@dataclass(frozen=True)
class BackgroundBlender:
    """Who reads .blend files, FBX, glTF and USD."""

    program: str
    """Path; empty where Blender is a module of Python."""
    rig: str = ""
    """A .blend file with the armatures of actions that are alone in theirs; none without."""

    def look_for_rig(self) -> None:
        """Raise InvalidFileError if the file of the rig is missing, or cannot be seen."""
        if self.rig and attempt(self.rig, Path(self.rig).is_file) is not True:
            raise InvalidFileError(
                f"There is no file {self.rig} to take the rig of actions from."
            )


@dataclass(frozen=True, eq=False)
class BlendClip:
    """An armature's action in a .blend file."""

    item: str
    """Name of the action; with that of the slot where several move armatures."""
    motion: Motion
    tags: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class BlendRead:
    """What a .blend file holds."""

    clips: tuple[BlendClip, ...]
    refused: tuple[str, ...] = ()
    """A sentence for each action that cannot be read, or for the file."""


def read_blends(
    blender: BackgroundBlender,
    paths: Sequence[str],
    *,
    assets_only: bool = False,
    items: Sequence[str] = (),
    progress: Progress = unwatched,
) -> list[BlendRead]:
    """Read the armature actions of .blend, FBX, glTF and USD files in a Blender of its own.

    Parameters
    ----------
    blender : BackgroundBlender
    paths : of the files
    assets_only : leave out actions that are not marked as assets
    items : read only these actions; all without

    Raises
    ------
    InvalidFileError
        The file of the rig is missing.
    ProcessDied
        Blender has crashed over one of the files.
    """
    blender.look_for_rig()
    asked = partial(_asked, tuple(paths), assets_only, tuple(items), blender.rig)
    return run(asked, progress, _program(blender.program))


def _asked(
    paths: tuple[str, ...],
    assets_only: bool,
    items: tuple[str, ...],
    rig: str,
    *,
    progress: Progress,
) -> list[BlendRead]:
    """Read, where there is a Blender: only there can the reader be imported."""
    reader: Any = importlib.import_module(f"{EXTENSION}.{READER}")
    read: list[BlendRead] = reader.read_files(paths, assets_only, items, rig, progress=progress)
    return read


def _program(path: str) -> tuple[str, ...]:
    if not path:
        return (*isolated_command(BLEND_CHILD), "--")
    # It finds the extension's wheels by PYTHONPATH, which Blender otherwise ignores.
    own = ("--python-use-system-env", "--background", "--factory-startup")
    return (path, *own, "--python-exit-code", "1", "--python", str(BLEND_CHILD), "--")
