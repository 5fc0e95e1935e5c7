"""Refuse glTF files whose few bytes state numbers that would fill the memory."""

from collections.abc import Mapping, Sequence
from typing import Any

from ...solvers.errors import InvalidFileError
from .gltf_skins import dict_of, list_of

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
"""By definition of glTF 2.0, as the next."""
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MAX_UNFOLDING = 4
"""Bytes of the arrays that the importer makes for each byte of a file, a ratio: several
channels may share an array. It bounds the memory, with the next."""
UNFOLDED_BYTES = 1 << 29
"""Bytes of such arrays that a file of any size may have: those of zeros, such as of shapes of a
face, and of compressed meshes are stored in fewer. A face of 80,000 triangles in 20 parts with
57 shapes has 437 MB."""


def refuse_inflated(path: str, content: Mapping[str, Any], n_bytes: int) -> None:
    """Raise InvalidFileError if the importer would make far more of a file than it holds.

    Parameters
    ----------
    path : str
    content : the JSON of the file
    n_bytes : of the file and of the files that it names
    """
    accessors = [dict_of(each) for each in list_of(content.get("accessors"))]
    total = sum(_size(accessors, index) for index in _used_accessors(content))
    total += sum(
        _mesh_size(accessors, dict_of(mesh)) for mesh in list_of(content.get("meshes"))
    )
    if total > UNFOLDED_BYTES + MAX_UNFOLDING * n_bytes:
        raise InvalidFileError(
            f"{path} states {total / 1e9:.3g} GB of numbers, which it does not hold. Export it"
            " again."
        )


def _mesh_size(accessors: Sequence[Mapping[str, Any]], mesh: Mapping[str, Any]) -> int:
    """Return the bytes of a mesh, whose parts may share the numbers of all vertices.

    The importer reads these once, and then copies for each part those that its faces name.
    """
    total, read = 0, set()
    for primitive in map(dict_of, list_of(mesh.get("primitives"))):
        indices = primitive.get("indices")
        total += _size(accessors, indices)
        n_corners = _count(accessors, indices) if indices is not None else None
        for named in (primitive.get("attributes"), *list_of(primitive.get("targets"))):
            for index in map(_hashable, dict_of(named).values()):
                total += _size(accessors, index, n_corners)
                if index not in read:
                    total += _size(accessors, index)
                    read.add(index)
    return total


def _size(accessors: Sequence[Mapping[str, Any]], index: Any, n_used: int | None = None) -> int:
    """Return the bytes of an accessor, or of `n_used` of its items."""
    count = _count(accessors, index)
    if not count:
        return 0
    accessor = accessors[index]
    width = COMPONENT_BYTES.get(_hashable(accessor.get("componentType")), 0)
    n_components = COMPONENTS.get(_hashable(accessor.get("type")), 0)
    return (count if n_used is None else min(count, n_used)) * width * n_components


def _count(accessors: Sequence[Mapping[str, Any]], index: Any) -> int:
    if not isinstance(index, int) or not 0 <= index < len(accessors):
        return 0
    count = accessors[index].get("count")
    return max(0, count) if isinstance(count, int) else 0


def _hashable(value: Any) -> Any:
    return value if isinstance(value, int | str) else None


def _used_accessors(content: Mapping[str, Any]) -> list[Any]:
    """Return the accessors of animations and skins each time that one becomes an array."""
    found: list[Any] = []
    for animation in list_of(content.get("animations")):
        samplers = list_of(dict_of(animation).get("samplers"))
        for channel in list_of(dict_of(animation).get("channels")):
            index = dict_of(channel).get("sampler")
            if isinstance(index, int) and 0 <= index < len(samplers):
                sampler = dict_of(samplers[index])
                found += [sampler.get("input"), sampler.get("output")]
    found += [
        dict_of(each).get("inverseBindMatrices") for each in list_of(content.get("skins"))
    ]
    return found
