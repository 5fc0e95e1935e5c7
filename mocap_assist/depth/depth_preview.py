"""A recording of depth as an object: points that follow the timeline, read when shown."""

import logging
from dataclasses import asdict, dataclass
from enum import Enum
from functools import lru_cache
from math import isfinite
from typing import Any

import bpy
import numpy as np
from bpy.app import handlers
from mathutils import Matrix
from numpy.typing import NDArray

from ...solvers.depth_scene import DepthRecording, Floor
from ...solvers.errors import MocapAssistError
from ...solvers.faults import Failure, attempt
from ...solvers.recordings import DepthSettings, Held, read_depth
from ..blender.data_names import fitting_name
from ..blender.path_properties import absolute
from ..blender.permissions import allow_recording, recording_allowed
from ..blender.stored_json import load_json, store_json
from ..scene.scene_objects import add_object, in_object_mode
from .depth_points import point_nodes

logger = logging.getLogger(__name__)

KEY = "mocap_assist_depth"
"""Custom property of a mesh: which recording it shows, and when, as JSON."""
PROBLEM = "mocap_assist_depth_problem"
"""Custom property of a mesh: why it shows nothing."""
SEEN = "seen"
"""Attribute of a point: whether the camera saw anything there."""
NOT_ALLOWED = (
    "This file shows a depth recording that has not been opened on this machine yet."
    " Press Show Points."
)
MOST_POINTS = 20_000
N_SAMPLES = 5
N_OPEN = 4
"""Pictures that tell how much is seen, and recordings that are kept open."""


@dataclass(frozen=True)
class Shown:
    """What a preview shows: a recording, its first frame, and frames between two pictures."""

    path: str
    settings: DepthSettings
    start: float
    step: float
    every: int
    """Of the columns and rows of a picture, every so many are points."""

    def write(self, mesh: bpy.types.Mesh) -> None:
        """Keep this with a mesh."""
        store_json(mesh, KEY, self.told())

    def told(self) -> dict[str, Any]:
        """Return this as JSON can keep it."""
        settings = {
            name: value.name if isinstance(value, Enum) else value
            for name, value in asdict(self.settings).items()
        }
        return {**asdict(self), "settings": settings}

    @classmethod
    def read(cls, mesh: bpy.types.Mesh) -> "Shown":
        """Return what a mesh shows; raises ValueError, TypeError or KeyError if nothing."""
        return cls.of(load_json(mesh, KEY, dict))

    @classmethod
    def of(cls, told: dict[str, Any]) -> "Shown":
        """Undo `told`; raises ValueError, TypeError or KeyError where that is no preview."""
        settings = {**told["settings"], "held": Held[told["settings"]["held"]]}
        start, step, every = float(told["start"]), float(told["step"]), int(told["every"])
        if not (isfinite(start) and isfinite(step) and step > 0.0 and every > 0):
            raise ValueError(f"start {start}, step {step}, every {every}")
        return cls(str(told["path"]), DepthSettings(**settings), start, step, every)

    def picture(self, frame: float, n_frames: int) -> int:
        """Return which picture is shown at a frame of the scene; before and after, the ends."""
        return round(float(np.clip((frame - self.start) / self.step, 0, n_frames - 1)))

    def frame(self, picture: int) -> float:
        """Return the frame of the scene at which a picture is shown."""
        return self.start + self.step * picture


def build_preview(
    context: bpy.types.Context,
    name: str,
    recording: DepthRecording,
    shown: Shown,
    place: Floor,
    scale: float,
) -> bpy.types.Object:
    """Add a cloud of points that plays as the recording does, and make it active.

    Its own space is the camera's: x to the right, y down, z forward, in metres.

    Parameters
    ----------
    context : bpy.types.Context
    name : of the object
    recording : DepthRecording
        Read from `shown.path` with `shown.settings`.
    shown : Shown
    place : Floor
        Tells where the camera stood.
    scale : units of the scene in a metre
    """
    in_object_mode(context)
    mesh = bpy.data.meshes.new(fitting_name(name))
    camera = recording.camera.every(shown.every)
    mesh.vertices.add(min(camera.width * camera.height, MOST_POINTS))
    mesh.attributes.new(SEEN, "BOOLEAN", "POINT")
    made = bpy.data.objects.new(fitting_name(name), mesh)
    turn, shift = place.world_from_camera()
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * turn, scale * shift
    made.matrix_world = Matrix(matrix.tolist())
    made.modifiers.new("Points", "NODES").node_group = point_nodes(SEEN)
    shown.write(mesh)
    add_object(context, made)
    _show(mesh, context.scene.frame_current_final)
    return made


def previews() -> list[bpy.types.Mesh]:
    """Return the meshes of this file that show recordings, and may be changed now."""
    meshes = [mesh for mesh in bpy.data.meshes if KEY in mesh and mesh.library is None]
    return [mesh for mesh in meshes if not mesh.is_editmode]


def problem_of(made: bpy.types.Object) -> str:
    """Return why a preview shows nothing; empty if it does, or is none."""
    return str(made.data.get(PROBLEM, "")) if made.type == "MESH" else ""


def recording_of(mesh: bpy.types.Mesh) -> DepthRecording:
    """Open the recording that a mesh shows, or return it if it is open.

    Raises MocapAssistError where it cannot be read, or the mesh shows none.
    """
    return open_recording(shown_by(mesh))


def shown_by(mesh: bpy.types.Mesh) -> Shown:
    """Return what a mesh shows; raises MocapAssistError if nothing."""
    try:
        return Shown.read(mesh)
    except (ValueError, TypeError, KeyError):
        raise MocapAssistError(f"{mesh.name} shows no recording of depth.") from None


def open_recording(shown: Shown) -> DepthRecording:
    """Open a recording, or return it if it is open; raises MocapAssistError."""
    return _open(shown.path, shown.settings)


@lru_cache(maxsize=N_OPEN)
def _open(path: str, settings: DepthSettings) -> DepthRecording:
    return read_depth(absolute(path), settings)


@lru_cache(maxsize=N_OPEN)
def _rays(recording: DepthRecording, every: int) -> NDArray[np.float32]:
    return recording.camera.every(every).rays().astype(np.float32)


def show_asked(mesh: bpy.types.Mesh, frame: float) -> str:
    """Show the points of a mesh now and from now on; return a sentence about it.

    Raises MocapAssistError where the recording cannot be read, or the mesh shows none.
    """
    shown = shown_by(mesh)
    open_recording(shown)
    allow_recording(shown.path)
    _show(mesh, frame)
    return f"{mesh.name} shows {shown.path}."


def cheap_step(recording: DepthRecording) -> int:
    """Return of how many columns and rows one makes no more points than are cheap to show.

    What counts is what is seen in some pictures: of an actor alone every pixel may be shown.
    """
    frames = np.linspace(0, recording.n_frames - 1, N_SAMPLES).astype(int).tolist()
    pictures = [recording.frame(frame) > 0.0 for frame in frames]
    every = 1
    while max(seen[::every, ::every].sum() for seen in pictures) > MOST_POINTS:
        every += 1
    return every


def _show(mesh: bpy.types.Mesh, frame: float) -> None:
    """Put the points of a mesh where they are at a frame of the scene."""
    try:
        recording, shown = recording_of(mesh), Shown.read(mesh)
        rays = _rays(recording, shown.every)
        depth = recording.frame(shown.picture(frame, recording.n_frames))
    except MocapAssistError as error:
        _hide(mesh, str(error))
        return
    if (seen := _seen_of(mesh)) is None:
        _hide(mesh, f"{mesh.name} was edited: import the recording again.")
        return
    if PROBLEM in mesh:
        del mesh[PROBLEM]
    depth = depth[:: shown.every, :: shown.every]
    row, column = np.nonzero(depth)
    n_points = len(mesh.vertices)
    if len(row) > n_points:
        kept = np.linspace(0, len(row) - 1, n_points).astype(int)
        row, column = row[kept], column[kept]
    points = np.zeros((n_points, 3), np.float32)
    points[: len(row)] = rays[row, column] * depth[row, column, np.newaxis]
    mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    seen.data.foreach_set("value", np.arange(n_points) < len(row))
    mesh.update()


def _hide(mesh: bpy.types.Mesh, problem: str) -> None:
    """Show no point, and remember why."""
    if mesh.get(PROBLEM) == problem:
        return
    mesh[PROBLEM] = problem
    logger.warning("%s: %s", mesh.name, problem)
    if (seen := _seen_of(mesh)) is not None:
        seen.data.foreach_set("value", np.zeros(len(mesh.vertices), dtype=bool))
        mesh.update()


def _seen_of(mesh: bpy.types.Mesh) -> bpy.types.BoolAttribute | None:
    """Return the attribute that says which points are shown; None where it was edited."""
    found = mesh.attributes.get(SEEN)
    fits = found is not None and (found.domain, found.data_type) == ("POINT", "BOOLEAN")
    return found if fits else None


@handlers.persistent
def _follow(scene: bpy.types.Scene, *_: object) -> None:
    """The scene goes to another frame, or a file was loaded: show what was there.

    A recording that only the .blend file names stays closed until the animator asks for it.
    """
    for mesh in previews():
        if not _is_allowed(mesh):
            _hide(mesh, NOT_ALLOWED)
            continue
        shown = attempt(mesh.name, _show, mesh, scene.frame_current_final)
        if isinstance(shown, Failure):
            _hide(mesh, shown.sentence)


def _is_allowed(mesh: bpy.types.Mesh) -> bool:
    try:
        return recording_allowed(shown_by(mesh).path)
    except MocapAssistError:
        return True  # It names no recording, which is shown as its problem.


@handlers.persistent
def _loaded(*_: object) -> None:
    """Files may have changed meanwhile."""
    _open.cache_clear()
    _rays.cache_clear()
    _follow(bpy.context.scene)


def register() -> None:
    """Let previews follow the timeline."""
    handlers.frame_change_pre.append(_follow)
    handlers.load_post.append(_loaded)


def unregister() -> None:
    """Do so no longer, and close all recordings."""
    handlers.load_post.remove(_loaded)
    handlers.frame_change_pre.remove(_follow)
    _open.cache_clear()
    _rays.cache_clear()
