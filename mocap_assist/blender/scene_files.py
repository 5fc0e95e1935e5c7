"""Open files that Blender itself can read: scenes, and the exports of other programs."""

import re
import struct
from collections import Counter
from os import SEEK_END
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import addon_utils
import bpy

from ...solvers.errors import InvalidFileError
from ...solvers.files import open_regular
from ...solvers.json_text import parse_json
from ...solvers.motion.skeletons import MAX_FRAME_RATE_HZ
from ...solvers.recordings import SCENE_SUFFIXES, refuse_stand_ins, suffix_by_content
from .fbx_curves import loses_curves
from .fbx_sizes import refuse_inflated_fbx
from .gltf_sizes import refuse_inflated
from .gltf_skins import (
    GLB_JSON,
    GLB_MAGIC,
    dict_of,
    find_joint_trees,
    list_of,
    with_short_names,
    without_picture_files,
    write_with_skins,
)
from .picture_paths import without_pictures
from .stated_conventions import read_stage
from .usd_layers import refuse_other_sources

COMMON_RATES = (15.0, 24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0, 200.0, 240.0)
"""Rates of captured and of animated takes, hertz, by definition of film, video and capture
systems."""
MIN_RATE_HZ = 12.0
"""Hertz: below it, keys are sparse, no sampled motion, but one that was set by hand. By
definition half the 24 Hz of film: animation on twos is sampled."""
RATE_OF_SPARSE_KEYS_HZ = 30.0
"""Hertz at which motion between sparse keys is sampled. By definition that of files which state
none (`DEFAULT_FRAME_RATE`)."""
RATE_TOLERANCE = 0.01
"""Relative deviation of a measured rate from a common one that is only rounding of key times.
It guards 23.976 and 24 Hz, 1e-3 apart, which are one."""
MAX_JSON_BYTES = 1 << 28
USD_OPTIONS: dict[str, Any] = {
    "import_cameras": False, "import_materials": False,
    "import_textures_mode": "IMPORT_NONE",
}  # fmt: skip
TRACEBACK = "Traceback (most recent"
DAMAGED_FBX = ("Failed to load", "Empty file", "Truncated file")
"""Reasons that Blender's importer of FBX gives for files that were cut off."""


def open_scene_file(path: str, *, meshes: bool = False) -> None:
    """Replace the open scene by a .blend file, or by what an importer makes of another file.

    Scripts and drivers of the file are off. The scene plays at the rate of the file. USD is
    read without its meshes unless they are wanted.

    Raises
    ------
    InvalidFileError
        This Blender cannot read the file.
    """
    suffix = suffix_by_content(path)
    if suffix not in SCENE_SUFFIXES:
        return _run(path, bpy.ops.wm.open_mainfile, load_ui=False, use_scripts=False)
    refuse_stand_ins(path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if suffix == ".fbx":
        return _open_fbx(path)
    if suffix == ".dae":
        return _open_collada(path)
    if suffix in {".usd", ".usda", ".usdc", ".usdz"}:
        return _open_usd(path, meshes)
    return _open_gltf(path)


def _run(path: str, operator: Any, opened: str = "", **options: Any) -> None:
    """Import a file, or a copy of it under another path."""
    try:
        operator(filepath=opened or path, **options)
    except RuntimeError as error:
        raise InvalidFileError(
            f"{path} cannot be read: {_reason_of(error)}. Save it again where it was made."
        ) from None


def _reason_of(error: RuntimeError) -> str:
    """Return the reason that an importer gives, in one line; of a traceback, its last word."""
    lines = str(error).strip().removeprefix("Error:").strip().splitlines() or [""]
    if TRACEBACK in lines[0]:
        kinds = [
            line for line in lines if re.match(r"[A-Za-z_][\w.]*(Error|Exception)\b", line)
        ]
        kind = kinds[-1].partition(":")[0] if kinds else "an error"
        return f"Blender's importer failed with {kind.rpartition('.')[2].lstrip('_')}"
    return lines[0].rstrip(".") or "no reason is given"


def _open_fbx(path: str) -> None:
    """Import FBX; by the older importer, which is slower, where the other one loses keys."""
    refuse_inflated_fbx(path)
    importer = bpy.ops.wm.fbx_import
    if loses_curves(path):
        addon_utils.enable("io_scene_fbx")
        importer = bpy.ops.import_scene.fbx
    try:
        with without_pictures(path) as opened:
            _run(path, importer, opened)
    except InvalidFileError as error:
        if any(reason in str(error) for reason in DAMAGED_FBX):
            raise _damaged_file_error(path) from None
        raise


def _damaged_file_error(path: str) -> InvalidFileError:
    return InvalidFileError(f"{path} is damaged or incomplete. Export it again.")


def _open_usd(path: str, meshes: bool) -> None:
    """Import USD; its times are frames, at a rate that the importer ignores."""
    refuse_other_sources(path)
    _run(path, bpy.ops.wm.usd_import, path, **USD_OPTIONS, import_meshes=meshes)
    if 0.0 < (rate := read_stage(path).frame_rate) < MAX_FRAME_RATE_HZ:
        render = bpy.context.scene.render
        render.fps = max(1, round(rate))
        render.fps_base = render.fps / rate


def _open_collada(path: str) -> None:
    if "collada_import" not in dir(bpy.ops.wm):
        raise InvalidFileError(
            f"{path} is a Collada file, which Blender {bpy.app.version_string} no longer reads."
            " Convert it to FBX or glTF, or import it in Blender 4.5."
        )
    with without_pictures(path) as opened:
        _run(path, bpy.ops.wm.collada_import, opened)


def _open_gltf(path: str) -> None:
    """Import glTF, GLB, VRM or VRMA; times become frames at the rate of the file's keys."""
    addon_utils.enable("io_scene_gltf2")
    stored = _gltf_content(path)
    refuse_inflated(path, stored, Path(path).stat().st_size + _refuse_other_files(path, stored))
    content = with_short_names(without_picture_files(stored))
    render = bpy.context.scene.render
    rate = _gltf_rate(content)
    render.fps = max(1, round(rate))
    render.fps_base = rate / render.fps  # Blender's importer multiplies by it
    trees = find_joint_trees(content)
    is_changed = bool(trees) or content != stored
    with TemporaryDirectory() as folder:
        copy = Path(folder) / Path(path).name
        if is_changed:
            write_with_skins(path, content, trees, copy)
        _run(path, _import_gltf, str(copy) if is_changed else path)
    render.fps_base = render.fps / rate


def _import_gltf(*, filepath: str) -> None:
    bpy.ops.import_scene.gltf(
        filepath=filepath, disable_bone_shape=True, import_shading="NORMALS"
    )


def _gltf_content(path: str) -> dict[str, Any]:
    """Return the JSON of a glTF file, text or binary."""
    with open_regular(path) as file:
        head = file.read(20)
        if len(head) == 20 and struct.unpack("<I", head[:4])[0] == GLB_MAGIC:
            total, length, kind = struct.unpack("<III", head[8:20])
            if kind != GLB_JSON or length > MAX_JSON_BYTES:
                raise _damaged_file_error(path)
            text = file.read(length)
            if file.seek(0, SEEK_END) < total:
                raise _damaged_file_error(path)
        else:
            text = head + file.read(MAX_JSON_BYTES)
    if not text:
        raise _damaged_file_error(path)
    try:
        content = parse_json(text)
    except ValueError:
        content = None
    if not isinstance(content, dict) or "asset" not in content:
        raise InvalidFileError(f"{path} is not a glTF file despite its extension.")
    return content


def _refuse_other_files(path: str, content: dict[str, Any]) -> int:
    """Return how many bytes are in other files of the folder.

    Raise InvalidFileError if the numbers of a file are in another one outside its folder.

    It is a stranger's: it may name devices, pipes, private files or those of a server.
    """
    folder, n_bytes = Path(path).resolve().parent, 0
    for buffer in list_of(content.get("buffers")):
        uri = dict_of(buffer).get("uri")
        if uri is None or (isinstance(uri, str) and uri.startswith("data:")):
            continue
        named = folder / _unquote_uri(str(uri)).replace("\\", "/")
        if not (named.resolve().is_relative_to(folder) and named.is_file()):
            raise InvalidFileError(
                f"{path} needs {str(uri)[:80]}, which is not a file in its folder. Export it as"
                " one .glb file."
            )
        n_bytes += named.stat().st_size
    return n_bytes


def _unquote_uri(uri: str) -> str:
    """Return a path with its percent signs decoded, as the importer will read it."""
    content = re.sub(
        rb"%([0-9A-Fa-f]{2})", lambda match: bytes([int(match[1], 16)]), uri.encode()
    )
    return content.decode("utf-8", "replace")


def _gltf_rate(content: dict[str, Any]) -> float:
    """Return the rate of most keys in hertz, from the numbers and times of the samplers."""
    accessors = list_of(content.get("accessors"))
    rates: list[float] = []
    for animation in list_of(content.get("animations")):
        for sampler in list_of(dict_of(animation).get("samplers")):
            index = dict_of(sampler).get("input")
            if isinstance(index, int) and 0 <= index < len(accessors):
                rates += _key_rate(dict_of(accessors[index]))
    if not rates:
        return RATE_OF_SPARSE_KEYS_HZ
    rate = Counter(rates).most_common(1)[0][0]
    nearest = min(COMMON_RATES, key=lambda common: abs(common - rate))
    if abs(nearest - rate) <= RATE_TOLERANCE * nearest:
        return nearest
    return rate if rate >= MIN_RATE_HZ else RATE_OF_SPARSE_KEYS_HZ


def _key_rate(accessor: dict[str, Any]) -> list[float]:
    """Return the rate of evenly spaced keys, or None if the file does not state it."""
    count, first, last = (accessor.get(name) for name in ("count", "min", "max"))
    if not isinstance(count, int):
        return []
    try:
        duration = float(list_of(last)[0]) - float(list_of(first)[0])
        rate = (count - 1) / duration if duration > 0.0 else 0.0
    except (IndexError, TypeError, ValueError, OverflowError):
        return []
    return [round(rate, 3)] if 0.0 < rate < MAX_FRAME_RATE_HZ else []
