"""Refuse glTF files whose few bytes state numbers that would fill the memory."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

from ...solvers.errors import InvalidFileError
from .gltf_skins import dict_of, list_of

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
"""By definition of glTF 2.0, as the next."""
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MAX_UNFOLDING = 4
"""Bytes of the arrays that the importer makes for each byte of a file, a ratio: several
channels may share an array. It bounds the memory, with the next."""
UNFOLDED_BYTES = 1 << 28
"""Bytes of such arrays that a file of any size may have: those of zeros, such as of shapes of a
face, and of compressed meshes are stored in fewer."""


def refuse_inflated(path: str, content: Mapping[str, Any], n_bytes: int) -> None:
    """Raise InvalidFileError if the importer would make far more of a file than it holds.

    Parameters
    ----------
    path : str
    content : the JSON of the file
    n_bytes : of the file and of the files that it names
    """
    sizes = [_size(dict_of(each)) for each in list_of(content.get("accessors"))]
    uses = Counter(
        index
        for index in _used_accessors(content)
        if isinstance(index, int) and 0 <= index < len(sizes)
    )
    total = sum(sizes[index] * count for index, count in uses.items())
    if total > UNFOLDED_BYTES + MAX_UNFOLDING * n_bytes:
        raise InvalidFileError(
            f"{path} states {total / 1e9:.3g} GB of numbers, which it does not hold. Export it"
            " again."
        )


def _size(accessor: Mapping[str, Any]) -> int:
    count, kind = accessor.get("count"), accessor.get("type")
    width = COMPONENT_BYTES.get(_hashable(accessor.get("componentType")), 0)
    if not isinstance(count, int) or count < 0:
        return 0
    return count * width * COMPONENTS.get(_hashable(kind), 0)


def _hashable(value: Any) -> Any:
    return value if isinstance(value, int | str) else None


def _used_accessors(content: Mapping[str, Any]) -> list[Any]:
    """Return the number of an accessor each time that the importer makes an array of it."""
    found: list[Any] = []
    for animation in list_of(content.get("animations")):
        samplers = list_of(dict_of(animation).get("samplers"))
        for channel in list_of(dict_of(animation).get("channels")):
            index = dict_of(channel).get("sampler")
            if isinstance(index, int) and 0 <= index < len(samplers):
                sampler = dict_of(samplers[index])
                found += [sampler.get("input"), sampler.get("output")]
    for mesh in list_of(content.get("meshes")):
        for primitive in map(dict_of, list_of(dict_of(mesh).get("primitives"))):
            found.append(primitive.get("indices"))
            for named in (primitive.get("attributes"), *list_of(primitive.get("targets"))):
                found += dict_of(named).values()
    found += [
        dict_of(each).get("inverseBindMatrices") for each in list_of(content.get("skins"))
    ]
    return found
