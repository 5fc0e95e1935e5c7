"""Which files make up a library, and what each clip is called in it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InvalidFileError
from ..files import is_missing, real_path
from ..recordings import recordings_in
from ..recordings.containers import is_folder
from ..recordings.skeleton_files import find_skeleton
from ..retrieval import Origin
from ..retrieval.index import find_text_fault, is_utf_8


@dataclass(frozen=True)
class ClipSource:
    """A file that a clip is read from.

    Attributes
    ----------
    path : Path
        Absolute.
    place : tuple of str
        Folders within the one that was named, and the file's name; before them the folder
        that was named.
    """

    path: Path
    place: tuple[str, ...]

    def origin(self) -> Origin:
        """Return the origin with the file's size and date as they are now.

        Those of the skeleton beside it count, where it needs one: a clip has changed when
        that has.

        Raises
        ------
        OSError
            The file has just gone.
        """
        found = [path.stat() for path in (self.path, *_skeletons(self.path))]
        size = sum(each.st_size for each in found)
        return Origin(str(self.path), "", size, max(each.st_mtime_ns for each in found))

    def fault(self) -> str:
        """Return a sentence on why its names cannot be those of a clip, or nothing."""
        if fault := path_fault(self.path):
            return fault
        if fault := find_text_fault("/".join(self.place)):
            return f"The name of {str(self.path)!r} {fault}; rename the file or its folder."
        return ""

    def names(self) -> Iterable[str]:
        """Yield names for the clip, the plainest first, until one is free."""
        *folders, file = self.place
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


def path_fault(path: Path | str) -> str:
    """Return a sentence on why a library cannot keep a path, or nothing."""
    if is_utf_8(str(path)):
        return ""
    return f"{str(path)!r} is not valid UTF-8; rename the file or its folder."


def _skeletons(path: Path) -> list[Path]:
    """Return the file with the skeleton of an .amc, if there is one."""
    if path.suffix.lower() != ".amc":
        return []
    try:
        return [find_skeleton(path)]
    except InvalidFileError:
        return []


def clip_sources(files_or_folders: Sequence[Path | str]) -> list[ClipSource]:
    """Return every file, and in place of a folder the recordings in it and below, each once.

    Raises
    ------
    InvalidFileError
        There is no such file or folder.
    """
    found: dict[Path, ClipSource] = {}
    for named in map(Path, files_or_folders):
        whole = real_path(named)
        if is_missing(whole):
            raise InvalidFileError(f"There is no file or folder {named}.")
        is_one = not is_folder(whole)
        inside = [whole] if is_one else recordings_in(whole)
        for path in inside:
            below = path.relative_to(whole.parent if is_one else whole).parts
            place = (whole.parent.name if is_one else whole.name, *below)
            found.setdefault(path, ClipSource(path, place))
    return list(found.values())
