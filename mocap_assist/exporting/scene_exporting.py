"""Read the scene for the button Export, and write the file."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from math import ceil, floor
from pathlib import Path

import bpy
import numpy as np

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ...solvers.files import write_atomically
from ...solvers.processes import ScratchFolder
from ..actions.armature_read import read_take
from ..actions.curves import ON_FRAME
from ..actions.take import ArmatureTake
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps
from ..jobs.in_blender import BackgroundBlender
from ..runtime.selection import (
    played_source,
    selected_armature,
    timeline_frames,
    why_not_read,
)
from ..scene.rig import placement_of
from ..scene.scene_rate import scene_rate
from .button_settings import ExportBundle
from .file_formats import FileFormat
from .solve_exporting import ExportedTake, ExportProblem, ExportRequest, export_take
from .target_file import format_of, refuse_recording, target_of

MAX_NAMED = 5


def why_not_export(context: bpy.types.Context) -> str:
    """Return why there is nothing to export, or an empty text."""
    if selected_armature(context) is None:
        return "Select an animated armature."
    return why_not_read(context)


@Sliced
def read_export(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: ExportBundle
) -> "Steps[partial[ExportedTake]]":
    """Read the armature with its action; return the picklable solve.

    Raises
    ------
    InvalidFileError
        The file cannot be written, or is the recording itself.
    InvalidMotionError
        There is no motion, it has gaps, or no frame of the scene lies in it.
    """
    choices = settings.choices
    target = target_of(settings.file.filepath, choices)
    source = played_source(armature)
    if not choices.overwrite_recording:
        refuse_recording(target, armature, source)
    take = yield from read_take.steps(armature, scene, choices.frame_range, source)
    _refuse_gaps(take, armature, source[0].name)
    _, _, scale = placement_of(armature.matrix_world, armature.name)
    file_format = format_of(target, choices)
    meshes = _skinned_meshes(scene, armature) if choices.meshes else ()
    action, slot = source
    blend, names = _as_blend(armature, source, meshes)
    request = ExportRequest(
        armature=names[0],
        action=action.name,
        slot=slot.identifier,
        meshes=() if file_format is FileFormat.BVH else names[1:],
        frames=_scene_frames(take, source[0].name),
        fps=scene.render.fps,
        fps_base=scene.render.fps_base,
        meters=take.rest.scale / scale,
        body=take.parts[0].motion.skeleton.names[0],
        file_format=file_format,
        bones=choices.exported_bones,
    )
    blender = BackgroundBlender(str(bpy.app.binary_path))
    return partial(export_take, ExportProblem(blend, request, blender))


def write_exported(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: ExportBundle,
    exported: ExportedTake,
    solved_digest: str | None = None,
) -> str:
    """Write the file atomically; return a sentence about it.

    Raises InvalidFileError if it cannot be written; what was there is unchanged.
    """
    target = target_of(settings.file.filepath, settings.choices)
    with write_atomically(target) as part:
        part.write_bytes(exported.content)
    unit = format_of(target, settings.choices).unit_name
    written = exported.written
    bones = "1 bone" if written.n_bones == 1 else f"{written.n_bones} bones"
    what = (
        f"{played_source(armature)[0].name} was exported to {target.name}:"
        f" {written.n_frames} frames at {scene_rate(scene):g} fps, {bones}, in {unit}, Y up."
    )
    return " ".join([what, *written.notes])


def _refuse_gaps(take: ArmatureTake, armature: bpy.types.Object, action: str) -> None:
    """Raise InvalidMotionError where a bone is missing: no such file can have gaps."""
    missing = {
        bone: np.isnan(each.rotations).any(axis=-1) | np.isnan(each.locations).any(axis=-1)
        for bone, each in zip(take.rig.bones, take.channels, strict=True)
    }
    names = [bone for bone, frames in missing.items() if frames.any()]
    if names:
        gaps = np.any([missing[name] for name in names], axis=0)
        first = timeline_frames(armature, take.frames)[int(gaps.argmax())]
        listed = ", ".join(names[:MAX_NAMED]) + (", ..." if len(names) > MAX_NAMED else "")
        raise InvalidMotionError(
            f"{action} has gaps ({listed}; the first at frame {first:g}), which exported files"
            " cannot store. Fill them with Clean, then export."
        )


def _scene_frames(take: ArmatureTake, action: str) -> range:
    """Return the frames of the scene within a take, whose keys may lie between frames."""
    frames = range(ceil(take.frames[0] - ON_FRAME), floor(take.frames[-1] + ON_FRAME) + 1)
    if not frames:
        raise InvalidMotionError(f"No frame of the scene lies within the keys of {action}.")
    return frames


def _skinned_meshes(
    scene: bpy.types.Scene, armature: bpy.types.Object
) -> tuple[bpy.types.Object, ...]:
    return tuple(
        each
        for each in scene.objects
        if each.type == "MESH"
        and any(m.type == "ARMATURE" and m.object == armature for m in each.modifiers)
    )


def _as_blend(
    armature: bpy.types.Object, source: Source, meshes: tuple[bpy.types.Object, ...]
) -> tuple[bytes, tuple[str, ...]]:
    """Return a .blend file with an armature, an action and meshes, and its objects' names.

    Of linked objects it has copies. The open file is unchanged.

    Raises
    ------
    InvalidFileError
        Temporary files cannot be written.
    """
    with ScratchFolder() as scratch, _local((armature, *meshes)) as objects:
        path = Path(scratch.path) / "take.blend"
        try:
            bpy.data.libraries.write(str(path), {*objects, source[0]}, path_remap="ABSOLUTE")
            return path.read_bytes(), tuple(each.name for each in objects)
        except (OSError, RuntimeError) as error:
            raise InvalidFileError(
                f"Temporary files cannot be written in {scratch.path.parent}:"
                f" {str(error).strip()}. Make room there."
            ) from None


@contextmanager
def _local(objects: tuple[bpy.types.Object, ...]) -> Iterator[tuple[bpy.types.Object, ...]]:
    """Yield the objects, with temporary copies of linked ones, which a file cannot hold."""
    copies = {each: each.copy() for each in objects if each.library is not None}
    try:
        for copy in copies.values():
            for modifier in copy.modifiers:
                if modifier.type == "ARMATURE" and modifier.object in copies:
                    modifier.object = copies[modifier.object]
        yield tuple(copies.get(each, each) for each in objects)
    finally:
        for copy in copies.values():
            bpy.data.objects.remove(copy)
