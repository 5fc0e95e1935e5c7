"""Solve of the button Export: a background Blender writes the file."""

import importlib
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ...solvers.processes import ScratchFolder
from ...solvers.progress import Progress, unwatched
from ..jobs.child_process import EXTENSION
from ..jobs.in_blender import BackgroundBlender
from ..jobs.job import run
from .file_formats import ExportedBones, FileFormat

WRITER = "mocap_assist.exporting.write_file"
TAKE = "take"
"""Stem of both files in the scratch folder."""


@dataclass(frozen=True)
class ExportRequest:
    """Content to export from a .blend file, and its settings."""

    armature: str
    action: str
    slot: str
    """Identifier."""
    meshes: tuple[str, ...]
    """Names of skinned meshes to include."""
    frames: range
    """Scene frames, one after the other."""
    fps: int
    fps_base: float
    meters: float
    """Length of one unit of the scene."""
    body: str
    """Bone that the body begins with."""
    file_format: FileFormat
    bones: ExportedBones


@dataclass(frozen=True)
class ExportProblem:
    """A .blend file with an armature and its action, and what to write of it."""

    blend: bytes
    request: ExportRequest
    blender: BackgroundBlender


@dataclass(frozen=True)
class WrittenTake:
    """Content of a written file."""

    n_frames: int
    n_bones: int
    notes: tuple[str, ...] = ()
    """Content that the file lacks, a sentence each."""


@dataclass(frozen=True)
class ExportedTake:
    """A file, not yet at its place."""

    content: bytes
    written: WrittenTake


def export_take(problem: ExportProblem, *, progress: Progress = unwatched) -> ExportedTake:
    """Let a background Blender write the file; return its content.

    Raises
    ------
    InvalidFileError
        Blender's exporter refuses the take, or temporary files cannot be written.
    """
    with ScratchFolder() as scratch:
        blend = scratch.path / f"{TAKE}.blend"
        blend.write_bytes(problem.blend)
        request = partial(_write_here, str(scratch.path), problem.request)
        written = run(request, progress, problem.blender.command())
        target = scratch.path / f"{TAKE}{problem.request.file_format.ending}"
        return ExportedTake(target.read_bytes(), written)


def _write_here(folder: str, request: ExportRequest, *, progress: Progress) -> WrittenTake:
    """Write in this Blender: only it can import the writer."""
    writer: Any = importlib.import_module(f"{EXTENSION}.{WRITER}")
    written: WrittenTake = writer.write_take(Path(folder), request, progress)
    return written
