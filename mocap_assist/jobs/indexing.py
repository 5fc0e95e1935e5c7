"""What the button Index has done for it: files and .blend files become clips of a library."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ...solvers.errors import InvalidMotionError
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings import recordings_in
from ...solvers.retrieval import (
    Clip,
    ClipLibrary,
    Origin,
    build_clip_library,
    load_clip_library,
)
from .in_blender import BlendClip, BlendRead, read_blends
from .job import ProcessDied

BLEND = ".blend"
BYTES_AT_ONCE = 100_000_000
"""Of .blend files that one Blender reads: what it has read is kept if the next one crashes."""


@dataclass(frozen=True)
class Place:
    """A file or a folder that clips come from."""

    path: str
    assets_only: bool = False
    """Of .blend files, leave out actions that are not marked as assets."""


@dataclass(frozen=True)
class IndexProblem:
    """What is to be indexed."""

    library: str
    places: tuple[Place, ...]
    tags: tuple[str, ...]
    """Given to all clips."""
    blender: str
    """Path of the program; empty where Blender is a module of Python."""


@dataclass(frozen=True)
class Indexed:
    """What became of it."""

    n_clips: int
    """In the library now."""
    n_added: int = 0
    n_kept: int = 0
    """That were indexed before, and have not changed."""
    n_removed: int = 0
    refused: tuple[str, ...] = ()
    """A sentence for each file or action that could not be read."""


@dataclass(frozen=True)
class _Blend:
    """A .blend file, and by which name its clips begin."""

    path: Path
    name: str
    assets_only: bool

    @property
    def state(self) -> tuple[int, int]:
        found = self.path.stat()
        return found.st_size, found.st_mtime_ns


def index_places(problem: IndexProblem, *, progress: Progress = unwatched) -> Indexed:
    """Index what is new or has changed since; clips of other places stay.

    Raises
    ------
    InvalidFileError
        The library cannot be read or written.
    """
    path = Path(problem.library)
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists():
        build_clip_library(()).save(path)
    refused = [
        f"{place.path} is missing." for place in problem.places if not Path(place.path).exists()
    ]
    blends = list(_blends(problem.places))
    share = 0.5 if blends else 1.0
    with load_clip_library(path) as library:
        counts = _Counts(library, problem.tags, refused)
        counts.index_blends(blends, problem.blender, within(progress, 1.0 - share, 1.0))
        return Indexed(
            len(library.entries), counts.added, counts.kept, counts.removed, tuple(refused)
        )


def _blends(places: tuple[Place, ...]) -> Iterator[_Blend]:
    """Yield the .blend files in these places, each once; not the backups beside them."""
    seen = set()
    for place in places:
        top = Path(place.path)
        inside = sorted(top.rglob(f"*{BLEND}")) if top.is_dir() else [top]
        for path in inside:
            hidden = any(part.startswith(".") for part in path.relative_to(top).parts)
            if path.suffix != BLEND or hidden or path in seen or not path.is_file():
                continue
            seen.add(path)
            below = path.relative_to(top.parent if path == top else top)
            yield _Blend(path, below.with_suffix("").as_posix(), place.assets_only)


class _Counts:
    """Adds clips to a library, and counts them."""

    def __init__(self, library: ClipLibrary, tags: tuple[str, ...], refused: list[str]) -> None:
        self._library, self._tags, self._refused = library, tags, refused
        self.added = self.kept = self.removed = 0

    def index_blends(self, blends: list[_Blend], blender: str, progress: Progress) -> None:
        """Read the .blend files that are new or have changed, and replace their clips."""
        changed = [blend for blend in blends if not self._known(blend)]
        done = 0
        for batch in _batches(changed):
            start, stop = done / len(changed), (done + len(batch)) / len(changed)
            for blend, read in self._read(batch, blender, within(progress, start, stop)):
                self._replace(blend, read)
            done += len(batch)

    def _known(self, blend: _Blend) -> bool:
        """Whether all clips of the file are as they were."""
        states = {
            (entry.origin.size, entry.origin.modified)
            for entry in self._library.entries
            if entry.origin is not None and entry.origin.path == str(blend.path)
        }
        known = states == {blend.state}
        self.kept += known * len(self._names(blend))
        return known

    def _names(self, blend: _Blend) -> list[str]:
        return [
            entry.name
            for entry in self._library.entries
            if entry.origin is not None and entry.origin.path == str(blend.path)
        ]

    def _read(
        self, batch: list[_Blend], blender: str, progress: Progress
    ) -> Iterator[tuple[_Blend, BlendRead]]:
        """Read files together; where Blender crashes, each by itself."""
        for assets_only in (False, True):
            paths = [each for each in batch if each.assets_only == assets_only]
            if not paths:
                continue
            names = [str(each.path) for each in paths]
            try:
                found = read_blends(blender, names, assets_only=assets_only, progress=progress)
            except ProcessDied as error:
                if len(paths) > 1:
                    for each in paths:
                        yield from self._read([each], blender, progress)
                    continue
                found = [BlendRead((), (f"{names[0]} made Blender end, {error.cause}.",))]
            yield from zip(paths, found, strict=True)

    def _replace(self, blend: _Blend, read: BlendRead) -> None:
        """Put what a file holds now in the place of what it held."""
        before = self._names(blend)
        others = {entry.name for entry in self._library.entries} - set(before)
        clips = [self._clip(blend, clip, others) for clip in read.clips]
        self._refused += read.refused
        added = self._add(clips)
        gone = [name for name in before if name not in added]
        self._library.remove(gone)
        self.added += len(added)
        self.removed += len(gone)

    def _clip(self, blend: _Blend, clip: BlendClip, others: set[str]) -> Clip:
        name = plain = f"{blend.name}/{clip.item}"
        number = 1
        while name in others:  # in another folder there is one that is called the same
            number += 1
            name = f"{plain} ({number})"
        tags = tuple(dict.fromkeys([*self._tags, *clip.tags]))
        return Clip(name, clip.motion, tags, Origin(str(blend.path), clip.item, *blend.state))

    def _add(self, clips: list[Clip]) -> set[str]:
        """Add all at once, or each by itself where one shows no body."""
        try:
            self._library.add(clips)
            return {clip.name for clip in clips}
        except InvalidMotionError as error:
            if len(clips) > 1:
                return {name for clip in clips for name in self._add([clip])}
            self._refused.append(str(error))
            return set()


def _batches(blends: list[_Blend]) -> Iterator[list[_Blend]]:
    batch: list[_Blend] = []
    room = BYTES_AT_ONCE
    for blend in blends:
        size = blend.state[0]
        if batch and size > room:
            yield batch
            batch, room = [], BYTES_AT_ONCE
        batch.append(blend)
        room -= size
    if batch:
        yield batch


def holds_recordings(path: Path) -> bool:
    """Whether a place holds recordings, besides .blend files."""
    if path.is_dir():
        return next(iter(recordings_in(path)), None) is not None
    return path.is_file() and path.suffix != BLEND
