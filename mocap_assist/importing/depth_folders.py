"""Folders of depth images that form one recording."""

from pathlib import Path

import bpy

from ...solvers.depth_scene import Camera
from ...solvers.errors import InvalidFileError
from ...solvers.faults import attempt
from ...solvers.recordings import (
    depth_takes_in,
    detect_depth_format,
    is_depth_folder,
    is_scene_file,
    may_contain_motion,
    one_path_per_take,
)
from ...solvers.recordings.containers import files_below, is_folder
from ..depth.exr_folder import as_archive, exr_files, size_of
from ..scene.scene_rate import scene_rate
from .button_settings import ImportChoices

WITHIN = ("depth", "color", "rgb", "image", "confidence")
"""Folders that a recording has in it."""
EXTRA_FILES = (
    "depth.txt", "rgb.txt", "associations.txt", "associates.txt", "associated.txt",
    "camera_matrix.csv", "odometry.csv", "intrinsic.json", "camera_intrinsic.json",
)  # fmt: skip
"""Files of a recording next to its images."""
PICTURES = (".png", ".exr", ".jpg", ".jpeg")


def is_take(folder: Path) -> bool:
    """Whether a folder is a depth recording; not if it cannot be read."""
    if not is_folder(folder):
        return False
    return (
        attempt(folder, lambda: bool(exr_files(folder) or detect_depth_format(folder))) is True
    )


def depth_recordings_in(folder: Path) -> list[Path]:
    """Return the depth recordings in a folder and below; the folder itself if it is one."""
    return depth_takes_in(folder, lambda each: bool(exr_files(each)) or is_depth_folder(each))


def all_recordings_in(folder: Path) -> list[Path]:
    """Return all recordings in a folder and below, by name: motion, depth, FBX, glTF, USD."""
    takes = depth_recordings_in(folder)
    others = [
        path
        for path in files_below(folder)
        if (may_contain_motion(path) or is_scene_file(path)) and not {*path.parents} & {*takes}
    ]
    return sorted({*takes, *one_path_per_take(others)})


def take_of(path: Path) -> Path:
    """Return the recording of a chosen file: for a depth image, its folder."""
    if path.suffix.lower() in PICTURES:
        inside = path.parent.name in WITHIN and is_take(path.parent.parent)
        return path.parent.parent if inside else path.parent
    if path.name in EXTRA_FILES and is_take(path.parent):
        return path.parent
    return path


def readable(context: bpy.types.Context, path: Path, choices: ImportChoices) -> Path:
    """Return a path that can be read without Blender: for EXR images, their archive.

    The camera is the one that was given, or the scene's own, which may have rendered them.

    Raises InvalidFileError if neither is known, or an image cannot be read.
    """
    files = exr_files(path)
    if not files:
        return path
    width, height = size_of(files[0])
    scene_camera = _scene_camera(context, width, height)
    camera = choices.depth.camera(width, height, scene_camera)
    if camera is None:
        raise InvalidFileError(
            f"{path} has no camera of the rendering: give the focal length"
            " in pixels, or give the scene that camera."
        )
    rate = scene_rate(context.scene)
    return as_archive(path, camera, rate)


def _scene_camera(context: bpy.types.Context, width: int, height: int) -> Camera | None:
    """Return the scene's camera for images of a size; None without a perspective camera."""
    owner = context.scene.camera
    if owner is None or owner.type != "CAMERA" or owner.data.type != "PERSP":
        return None
    lens = owner.data
    by_height = lens.sensor_fit == "VERTICAL" or (lens.sensor_fit == "AUTO" and height > width)
    sensor = lens.sensor_height if lens.sensor_fit == "VERTICAL" else lens.sensor_width
    focal = lens.lens / sensor * (height if by_height else width)
    wide = max(width, height) if lens.sensor_fit == "AUTO" else (height if by_height else width)
    return Camera(
        focal,
        focal,
        (width - 1) / 2.0 - lens.shift_x * wide,
        (height - 1) / 2.0 + lens.shift_y * wide,
        width,
        height,
    )
