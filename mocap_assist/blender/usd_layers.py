"""Refuse USD files that would make Blender wait for a pipe, read a device or ask a server."""

import re
from pathlib import Path
from typing import Any

import bpy

from ...solvers.errors import InvalidFileError

NETWORK = re.compile(r"[\\/]{2}|[A-Za-z][\w+.-]+:[\\/]{2}")
"""The begin of a path on another computer: a share of Windows, or an address. A drive is one
letter."""
LAYER_SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")
EXPRESSION, QUOTES = "`", "`'\""
"""The begin of a path that variables become part of, which may be any, and what surrounds
it."""
MAX_SHOWN = 80


def refuse_other_sources(path: str) -> None:
    """Raise InvalidFileError if one of the files that a USD file is made of is none.

    They may be anywhere on this computer, as in a studio. A missing one, and one that cannot
    be read, are left to the importer.
    """
    bpy.utils.expose_bundled_modules()
    try:
        from pxr import Sdf, UsdUtils
    except ImportError:
        return  # `read_stage` refuses the file
    waiting, visited = [path], set()
    while waiting:
        layer = _open_layer(Sdf, waiting.pop())
        if layer is None or layer.identifier in visited:
            continue
        visited.add(layer.identifier)
        composed = set(layer.GetCompositionAssetDependencies())
        named = composed.union(*UsdUtils.ExtractExternalReferences(layer.identifier))
        for name in sorted(named):  # pictures and clips too; pictures are not opened
            found = Sdf.ComputeAssetPathRelativeToLayer(layer, name)
            is_layer = name in composed or name.rstrip(QUOTES).lower().endswith(LAYER_SUFFIXES)
            is_elsewhere = NETWORK.match(name) or name.startswith(EXPRESSION)
            if (is_layer and is_elsewhere) or _is_no_file(found):
                raise InvalidFileError(
                    f"{path} refers to {name[:MAX_SHOWN]}, which is not a file on this"
                    " computer. Flatten it into one USD file."
                )
            if is_layer and "[" not in found and Path(found).is_file():
                waiting.append(found)


def _open_layer(sdf: Any, path: str) -> Any:
    try:
        return sdf.Layer.FindOrOpen(path)
    except RuntimeError:  # of the library, for text that is no USD
        return None


def _is_no_file(path: str) -> bool:
    """Return whether a device, a pipe or a socket is there."""
    try:
        found = Path(path)
        return found.exists() and not (found.is_file() or found.is_dir())
    except (OSError, ValueError):  # names that no file can have
        return False
