"""Find FBX files that the importer of Blender 4.5 reads only in part."""

import re

import bpy

from ...solvers.files import open_regular

FIRST_COMPLETE = (5, 0, 0)
"""Version of Blender whose importer reads these files. By definition of `loses_curves`."""
TEXT = re.compile(rb'C:\s*"OP"\s*,\s*-?\d+\s*,\s*(-?\d+)\s*,\s*"d\|([XYZ])"')
BINARY = re.compile(rb"S\x02\0\0\0OPL.{8}L(.{8})S\x03\0\0\0d\|([XYZ])", re.DOTALL)


def loses_curves(path: str) -> bool:
    """Whether this Blender drops animation of a binary FBX file silently.

    The importer of Blender 4.5 drops a location, rotation or scale without a curve for X,
    such as that of a knee that turns about Z only. Another importer reads binary files.
    """
    return _lacks_x(path, BINARY)


def describe_missing_curves(path: str) -> str:
    """Return a message that this Blender drops animation of a text FBX file; empty if not.

    Text has no other importer.
    """
    if not _lacks_x(path, TEXT):
        return ""
    return (
        f"Blender {bpy.app.version_string} leaves out joints that turn or shift without a curve"
        " for X, since this FBX file is text. Export it as binary FBX, or use Blender 5"
    )


def _lacks_x(path: str, link: re.Pattern[bytes]) -> bool:
    """Whether the curves that are linked to a channel lack the one for X."""
    if bpy.app.version >= FIRST_COMPLETE:
        return False
    with open_regular(path) as file:
        content = file.read()
    links = content[max(content.rfind(b"Connections"), 0) :]
    channels: dict[bytes, set[bytes]] = {}
    for found in link.finditer(links):
        channels.setdefault(found[1], set()).add(found[2])
    return any(b"X" not in each for each in channels.values())
