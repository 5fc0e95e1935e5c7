"""A depth recording as an object: an animated point cloud, read when shown."""

import logging
from collections.abc import Mapping
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

from ...solvers.depth_scene import DepthRecording, FloorPlane
from ...solvers.errors import MocapAssistError
from ...solvers.faults import Failure, attempt
from ...solvers.recordings import CameraOrientation, DepthSettings, read_depth
from ...solvers.settings import with_present_names
from ..blender.data_names import fitting_name
from ..blender.path_properties import absolute
from ..blender.permissions import allow_recording, recording_allowed
from ..blender.stored_json import load_json, store_json
from ..scene.scene_objects import add_object, in_object_mode
from .depth_points import OBSERVED, point_nodes

logger = logging.getLogger(__name__)

KEY = "mocap_assist_depth"
"""Custom property of a mesh: its recording and timing, as JSON."""
PROBLEM = "mocap_assist_depth_problem"
"""Custom property of a mesh: why it shows no points."""
NOT_ALLOWED = (
    "This file shows a depth recording that has not been opened on this machine yet."
    " Press Show Points."
)
MAX_POINTS = 20_000
N_SAMPLES = 5
"""Depth images that estimate the number of observed points."""
MAX_OPEN = 4
"""Recordings that are kept open."""


@dataclass(frozen=True)
class Shown:
    """Recording of a preview, its first scene frame, and scene frames per depth image."""

    path: str
    settings: DepthSettings
    start: float
    step: float
    every: int
    """Step between the columns and rows of an image that become points."""

    def write(self, mesh: bpy.types.Mesh) -> None:
        """Store this in a mesh."""
        store_json(mesh, KEY, self.as_dict())

    def as_dict(self) -> dict[str, Any]:
        """Return this as a dictionary for JSON."""
        settings = {
            name: value.name if isinstance(value, Enum) else value
            for name, value in asdict(self.settings).items()
        }
        return {**asdict(self), "settings": settings}

    @classmethod
    def read(cls, mesh: bpy.types.Mesh) -> "Shown":
        """Return the preview data of a mesh; raises ValueError, TypeError or KeyError."""
        return cls.of(load_json(mesh, KEY, dict))

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> "Shown":
        """Invert `as_dict`; raises ValueError, TypeError or KeyError for invalid data."""
        settings = with_present_names(DepthSettings, data["settings"])
        settings["held"] = CameraOrientation[settings["held"]]
        start, step, every = float(data["start"]), float(data["step"]), int(data["every"])
        if not (isfinite(start) and isfinite(step) and step > 0.0 and every > 0):
            raise ValueError(f"start {start}, step {step}, every {every}")
        return cls(str(data["path"]), DepthSettings(**settings), start, step, every)

    def image_at(self, frame: float, n_frames: int) -> int:
        """Return the index of the image at a scene frame, clamped to the recording."""
        return round(float(np.clip((frame - self.start) / self.step, 0, n_frames - 1)))

    def frame(self, image: int) -> float:
        """Return the scene frame of an image."""
        return self.start + self.step * image


def build_preview(
    context: bpy.types.Context,
    name: str,
    recording: DepthRecording,
    shown: Shown,
    camera_floor: FloorPlane,
    scale: float,
) -> bpy.types.Object:
    """Add an animated point cloud of a recording, and make it active.

    Its space is the camera's: x to the right, y down, z forward, in meters.

    Parameters
    ----------
    context : bpy.types.Context
    name : of the object
    recording : DepthRecording
        Read from `shown.path` with `shown.settings`.
    shown : Shown
    camera_floor : FloorPlane
        Defines the pose of the camera.
    scale : scene units per meter
    """
    in_object_mode(context)
    mesh = bpy.data.meshes.new(fitting_name(name))
    camera = recording.camera.every(shown.every)
    mesh.vertices.add(min(camera.width * camera.height, MAX_POINTS))
    mesh.attributes.new(OBSERVED, "BOOLEAN", "POINT")
    preview = bpy.data.objects.new(fitting_name(name), mesh)
    rotation, translation = camera_floor.world_from_camera()
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * rotation, scale * translation
    preview.matrix_world = Matrix(matrix.tolist())
    preview.modifiers.new("Points", "NODES").node_group = point_nodes()
    shown.write(mesh)
    add_object(context, preview)
    show_points(mesh, context.scene.frame_current_final)
    return preview


def shows_depth(shown: bpy.types.Object) -> bool:
    """Return whether an object shows a depth recording."""
    return shown.type == "MESH" and KEY in shown.data


def previews() -> list[bpy.types.Mesh]:
    """Return the meshes of this file that show recordings and can be changed."""
    meshes = [mesh for mesh in bpy.data.meshes if KEY in mesh and mesh.library is None]
    return [mesh for mesh in meshes if not mesh.is_editmode]


def problem_of(preview: bpy.types.Object) -> str:
    """Return why a preview shows no points; empty if it does, or is no preview."""
    return str(preview.data.get(PROBLEM, "")) if preview.type == "MESH" else ""


def recording_of(mesh: bpy.types.Mesh) -> DepthRecording:
    """Return the recording of a mesh, and open it if necessary.

    Raises MocapAssistError if it cannot be read, or the mesh shows no recording.
    """
    return open_recording(shown_by(mesh))


def shown_by(mesh: bpy.types.Mesh) -> Shown:
    """Return the preview data of a mesh; raises MocapAssistError if there are none."""
    try:
        return Shown.read(mesh)
    except (ValueError, TypeError, KeyError):
        raise MocapAssistError(f"{mesh.name} shows no depth recording.") from None


def open_recording(shown: Shown) -> DepthRecording:
    """Return a recording, and open it if necessary; raises MocapAssistError."""
    return _open(shown.path, shown.settings)


@lru_cache(maxsize=MAX_OPEN)
def _open(path: str, settings: DepthSettings) -> DepthRecording:
    return read_depth(absolute(path), settings)


@lru_cache(maxsize=MAX_OPEN)
def _rays(recording: DepthRecording, every: int) -> NDArray[np.float32]:
    return recording.camera.every(every).rays().astype(np.float32)


def show_on_request(mesh: bpy.types.Mesh, frame: float) -> str:
    """Show the points of a mesh and permit its recording; return a message.

    Raises MocapAssistError if the recording cannot be read, or the mesh shows no recording.
    """
    shown = shown_by(mesh)
    open_recording(shown)
    allow_recording(shown.path)
    show_points(mesh, frame)
    return f"{mesh.name} shows {shown.path}."


def cheap_step(recording: DepthRecording) -> int:
    """Return the smallest step between columns and rows that gives at most `MAX_POINTS`.

    Only observed pixels of a few images count: an actor without background keeps every pixel.
    """
    frames = np.linspace(0, recording.n_frames - 1, N_SAMPLES).astype(int).tolist()
    masks = [recording.frame(frame) > 0.0 for frame in frames]
    every = 1
    while max(mask[::every, ::every].sum() for mask in masks) > MAX_POINTS:
        every += 1
    return every


def show_points(mesh: bpy.types.Mesh, frame: float) -> None:
    """Move the points of a mesh to their positions at a scene frame, or hide them all."""
    try:
        recording, shown = recording_of(mesh), Shown.read(mesh)
        rays = _rays(recording, shown.every)
        depth = recording.frame(shown.image_at(frame, recording.n_frames))
    except MocapAssistError as error:
        _hide(mesh, str(error))
        return
    if (observed := _observed_attribute(mesh)) is None:
        _hide(mesh, f"{mesh.name} was edited. Import the recording again.")
        return
    if PROBLEM in mesh:
        del mesh[PROBLEM]
    depth = depth[:: shown.every, :: shown.every]
    row, column = np.nonzero(depth)
    n_points = len(mesh.vertices)
    if len(row) > n_points:
        sampled = np.linspace(0, len(row) - 1, n_points).astype(int)
        row, column = row[sampled], column[sampled]
    points = np.zeros((n_points, 3), np.float32)
    points[: len(row)] = rays[row, column] * depth[row, column, np.newaxis]
    mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    observed.data.foreach_set("value", np.arange(n_points) < len(row))
    mesh.update()


def _hide(mesh: bpy.types.Mesh, problem: str) -> None:
    """Hide all points, and store the reason."""
    if mesh.get(PROBLEM) == problem:
        return
    mesh[PROBLEM] = problem
    logger.warning("%s: %s", mesh.name, problem)
    if (observed := _observed_attribute(mesh)) is not None:
        observed.data.foreach_set("value", np.zeros(len(mesh.vertices), dtype=bool))
        mesh.update()


def _observed_attribute(mesh: bpy.types.Mesh) -> bpy.types.BoolAttribute | None:
    """Return the attribute of observed points; None if it was edited."""
    attribute = mesh.attributes.get(OBSERVED)
    fits = attribute is not None and (attribute.domain, attribute.data_type) == (
        "POINT",
        "BOOLEAN",
    )
    return attribute if fits else None


@handlers.persistent
def _follow(scene: bpy.types.Scene, *_: object) -> None:
    """Show the points of the scene's new frame.

    A recording without a permission on this machine stays closed until the animator opens it.
    """
    for mesh in previews():
        if not _is_allowed(mesh):
            _hide(mesh, NOT_ALLOWED)
            continue
        shown = attempt(mesh.name, show_points, mesh, scene.frame_current_final)
        if isinstance(shown, Failure):
            _hide(mesh, shown.sentence)


def _is_allowed(mesh: bpy.types.Mesh) -> bool:
    try:
        return recording_allowed(shown_by(mesh).path)
    except MocapAssistError:
        return True  # It names no recording; `show_points` reports that.


def close_recordings() -> None:
    """Close all recordings, since their files may have changed."""
    _open.cache_clear()
    _rays.cache_clear()


@handlers.persistent
def _loaded(*_: object) -> None:
    close_recordings()
    _follow(bpy.context.scene)


def register() -> None:
    """Let previews follow the timeline."""
    handlers.frame_change_pre.append(_follow)
    handlers.load_post.append(_loaded)


def unregister() -> None:
    """Stop following, and close all recordings."""
    handlers.load_post.remove(_loaded)
    handlers.frame_change_pre.remove(_follow)
    close_recordings()
