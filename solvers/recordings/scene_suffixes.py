"""Distinguish files of other programs, which only Blender's own importers read."""

from pathlib import Path

from ..errors import MocapAssistError
from ..files import open_regular

SCENE_SUFFIXES = frozenset({
    ".fbx",
    ".glb",
    ".gltf",
    ".vrm",
    ".usd",
    ".usda",
    ".usdc",
    ".usdz",
    ".dae",
})
"""Files of other programs, which only Blender's own importers read."""
SUFFIX_OF_MAGIC = {
    b"Kaydara FBX Binary": ".fbx", b"; FBX": ".fbx", b"glTF": ".glb", b"HIERARCHY": ".bvh",
}  # fmt: skip
"""Suffix of files by their first bytes, for formats that are read whatever their name is."""
VRM_ANIMATION = ".vrma"
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
HEAD_BYTES = 64
"""Number of bytes, by definition enough for each of these."""


def suffix_by_content(path: Path | str) -> str:
    """Return the suffix that fits the first bytes of a file; that of its name if unclear.

    It is in lower case. VRM animations are glTF, too, but are read without Blender.
    """
    named = Path(path).suffix.lower()
    if named == VRM_ANIMATION:
        return named
    try:
        with open_regular(path) as file:
            head = file.read(HEAD_BYTES).removeprefix(BYTE_ORDER_MARK).lstrip()
    except (OSError, ValueError, MocapAssistError):
        return named
    found = (suffix for magic, suffix in SUFFIX_OF_MAGIC.items() if head.startswith(magic))
    return next(found, named)


def is_scene_file(path: Path | str) -> bool:
    """Whether Blender's importers read a file: by its content, otherwise by its name."""
    return suffix_by_content(path) in SCENE_SUFFIXES
