"""Give the joints of a glTF file without a skin one, so that Blender makes an armature of them.

Animations of web pages and game engines come without the mesh that they move: a tree of nodes.
Blender makes an armature only of nodes that a skin names.
"""

import json
import re
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...solvers.recordings.conventions import MIN_BODY_JOINTS

GLB_MAGIC, GLB_VERSION, GLB_JSON = 0x46546C67, 2, 0x4E4F534A
HEADER_BYTES = 20
"""Bytes of the headers of the file and of its first chunk."""
MAX_SCALE_ERROR = 0.05
"""Deviation of a joint's scale from 1, a ratio; a node of another scale is an object that holds
joints. It guards against rounding of scales that exporters bake."""


def find_joint_trees(content: Mapping[str, Any]) -> list[list[int]]:
    """Return the nodes of each animated tree that is large enough for a body.

    Empty where the file has a skin: it says which nodes are joints.
    """
    nodes = [dict_of(each) for each in list_of(content.get("nodes"))]
    if list_of(content.get("skins")):
        return []
    animated = _animated_nodes(content)
    below = {child for node in nodes for child in _children(node, len(nodes))}
    visited: set[int] = set()
    trees = []
    for top in (index for index in range(len(nodes)) if index not in below):
        for root in _joint_roots(nodes, top, animated):
            tree = _subtree(nodes, root, visited)
            if sum(node in animated for node in tree) >= MIN_BODY_JOINTS:
                trees.append(tree)
    return trees


def write_with_skins(
    path: str, content: Mapping[str, Any], trees: list[list[int]], copy: Path
) -> None:
    """Write a copy of a glTF file, text or binary, whose joints have skins."""
    skins = [{"joints": tree, "skeleton": tree[0]} for tree in trees]
    folder = Path(path).resolve().parent
    changed = {
        **content,
        "skins": skins,
        "buffers": [
            _found_from_elsewhere(each, folder) for each in list_of(content.get("buffers"))
        ],
    }
    text = json.dumps(changed).encode()
    with Path(path).open("rb") as file, copy.open("wb") as target:
        head = file.read(HEADER_BYTES)
        if head[:4] != struct.pack("<I", GLB_MAGIC):
            target.write(text)
            return
        file.seek(HEADER_BYTES + struct.unpack("<I", head[12:16])[0])
        rest = file.read()
        text += b" " * (-len(text) % 4)
        total = HEADER_BYTES + len(text) + len(rest)
        target.write(struct.pack("<III", GLB_MAGIC, GLB_VERSION, total))
        target.write(struct.pack("<II", len(text), GLB_JSON) + text + rest)


def _joint_roots(nodes: list[dict[str, Any]], top: int, animated: set[int]) -> list[int]:
    """Return the uppermost joints below a node of a scene."""
    waiting, roots, visited = [top], [], set()
    while waiting:
        node = waiting.pop()
        if node in visited:
            continue
        visited.add(node)
        if node in animated and _is_of_scale_one(nodes[node]):
            roots.append(node)
        else:
            waiting += _children(nodes[node], len(nodes))
    return roots


def _subtree(nodes: list[dict[str, Any]], root: int, visited: set[int]) -> list[int]:
    waiting, tree = [root], []
    while waiting:
        node = waiting.pop()
        if node not in visited:
            visited.add(node)
            tree.append(node)
            waiting += _children(nodes[node], len(nodes))
    return tree


def _animated_nodes(content: Mapping[str, Any]) -> set[int]:
    """Return the nodes whose rotation is animated."""
    return {
        target["node"]
        for animation in list_of(content.get("animations"))
        for channel in list_of(dict_of(animation).get("channels"))
        if (target := dict_of(dict_of(channel).get("target"))).get("path") == "rotation"
        and isinstance(target.get("node"), int)
    }


def _is_of_scale_one(node: Mapping[str, Any]) -> bool:
    scale = list_of(node.get("scale")) or [1.0]
    return all(
        isinstance(each, int | float) and abs(each - 1.0) <= MAX_SCALE_ERROR for each in scale
    )


def _children(node: Mapping[str, Any], n_nodes: int) -> list[int]:
    return [
        child
        for child in list_of(node.get("children"))
        if isinstance(child, int) and 0 <= child < n_nodes
    ]


def _found_from_elsewhere(buffer: Any, folder: Path) -> Any:
    """Return a buffer whose file can be found from another folder, too."""
    uri = dict_of(buffer).get("uri")
    if not isinstance(uri, str) or uri.startswith("data:"):
        return buffer
    return {**buffer, "uri": _quote_path(folder.as_posix()) + "/" + uri}


def list_of(value: Any) -> list[Any]:
    """Return a list of parsed JSON; an empty one if it is something else."""
    return value if isinstance(value, list) else []


def dict_of(value: Any) -> dict[str, Any]:
    """Return an object of parsed JSON; an empty one if it is something else."""
    return value if isinstance(value, dict) else {}


def _quote_path(path: str) -> str:
    """Return a path as a URI: all but letters, digits and `-._~/` as percent signs and hex."""
    text = re.sub(rb"[^A-Za-z0-9._~/-]", lambda match: b"%%%02X" % match[0][0], path.encode())
    return text.decode()
