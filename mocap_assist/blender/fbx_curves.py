"""Find FBX files that the importer of Blender 4.5 reads only in part."""

import re

import bpy

from ...solvers.files import open_regular

FIRST_COMPLETE = (5, 0, 0)
"""Version of Blender whose importer reads these files. By definition of `loses_curves`."""
BINARY = re.compile(rb"S\x02\0\0\0OPL.{8}L(.{8})S\x03\0\0\0d\|([XYZ])", re.DOTALL)


def loses_curves(path: str) -> bool:
    """Whether this Blender drops animation of an FBX file without a word.

    The importer of Blender 4.5 drops a location, rotation or scale without a curve for X,
    such as that of a knee that turns about Z only. Only binary files are looked into: those of
    text have no other importer.
    """
    if bpy.app.version >= FIRST_COMPLETE:
        return False
    with open_regular(path) as file:
        content = file.read()
    links = content[max(content.rfind(b"Connections"), 0) :]
    channels: dict[bytes, set[bytes]] = {}
    for found in BINARY.finditer(links):
        channels.setdefault(found[1], set()).add(found[2])
    return any(b"X" not in each for each in channels.values())
