"""Collect the source files of a library and the names of their clips."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InvalidFileError
from ..files import is_missing, path_fault, real_path
from ..recordings import recordings_in
from ..recordings.containers import is_folder
from ..recordings.skeleton_files import find_skeleton
from ..retrieval import Origin
from ..retrieval.index import find_text_fault


@dataclass(frozen=True)
class ClipSource:
    """The source file of a clip.

    Attributes
    ----------
    path : Path
        Absolute.
    parts : tuple of str
        The requested folder, the folders below it, and the file's name.
    """

    path: Path
    parts: tuple[str, ...]

    def origin(self) -> Origin:
        """Return the origin with the current size and date of the file.

        They include those of the skeleton file of an .amc, so that a change of the skeleton
        counts as a change of the clip.

        Raises
        ------
        OSError
            The file has just been deleted.
        """
        found = [path.stat() for path in (self.path, *_skeletons(self.path))]
        size = sum(each.st_size for each in found)
        return Origin(str(self.path), "", size, max(each.st_mtime_ns for each in found))

    def fault(self) -> str:
        """Return why its name cannot be the name of a clip; empty if it can."""
        if fault := path_fault(self.path):
            return fault
        if fault := find_text_fault("/".join(self.parts)):
            return f"The name of {str(self.path)!r} {fault}; rename the file or its folder."
        return ""

    def names(self) -> Iterable[str]:
        """Yield candidate names for the clip, the shortest first."""
        *folders, file = self.parts
        stem = Path(file).stem
        inside = folders[1:]
        yield "/".join([*inside, stem])
        yield "/".join([*inside, file])
        yield "/".join([*folders, stem])
        yield "/".join([*folders, file])
        number = 2
        while True:
            yield "/".join([*folders, f"{file} ({number})"])
            number += 1


def _skeletons(path: Path) -> list[Path]:
    """Return the file with the skeleton of an .amc, if there is one."""
    if path.suffix.lower() != ".amc":
        return []
    try:
        return [find_skeleton(path)]
    except InvalidFileError:
        return []


def clip_sources(files_or_folders: Sequence[Path | str]) -> list[ClipSource]:
    """Return every file once, with the recordings in and below each folder.

    Raises
    ------
    InvalidFileError
        There is no such file or folder.
    """
    found: dict[Path, ClipSource] = {}
    for named in map(Path, files_or_folders):
        root = real_path(named)
        if is_missing(root):
            raise InvalidFileError(f"There is no file or folder {named}.")
        is_single = not is_folder(root)
        inside = [root] if is_single else recordings_in(root)
        for path in inside:
            below = path.relative_to(root.parent if is_single else root).parts
            parts = (root.parent.name if is_single else root.name, *below)
            found.setdefault(path, ClipSource(path, parts))
    return list(found.values())
