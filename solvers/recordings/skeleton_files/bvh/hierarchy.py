"""Parse the hierarchy of a BVH file: joints, offsets and channels."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from ....errors import InvalidFileError
from ...containers import (
    MAX_NAME_LENGTH,
    UniqueNames,
    check_n_joints,
    decode_text,
    printable,
    shown,
)

CHANNELS = {f"{axis}{kind}" for axis in "xyz" for kind in ("position", "rotation")}


@dataclass(frozen=True)
class BvhJoint:
    """A joint or end site in the axes and units of the file."""

    name: str
    parent: int
    offset: tuple[float, float, float]
    channels: tuple[str, ...]
    """For example `xposition` or `zrotation`, in the order of the numbers."""


def read_hierarchies(text: bytes, path: Path | str) -> list[list[BvhJoint]]:
    """Parse the text before the word MOTION: the joints of each ROOT; names become unique.

    A second joint of the same name is called `name_2`, an end site `<parent>_end`. End sites
    at the position of their joint are dropped. Spaces in names become underscores.

    Raises
    ------
    InvalidFileError
        The text is not a BVH hierarchy, or has too many joints.
    """
    return _Hierarchy(text, path).read()


class _Hierarchy:
    """One pass over the words of the text."""

    def __init__(self, text: bytes, path: Path | str) -> None:
        self.path = path
        self.line = 1
        self.words = self._words(text)
        self.joints: list[BvhJoint] = []
        self.n_joints = 0
        self.names = UniqueNames()

    def read(self) -> list[list[BvhJoint]]:
        if self._keyword() != "HIERARCHY" or self._keyword() != "ROOT":
            self._refuse("a BVH file begins with HIERARCHY and ROOT")
        found = [self._read_root()]
        while (word := next(self.words, "").upper()) == "ROOT":
            found.append(self._read_root())
        if word:
            self._refuse(f"{shown(word)!r} is after the end")
        return found

    def _read_root(self) -> list[BvhJoint]:
        """Read the joints of a body, from the name of its root on."""
        self.joints, self.names = [], UniqueNames()
        self._open(self._name(), -1)
        branch = [0]
        while branch:
            word = self._keyword()
            if word == "JOINT":
                branch.append(self._open(self._name(), branch[-1]))
            elif word == "END":
                self._end_site(branch[-1])
            elif word == "}":
                branch.pop()
            else:
                self._refuse(f"{shown(word)!r} instead of JOINT, End Site or }}")
        return self.joints

    def _open(self, name: str, parent: int) -> int:
        offset = self._offset()
        channels: list[str] = []
        if self._keyword() != "CHANNELS":
            self._refuse(f"{shown(name)} has no CHANNELS")
        for _ in range(int(self._number())):
            channel = self._next().lower()
            if channel not in CHANNELS or channel in channels:
                self._refuse(f"{shown(name)} has a channel {shown(channel)!r}, or has it twice")
            channels.append(channel)
        self._add(BvhJoint(self.names.give(name), parent, offset, tuple(channels)))
        return len(self.joints) - 1

    def _add(self, joint: BvhJoint) -> None:
        self.joints.append(joint)
        self.n_joints += 1
        check_n_joints(self.path, self.n_joints)

    def _end_site(self, parent: int) -> None:
        self._name()
        offset = self._offset()
        word = self._keyword()
        if word == "CHANNELS" and self._number() == 0.0:  # Some exporters write CHANNELS 0.
            word = self._next()
        if word != "}":
            self._refuse("an End Site is not closed by }")
        if any(offset):
            name = self.names.give(self.joints[parent].name, "_end")
            self._add(BvhJoint(name, parent, offset, ()))

    def _offset(self) -> tuple[float, float, float]:
        if self._keyword() != "OFFSET":
            self._refuse("OFFSET is missing")
        return self._number(), self._number(), self._number()

    def _name(self) -> str:
        parts = []
        while (word := next(self.words, "{")) != "{":
            parts.append(word)
        name = printable("_".join(parts))
        if len(name) > MAX_NAME_LENGTH:
            self._refuse(f"the name {shown(name)!r} does not end")
        return name or "joint"

    def _number(self) -> float:
        word = self._next()
        try:
            value = float(word.replace(",", "."))
        except ValueError:
            value = float("nan")
        if not abs(value) < 1e9:
            self._refuse(f"{shown(word)!r} is not a plausible number")
        return value

    def _keyword(self) -> str:
        return self._next().upper()

    def _next(self) -> str:
        word = next(self.words, None)
        if word is None:
            self._refuse("the hierarchy ends too early")
        return word

    def _words(self, text: bytes) -> Iterator[str]:
        for line in decode_text(text).splitlines():
            yield from line.replace("{", " { ").replace("}", " } ").split()
            self.line += 1

    def _refuse(self, problem: str) -> NoReturn:
        raise InvalidFileError(
            f"{self.path}, line {self.line}: {problem}. The file is damaged or not BVH; export"
            " it again."
        )
