"""The other depth cameras of a take: the selected recordings, and where Track found them."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.errors import InvalidMotionError, InvalidSettingError
from ..blender.block_references import BlockReference
from ..blender.path_properties import absolute
from ..depth.depth_preview import (
    Shown,
    problem_of,
    recording_of,
    show_points,
    shown_by,
    shows_depth,
)
from .pose_previews import ObjectNumber
from .solve_cameras import OtherCamera, SeveralCameras
from .solve_tracking import FoundCamera, Tracked

MATRIX_ROUNDING = 1e-4
"""Meters of a difference that is no movement. It guards the rounding of matrices to 32 bits."""


def other_previews(preview: bpy.types.Object) -> list[bpy.types.Object]:
    """Return the other selected objects that show depth recordings, in order of import.

    After a file was opened, the order is that of the file.
    """
    selected = bpy.context.view_layer.objects.selected
    others = [each for each in selected if each != preview and shows_depth(each)]
    return sorted(others, key=lambda each: each.session_uid)


def check_others(preview: bpy.types.Object, *, all_people: bool) -> None:
    """Raise MocapAssistError if the other selected recordings cannot be joined."""
    if all_people:
        raise InvalidSettingError(
            "Several cameras track one person. Switch All People or Other Cameras off."
        )
    others = other_previews(preview)
    if not others:
        raise InvalidSettingError(
            "Select the points of the other cameras, too, or switch Other Cameras off."
        )
    paths: dict[Path, str] = {}
    for each in (preview, *others):
        path = Path(absolute(shown_by(each.data).path))
        if path in paths:
            raise InvalidMotionError(
                f"{each.name} shows the same recording as {paths[path]}. Select recordings of"
                " different cameras."
            )
        paths[path] = each.name
        if problem := problem_of(each):
            raise InvalidMotionError(f"{each.name}: {problem}")


def read_cameras(preview: bpy.types.Object) -> SeveralCameras:
    """Open the recordings of the selected cameras; raises MocapAssistError."""
    others = other_previews(preview)
    return SeveralCameras(
        recording_of(preview.data),
        tuple(OtherCamera(recording_of(each.data), _number_of(each)) for each in others),
    )


def read_again(preview: bpy.types.Object, numbers: Sequence[ObjectNumber]) -> SeveralCameras:
    """Return the recordings that the cameras' objects show now."""
    return SeveralCameras(
        recording_of(preview.data),
        tuple(OtherCamera(recording_of(_object_of(each).data), each) for each in numbers),
    )


def camera_entries(cameras: Sequence[FoundCamera]) -> list[dict[str, object]]:
    """Return where the other cameras were found, for JSON."""
    return [
        {
            "object": each.object_number[-1],
            "recording": shown_by(_object_of(each.object_number).data).path,
            "first_from_camera": each.first_from_camera.tolist(),
            "offset_s": each.offset,
            "mismatch_m": each.mismatch,
        }
        for each in cameras
    ]


def scene_from_first_camera(preview: bpy.types.Object, result: Tracked) -> Matrix:
    """Return the transform (4, 4) from the first camera to the scene.

    It is that of its points, unless only another camera shows the floor: then the points of
    that one stand on the scene's floor.
    """
    if not result.first_shows_floor:
        for each in result.cameras:
            if each.shows_floor:
                camera_from_first = Matrix(each.first_from_camera.tolist()).inverted()
                return _object_of(each.object_number).matrix_world @ camera_from_first
    return preview.matrix_world.copy()


def place_cameras(
    scene: bpy.types.Scene, preview: bpy.types.Object, result: Tracked
) -> list[str]:
    """Move the points of all cameras to where and when they recorded; return sentences."""
    if not result.cameras:
        return []
    scene_from_first = scene_from_first_camera(preview, result)
    shown, rate = shown_by(preview.data), recording_of(preview.data).frame_rate
    targets = [_Place(1, preview, scene_from_first, shown)]
    for number, each in enumerate(result.cameras, start=2):
        other = _object_of(each.object_number)
        own = shown_by(other.data)
        frames_per_second = shown.step * rate
        in_time = replace(
            own,
            start=shown.start + each.offset * frames_per_second,
            step=frames_per_second / recording_of(other.data).frame_rate,
        )
        matrix = scene_from_first @ Matrix(each.first_from_camera.tolist())
        targets.append(_Place(number, other, matrix, in_time))
    # Parents first, as they move their children.
    targets.sort(key=lambda place: (_n_parents(place.preview), place.number))
    sentences = {place.number: _move(place, scene.frame_current_final) for place in targets}
    return [sentences[number] for number in sorted(sentences) if sentences[number]]


class _Place(NamedTuple):
    """Where and when the points of a camera belong."""

    number: int
    preview: bpy.types.Object
    matrix: Matrix
    """Transform (4, 4) to the scene."""
    shown: Shown


def _move(place: _Place, frame: float) -> str:
    """Move points in space and time; return a sentence, empty if they stood there."""
    number, preview, matrix, shown = place
    if _stands_at(preview, matrix) and shown_by(preview.data) == shown:
        return ""
    if not (preview.is_editable and preview.data.is_editable):
        return (
            f"The points of camera {number}, {preview.name}, are linked from another file and"
            " were not moved."
        )
    preview.matrix_world = matrix
    preview.update_tag(refresh={"TIME"})  # Keys and drivers hold it again.
    bpy.context.view_layer.update()
    shown.write(preview.data)
    show_points(preview.data, frame)
    if not _stands_at(preview, matrix):
        return (
            f"The points of camera {number}, {preview.name}, are not at its position: keys, a"
            " constraint or the scale of a parent hold them."
        )
    return f"The points of camera {number}, {preview.name}, were moved to its position."


def _stands_at(preview: bpy.types.Object, matrix: Matrix) -> bool:
    close = MATRIX_ROUNDING * matrix.median_scale
    return bool(np.allclose(preview.matrix_world, matrix, atol=close))


def _n_parents(preview: bpy.types.Object) -> int:
    return 0 if preview.parent is None else 1 + _n_parents(preview.parent)


def _number_of(preview: bpy.types.Object) -> ObjectNumber:
    """Return a reference that can be sent to another process, which does not know bpy."""
    kind, number, name = BlockReference.of(preview)
    return kind, number, name


def _object_of(number: ObjectNumber) -> bpy.types.Object:
    """Return the points of a camera; raises InvalidMotionError if they were deleted."""
    found = BlockReference(*number).find()
    assert isinstance(found, bpy.types.Object)
    return found
