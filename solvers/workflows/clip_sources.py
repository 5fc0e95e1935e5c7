"""Collect the source files of a library and the names of their clips."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import InvalidFileError
from ..faults import Failure, attempt
from ..files import is_missing, path_fault, real_path
from ..recordings import is_scene_file, open_bodies, recordings_in
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
    body : str
        Name of one of several bodies in the file; empty for the default.
    """

    path: Path
    parts: tuple[str, ...]
    body: str = ""

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
        return Origin(str(self.path), self.body, size, max(each.st_mtime_ns for each in found))

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
        ending = f" {self.body}" if self.body else ""
        stem, file = Path(file).stem + ending, file + ending
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


def is_action(origin: Origin) -> bool:
    """Whether a clip is an action of a file that only Blender reads."""
    path = Path(origin.path)
    return bool(origin.item) and (path.suffix.lower() == ".blend" or is_scene_file(path))


def clip_sources(
    files_or_folders: Sequence[Path | str], body: str | None = None
) -> list[ClipSource]:
    """Return every file once, with the recordings in and below each folder.

    Of a file with several bodies, each that `body` chooses (`Bodies.choose`).

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
    return [each for source in found.values() for each in _of_bodies(source, body)]


def _of_bodies(source: ClipSource, body: str | None) -> list[ClipSource]:
    """Return a source for each chosen body of its file; the reader reports what is wrong."""
    bodies = attempt(source.path, open_bodies, source.path) if body else None
    if bodies is None or isinstance(bodies, Failure) or not bodies.offered:
        return [source]
    chosen = attempt(source.path, bodies.choose, body)
    if isinstance(chosen, Failure):
        return [replace(source, body=str(body))]
    return [replace(source, body=bodies.listed[each].name) for each in chosen]
