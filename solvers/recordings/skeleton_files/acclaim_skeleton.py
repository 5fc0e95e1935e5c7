"""Read Acclaim skeletons (ASF): bones, hierarchy and units."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...rotations import quaternion_from_euler
from ..containers import check_n_joints, read_bytes, shown

INCH = 0.0254
ROOT = "root"
CHANNELS = {f"{kind}{axis}" for kind in "rt" for axis in "xyz"} | {"l"}


@dataclass(frozen=True, eq=False)
class AcclaimBone:
    """A bone in the axes of the file, Y up."""

    name: str
    vector: NDArray[np.float64]
    """From start to end in the rest pose, shape (3,), in units of the file."""
    frame: NDArray[np.float64]
    """Rotation axes of the bone, as a quaternion w x y z, shape (4,)."""
    order: str
    """Axes of the first, second and third rotation."""
    channels: tuple[str, ...]
    """Channels in the AMC file, such as `rx`, `rz`."""


@dataclass(frozen=True, eq=False)
class AcclaimSkeleton:
    """Bones, parents before children; the root is the first."""

    bones: tuple[AcclaimBone, ...]
    parents: tuple[int, ...]
    position: NDArray[np.float64]
    """Rest position of the root, shape (3,)."""
    angle_unit: float
    """Radians per unit of an angle."""
    stated_unit: float | None
    """Meters per unit of a length; None if the factor of the file is not positive."""


def read_acclaim_skeleton(path: Path | str) -> AcclaimSkeleton:
    """Read an ASF file.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, has too many bones, or is not an Acclaim skeleton.
    """
    return _SkeletonFile(path).skeleton()


class _SkeletonFile:
    """The lines of an ASF file by section, and their interpretation."""

    def __init__(self, path: Path | str) -> None:
        self.path = path
        self.line = 0
        self.sections: dict[str, list[tuple[int, list[str]]]] = {}
        heading: list[tuple[int, list[str]]] = []
        for number, line in enumerate(read_bytes(path).splitlines(), start=1):
            words = line.split(b"#")[0].decode("utf-8", "replace").split()
            if words and words[0].startswith(":"):
                heading = self.sections.setdefault(words[0].lower(), [])
            elif words:
                heading.append((number, words))
        for name in (":root", ":bonedata", ":hierarchy"):
            if name not in self.sections:
                raise InvalidFileError(
                    f"{path} is not an Acclaim skeleton: it has no {name} section."
                )

    def skeleton(self) -> AcclaimSkeleton:
        n_bones = sum(words[0].lower() == "end" for words in self._lines(":bonedata"))
        check_n_joints(self.path, n_bones)
        units = {words[0].lower(): words[1:] for words in self._lines(":units")}
        in_degrees = units.get("angle", ["deg"])[:1] != ["rad"]
        angle_unit = np.pi / 180.0 if in_degrees else 1.0
        described = {words[0].lower(): words[1:] for words in self._lines(":root")}
        position = self._vector(described.get("position", ["0", "0", "0"]))
        root = self._bone(ROOT, {**_as_bone(described), "direction": ["0"] * 3}, angle_unit)
        bones = {ROOT: root}
        for entries in self._entries():
            name = " ".join(entries.get("name", []))
            if not name or name in bones:
                self._refuse(f"a bone has no name or a duplicate name ({shown(name)!r})")
            bones[name] = self._bone(name, entries, angle_unit)
        ordered, parents = self._hierarchy(bones)
        unit = self._stated_unit(units)
        return AcclaimSkeleton(tuple(ordered), tuple(parents), position, angle_unit, unit)

    def _entries(self) -> Iterator[dict[str, list[str]]]:
        """Yield the lines between `begin` and `end` of each bone, by their first word."""
        entries: dict[str, list[str]] = {}
        for words in self._lines(":bonedata"):
            keyword = words[0].lower()
            if keyword == "begin":
                entries = {}
            elif keyword == "end":
                yield entries
            else:
                entries[keyword] = words[1:]

    def _bone(
        self, name: str, entries: Mapping[str, list[str]], angle_unit: float
    ) -> AcclaimBone:
        direction = self._vector(entries.get("direction", []))
        length = self._numbers(entries.get("length", ["0"]), 1)[0]
        axis = entries.get("axis", ["0", "0", "0"])
        order = axis[3].upper() if len(axis) > 3 else "XYZ"
        if sorted(order) != ["X", "Y", "Z"]:
            self._refuse(f"{shown(name)} rotates about the axes {shown(order)!r}")
        angles = dict(zip("XYZ", self._vector(axis[:3]) * angle_unit, strict=True))
        applied_last_first = order[::-1]
        frame = quaternion_from_euler(
            [angles[letter] for letter in applied_last_first], applied_last_first
        )
        channels = tuple(word.lower() for word in entries.get("dof", []))
        if not set(channels) <= CHANNELS or len(set(channels)) != len(channels):
            self._refuse(
                f"{shown(name)} has the degrees of freedom {shown(' '.join(channels))!r}"
            )
        return AcclaimBone(name, direction * length, frame, order, channels)

    def _hierarchy(
        self, bones: Mapping[str, AcclaimBone]
    ) -> tuple[list[AcclaimBone], list[int]]:
        below: dict[str, list[str]] = {}
        for name, *children in self._lines(":hierarchy"):
            if name not in {"begin", "end"}:
                below.setdefault(name, []).extend(children)
        ordered, parents, waiting = [], [], [(ROOT, -1)]
        visited = {ROOT}
        while waiting:
            name, parent = waiting.pop()
            if name not in bones:
                self._refuse(
                    f"the hierarchy names a bone {shown(name)!r} that is not described"
                )
            ordered.append(bones[name])
            parents.append(parent)
            children = below.get(name, [])
            if visited & set(children):
                self._refuse(f"a bone below {shown(name)} is in the hierarchy twice")
            visited |= set(children)
            waiting.extend((child, len(ordered) - 1) for child in reversed(children))
        return ordered, parents

    def _stated_unit(self, units: Mapping[str, list[str]]) -> float | None:
        """Return meters per unit: inches divided by the file's factor, if that is possible."""
        factor = self._numbers(units.get("length", ["1"]), 1)[0]
        return INCH / factor if factor > 0.0 else None

    def _lines(self, section: str) -> Iterator[list[str]]:
        for number, words in self.sections.get(section, []):
            self.line = number
            yield words

    def _vector(self, words: list[str]) -> NDArray[np.float64]:
        return np.array(self._numbers(words, 3))

    def _numbers(self, words: list[str], count: int) -> list[float]:
        try:
            values = [float(word) for word in words[:count]]
        except ValueError:
            values = []
        if len(values) != count or not all(abs(value) < 1e9 for value in values):
            self._refuse(f"{count} numbers are required instead of {shown(' '.join(words))!r}")
        return values

    def _refuse(self, what: str) -> NoReturn:
        raise InvalidFileError(
            f"{self.path}, near line {self.line}: {what}. The skeleton file is damaged; use"
            " another copy."
        )


def _as_bone(root: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Return the root's description with the keywords of bones."""
    orientation = root.get("orientation", ["0", "0", "0"])
    return {"axis": orientation[:3] + root.get("axis", ["XYZ"]), "dof": root.get("order", [])}
