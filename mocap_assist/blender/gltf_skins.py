"""Give the joints of a glTF file that no skin names one, so that Blender makes them bones.

Animations of web pages and game engines come without the mesh that they move: a tree of nodes.
Others have the skin of one mesh, such as of the head, whose exporter left out what it does not
deform. Blender makes an armature only of nodes that a skin names.
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
MAX_DEPTH = 200
"""Nodes above one another, as in VRM animations. It guards against circles and against chains
without end, whose time grows with the cube of their length."""
MAX_NAME_BYTES = 63
"""Bytes of a name in Blender, by definition. The importer fails where a letter of several bytes
is cut."""
NO_PICTURE = (
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAC"
    "hwGA60e6kgAAAABJRU5ErkJggg=="
)
"""A picture of one pixel in place of a file."""


def without_picture_files(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON of a glTF file whose pictures are in no other files: they do not move.

    They may be missing, or name a device or a private file.
    """
    images = [dict_of(each) for each in list_of(content.get("images"))]
    if not any("uri" in image for image in images):
        return dict(content)
    kept = [{**image, "uri": NO_PICTURE} if "uri" in image else image for image in images]
    return {**content, "images": kept}


def with_short_names(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON of a glTF file without names that Blender would cut within a letter."""
    nodes = list_of(content.get("nodes"))
    names = [dict_of(node).get("name") for node in nodes]
    if all(not isinstance(name, str) or name == _short(name) for name in names):
        return dict(content)
    shortened = [
        {**node, "name": _short(name)} if isinstance(name, str) else node
        for node, name in zip(nodes, names, strict=True)
    ]
    return {**content, "nodes": shortened}


def _short(name: str) -> str:
    return name.encode("utf-8", "replace")[:MAX_NAME_BYTES].decode("utf-8", "ignore")


def find_joint_trees(content: Mapping[str, Any]) -> list[list[int]]:
    """Return the nodes of each animated tree that needs a skin.

    Without any skin these are the trees that are large enough for a body; otherwise each body
    whose skins leave out joints.
    """
    nodes = [dict_of(each) for each in list_of(content.get("nodes"))]
    animated = _animated_nodes(content)
    if skins := list_of(content.get("skins")):
        return _incomplete_bodies(nodes, animated, skins)
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
    """Write a copy of a glTF file, text or binary, with a skin for each of these trees."""
    skins = [*list_of(content.get("skins")), *({"joints": tree} for tree in trees)]
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


def _incomplete_bodies(
    nodes: list[dict[str, Any]], animated: set[int], skins: list[Any]
) -> list[list[int]]:
    """Return the joints of each body whose skins leave some out: animated nodes around theirs.

    A node that carries the joints, or a mesh, is an object. So is one that is attached to such
    a node by itself, such as a prop.
    """
    parents = {
        child: index
        for index, node in enumerate(nodes)
        for child in _children(node, len(nodes))
    }
    named = {
        joint
        for skin in skins
        for joint in list_of(dict_of(skin).get("joints"))
        if isinstance(joint, int) and 0 <= joint < len(nodes)
    }
    bodies: dict[int, list[int]] = {}
    lineages = {node: _lineage(parents, node) for node in named | animated if node < len(nodes)}
    if any(len(each) > MAX_DEPTH for each in lineages.values()):
        return []
    for node in sorted(named):
        bodies.setdefault(lineages[node][-1], []).append(node)
    carriers = {above for node in named for above in lineages[node]} - named
    left_out = {
        node
        for node in animated & lineages.keys() - carriers - named
        if "mesh" not in nodes[node]
    }
    moved = left_out | named
    found = []
    for top, joints in bodies.items():
        missing = [
            node
            for node in sorted(left_out)
            if lineages[node][-1] == top
            and (
                parents.get(node) in moved
                or not left_out.isdisjoint(_children(nodes[node], len(nodes)))
            )
        ]
        if missing:
            together = [*joints, *missing]
            shared = set.intersection(*(set(lineages[node]) for node in together))
            lowest = next((node for node in lineages[together[0]] if node in shared), -1)
            is_joint = lowest in animated and _is_of_scale_one(nodes[lowest])
            found.append(sorted({*together, *([lowest] if is_joint else [])}))
    return found


def _lineage(parents: Mapping[int, int], node: int) -> list[int]:
    """Return a node and those above it, up to its root, or more than MAX_DEPTH of them."""
    chain = [node]
    while (above := parents.get(chain[-1], -1)) >= 0 and len(chain) <= MAX_DEPTH:
        chain.append(above)
    return chain


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
