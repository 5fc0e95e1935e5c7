"""Folders of EXR depth images, for example Blender's Z pass, converted to archives.

Only Blender can read the images. They are therefore copied once, into
an archive in the extension's own folder, which is read like any other recording.
"""

import hashlib
import shutil
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np

from ...solvers.arrays import Single
from ...solvers.depth_scene import Camera
from ...solvers.errors import InvalidFileError
from ...solvers.files import write_atomically
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings.depth_files import check_exr, sort_naturally

EXR = ".exr"
EXTENSION = __package__.rpartition(".mocap_assist")[0]
MAX_DEPTH = 65_000.0
"""Number, in units of the image, from which a pixel is background. By definition below the
largest half float, 65504; Blender writes 10 000 000 000, or that."""

MAX_COPIES, MAX_COPY_BYTES = 16, 8_000_000_000
"""Copies that are kept: those that were used last, and those that the open file shows."""


def exr_files(folder: Path) -> list[Path]:
    """Return the EXR images in a folder, in their order."""
    if not folder.is_dir():
        return []
    names = [
        path.name
        for path in folder.iterdir()
        if path.suffix.lower() == EXR and path.is_file()  # not a pipe, which never ends
    ]
    return [folder / name for name in sort_naturally(names)]


def as_archive(
    folder: Path, camera: Camera, frame_rate: float, progress: Progress = unwatched
) -> Path:
    """Return an archive of the depth in the first channel of the images of a folder.

    An existing archive of the same images is reused. Before another one is made,
    those go that were used longest ago, where there are too many (`MAX_COPIES`).

    Parameters
    ----------
    folder : Path
    camera : Camera
    frame_rate : float, hertz
    progress : Progress

    Raises
    ------
    InvalidFileError
        An image cannot be read, or has another size than the first.
    SolveCancelled
        Raised by `progress`.
    """
    files = exr_files(folder)
    states = [(each.name, each.stat().st_mtime_ns, each.stat().st_size) for each in files]
    key = repr((str(folder.resolve()), states, camera, frame_rate))
    digest = hashlib.sha256(key.encode()).hexdigest()[:16]
    archives = Path(bpy.utils.extension_path_user(EXTENSION, path="depth", create=True))
    archive = archives / digest / f"{folder.name}.npz"
    if archive.is_file():
        archive.touch()
        return archive
    remove_old_copies(archives, MAX_COPIES - 1, MAX_COPY_BYTES)
    archive.parent.mkdir(parents=True, exist_ok=True)
    numbers = {name: getattr(camera, name) for name in ("fx", "fy", "cx", "cy")}
    numbers["frame_rate"] = frame_rate
    shape = (len(files), camera.height, camera.width)
    packed = zipfile.ZIP_DEFLATED
    with write_atomically(archive) as part, zipfile.ZipFile(part, "w", packed) as made:
        with made.open("depth.npy", "w", force_zip64=True) as file:
            header = {"descr": "<f4", "fortran_order": False, "shape": shape}
            # numpy does not say of what type it is
            write_header: Callable[..., None] = np.lib.format.write_array_header_1_0
            write_header(file, header)
            for number, depth in enumerate(_pictures(files, shape[1:])):
                file.write(depth.astype("<f4").tobytes())
                progress(number / len(files), "Reading")
        for name, number in numbers.items():
            with made.open(f"{name}.npy", "w") as file:
                np.save(file, np.array(float(number)))
    return archive


def remove_old_copies(archives: Path, n_copies: int, n_bytes: int) -> None:
    """Remove the copies used longest ago, until the limits of number and bytes are met.

    Each is a folder of its own, named by its digest. Those that the open file shows stay.
    """
    shown = [
        value
        for data in (*bpy.data.meshes, *bpy.data.armatures)
        for value in data.values()
        if isinstance(value, str)
    ]
    copies = sorted(filter(Path.is_dir, archives.iterdir()), key=_last_use, reverse=True)
    sizes = np.cumsum([sum(file.stat().st_size for file in copy.iterdir()) for copy in copies])
    for number, (copy, size) in enumerate(zip(copies, sizes, strict=True), start=1):
        in_use = any(copy.name in value for value in shown)
        if (number > n_copies or size > n_bytes) and not in_use:
            shutil.rmtree(copy, ignore_errors=True)


def _last_use(copy: Path) -> float:
    return max((file.stat().st_mtime for file in copy.iterdir()), default=0.0)


def size_of(path: Path) -> tuple[int, int]:
    """Return width and height of an image; raises InvalidFileError if it cannot be read."""
    height, width = _picture(path).shape
    return width, height


def _pictures(files: list[Path], shape: tuple[int, ...]) -> Iterator[Single]:
    for path in files:
        depth = _picture(path)
        if depth.shape != shape:
            raise InvalidFileError(
                f"{path} has {depth.shape[1]} x {depth.shape[0]} pixels, the first image"
                f" {shape[1]} x {shape[0]}. Remove it from the folder."
            )
        yield depth


def _picture(path: Path) -> Single:
    """Return the first channel, the top row first; 0 for the background."""
    check_exr(path)  # Blender unpacks images of any size.
    try:
        image = bpy.data.images.load(str(path), check_existing=False)
    except RuntimeError:
        raise InvalidFileError(f"{path} cannot be read. Render it again.") from None
    try:
        image.colorspace_settings.name = "Non-Color"
        width, height = image.size
        if not (width and height and image.has_data | bool(len(image.pixels))):
            raise InvalidFileError(
                f"{path} is not an image that Blender can read: it is damaged, or has several"
                " layers. Write depth to its own file."
            )
        pixels = np.empty(width * height * image.channels, np.float32)
        image.pixels.foreach_get(pixels)
        depth = pixels.reshape(height, width, image.channels)[::-1, :, 0]
    finally:
        bpy.data.images.remove(image)
    observed = np.isfinite(depth) & (depth > 0.0) & (depth < MAX_DEPTH)
    return np.where(observed, depth, np.float32(0.0))
