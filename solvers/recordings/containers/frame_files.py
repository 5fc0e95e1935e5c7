"""Find takes that are stored as one file for each frame."""

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

NUMBER = re.compile(r"\d+")
MAX_GAP_FRAMES = 1000
"""Missing numbers in a row, frames, up to which they are frames without a file. It bounds the
memory: after more of them, the take goes on with the next file."""

NamesByNumber = dict[tuple[str, str], dict[int, list[str]]]
"""Names of files by their start and end around a number, and by that number: `take_1` and
`take_01` have the same."""


class FrameFiles(NamedTuple):
    """Files in one folder whose names differ in one number."""

    head: str
    """Start of their names, before the number."""
    tail: str
    files: dict[int, Path]
    """By number, in order."""

    def frames(self) -> list[Path | None]:
        """Return the file of each frame; None for numbers between them without a file."""
        numbers = list(self.files)
        step = min((after - before for before, after in pairwise(numbers)), default=1)
        found: list[Path | None] = [self.files[numbers[0]]]
        for before, after in pairwise(numbers):
            n_missing = (after - before) // step - 1
            found += [None] * (n_missing if n_missing <= MAX_GAP_FRAMES else 0)
            found.append(self.files[after])
        return found


def frame_files(path: Path | str, named: NamesByNumber | None = None) -> FrameFiles:
    """Return the files that are called like one of them but for a number, in its folder.

    Of several numbers in a name, it is the one with the most files.

    Parameters
    ----------
    path : Path or str
    named : NamesByNumber, optional
        Names to search instead of the folder's (`names_by_number`).
    """
    path = Path(path)
    if named is None:
        named = names_by_number(each.name for each in path.parent.iterdir())
    found = [FrameFiles(path.stem, path.suffix, {0: path})]
    for head, tail, _ in _numbers_of(path.name):
        names = sorted(named.get((head, tail), {}).items())
        files = {number: path.with_name(_written_as(path.name, same)) for number, same in names}
        found.append(FrameFiles(head, tail, files))
    return max(found, key=lambda each: len(each.files))


def names_by_number(names: Iterable[str]) -> NamesByNumber:
    """Return the names with each start and end around a number, by that number."""
    found: NamesByNumber = {}
    for name in names:
        for head, tail, number in _numbers_of(name):
            found.setdefault((head, tail), {}).setdefault(number, []).append(name)
    return found


def _written_as(name: str, names: list[str]) -> str:
    """Return that of some names with one number that has as many zeros before it as a name.

    These are other frames than those without, or with more of them.
    """
    has_zeros = [len(each) == len(name) for each in names]
    return name if name in names else names[has_zeros.index(True) if any(has_zeros) else 0]


def _numbers_of(name: str) -> Iterator[tuple[str, str, int]]:
    """Yield each number in a name, after its start and end around it."""
    for run in NUMBER.finditer(name):
        yield name[: run.start()], name[run.end() :], int(run[0])


def describe_frame_files(n_frames: int) -> str:
    """Return a message without a period on a take that was read from a file per frame."""
    return f"{n_frames} files in the folder, with a frame each, are read as one take"
