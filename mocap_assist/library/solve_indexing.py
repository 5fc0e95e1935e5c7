"""Solve of the button Build Library: index recordings and .blend files as clips."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ...solvers.errors import InvalidFileError, OutOfMemoryError
from ...solvers.faults import Failure, attempt
from ...solvers.files import real_path, reason_of
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings.containers import files_below
from ...solvers.retrieval import (
    Clip,
    ClipEntry,
    ClipLibrary,
    DescribedClip,
    Origin,
    describe_clip,
    open_clip_library,
)
from ...solvers.retrieval.library import refuse_other_suffix
from ...solvers.version import version
from ...solvers.workflows import index_files
from ..jobs.batches import batches_by_size
from ..jobs.in_blender import (
    BackgroundBlender,
    BlendClip,
    BlendRead,
    is_read_in_blender,
    read_blends,
)
from ..jobs.job import ProcessDied

BYTES_AT_ONCE = 100_000_000
"""Bytes of .blend files that one Blender reads; a crash loses only its own clips."""


@dataclass(frozen=True)
class Source:
    """A file or a folder that clips come from."""

    path: str
    assets_only: bool = False
    """Of .blend files, leave out actions that are not marked as assets."""


@dataclass(frozen=True)
class IndexProblem:
    """Sources to index, and the library that receives their clips."""

    library: str
    sources: tuple[Source, ...]
    tags: tuple[str, ...]
    """Given to all clips."""
    blender: BackgroundBlender


@dataclass(frozen=True)
class Indexed:
    """Result of an indexing: counts of clips, and errors."""

    n_clips: int
    """In the library now."""
    n_added: int = 0
    n_kept: int = 0
    """Clips that were indexed before, and have not changed."""
    n_removed: int = 0
    refused: tuple[str, ...] = ()
    """A sentence for each file or action that could not be read."""


@dataclass(frozen=True)
class _Blend:
    """A .blend file, and the prefix of its clips' names."""

    path: Path
    name: str
    assets_only: bool

    @cached_property
    def state(self) -> tuple[int, int]:
        """Size and date when it was first looked at; raises OSError if it has just gone."""
        found = self.path.stat()
        return found.st_size, found.st_mtime_ns


def index_sources(problem: IndexProblem, *, progress: Progress = unwatched) -> Indexed:
    """Index new and changed files; clips of other sources are kept.

    Raises
    ------
    InvalidFileError
        The library cannot be read or written, or the file of the rig is missing.
    """
    problem.blender.check_rig()
    path = Path(problem.library)
    try:
        if not path.exists():
            refuse_other_suffix(path)
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidFileError(
            f"The library {path} cannot be kept there: {reason_of(error)}."
        ) from None
    refused, files, blends = list[str](), list[str](), dict[Path, _Blend]()
    for source in problem.sources:
        found = attempt(source.path, _blends, source)
        if isinstance(found, Failure):
            refused.append(found.sentence)
            continue
        for each in found:
            blends.setdefault(each.path, each)
        files += [] if is_read_in_blender(source.path) else [source.path]
    file_fraction = len(files) / max(len(files) + len(blends), 1)
    report = index_files(
        path, files, tags=problem.tags, progress=within(progress, 0.0, file_fraction)
    )
    refused += [why for _, why in report.refused]
    with open_clip_library(path) as library:
        indexing = _ClipAdder(library, problem.tags, refused)
        blender = problem.blender
        indexing.index_blends([*blends.values()], blender, within(progress, file_fraction, 1.0))
        return Indexed(
            n_clips=len(library.entries),
            n_added=len(report.added) + len(report.changed) + indexing.added,
            n_kept=len(report.unchanged) + indexing.kept,
            n_removed=len(report.removed) + indexing.removed,
            refused=tuple(refused),
        )


def _blends(source: Source) -> list[_Blend]:
    """Return the .blend files of a source, without backups.

    Raises InvalidFileError if the source does not exist, and OSError if it is inaccessible.
    """
    try:
        Path(source.path).stat()
    except (FileNotFoundError, NotADirectoryError):
        raise InvalidFileError(f"There is no file or folder {source.path}.") from None
    top = real_path(source.path)
    return [
        _Blend(
            path,
            path.relative_to(top.parent if path == top else top).with_suffix("").as_posix(),
            source.assets_only,
        )
        for path in (files_below(top) if top.is_dir() else [top])
        if is_read_in_blender(path) and path.is_file()
    ]


class _ClipAdder:
    """Adds clips to a library, and counts them."""

    def __init__(self, library: ClipLibrary, tags: tuple[str, ...], refused: list[str]) -> None:
        self._library, self._tags, self._refused = library, tags, refused
        self.added = self.kept = self.removed = 0

    def index_blends(
        self, blends: list[_Blend], blender: BackgroundBlender, progress: Progress
    ) -> None:
        """Read the .blend files that are new or have changed, and replace their clips."""
        changed = []
        empty = {wanted: self._library.refused(_reader(wanted)) for wanted in (False, True)}
        for blend in blends:
            origin = attempt(blend.path, self._origin, blend)
            known_empty = empty[blend.assets_only]
            if not isinstance(origin, Failure) and origin in known_empty:
                sentence = known_empty[origin]
                self._refused += [sentence] * bool(sentence)
                continue
            known = attempt(blend.path, self._is_unchanged, blend)
            if isinstance(known, Failure):
                self._refused.append(known.sentence)
            elif not known:
                changed.append(blend)
        done = 0
        for batch in batches_by_size(changed, lambda blend: blend.state[0], BYTES_AT_ONCE):
            start, stop = done / len(changed), (done + len(batch)) / len(changed)
            for blend, read in self._read(batch, blender, within(progress, start, stop)):
                self._replace(blend, read)
            done += len(batch)

    def _is_unchanged(self, blend: _Blend) -> bool:
        """Whether all clips of the file are as they were, and have all the tags."""
        entries = self._entries(blend).values()
        states = {(each.origin.size, each.origin.modified) for each in entries if each.origin}
        tagged = all(set(self._tags) <= set(each.tags) for each in entries)
        known = tagged and states == {blend.state}
        self.kept += len(entries) if known else 0
        return known

    def _entries(self, blend: _Blend) -> dict[int, ClipEntry]:
        """Return the library's entries for a file, by number."""
        return {
            number: entry
            for number, entry in self._library.numbered().items()
            if entry.origin is not None and entry.origin.path == str(blend.path)
        }

    def _read(
        self, batch: list[_Blend], blender: BackgroundBlender, progress: Progress
    ) -> Iterator[tuple[_Blend, BlendRead]]:
        """Read files together; where Blender crashes, each by itself."""
        for assets_only in (False, True):
            paths = [each for each in batch if each.assets_only == assets_only]
            if not paths:
                continue
            names = [str(each.path) for each in paths]
            try:
                found = read_blends(blender, names, assets_only=assets_only, progress=progress)
            except (ProcessDied, OutOfMemoryError) as error:
                if len(paths) > 1:
                    for each in paths:
                        yield from self._read([each], blender, progress)
                    continue
                found = [BlendRead((), (_refusal(names[0], error),))]
            yield from zip(paths, found, strict=True)

    def _replace(self, blend: _Blend, read: BlendRead) -> None:
        """Replace the clips of a file by its current ones."""
        before = list(self._entries(blend))
        self._refused += read.refused
        if read.is_empty:
            sentence = " ".join(read.refused)
            self._library.remember_refused(
                _reader(blend.assets_only), [(self._origin(blend), sentence)]
            )
        described = []
        for clip in read.clips:
            found = attempt(f"{blend.path}, {clip.item}", self._describe, blend, clip)
            if isinstance(found, Failure):
                self._refused.append(found.sentence)
            else:
                described.append(found)
        self.added += len(self._library.add_described(described))
        self.removed += len(self._library.discard(before))  # but for those just replaced

    def _origin(self, blend: _Blend) -> Origin:
        return Origin(str(blend.path), "", *blend.state)

    def _describe(self, blend: _Blend, clip: BlendClip) -> DescribedClip:
        return describe_clip(self._clip(blend, clip))

    def _clip(self, blend: _Blend, clip: BlendClip) -> Clip:
        tags = tuple(dict.fromkeys([*self._tags, *clip.tags]))
        origin = Origin(str(blend.path), clip.item, *blend.state)
        return Clip(f"{blend.name}/{clip.item}", clip.motion, tags, origin)


def _reader(assets_only: bool) -> str:
    """Return the name under which a library keeps the files in which Blender found nothing."""
    return f"{version()} in Blender{', assets only' * assets_only}"


def _refusal(name: str, error: ProcessDied | OutOfMemoryError) -> str:
    if isinstance(error, OutOfMemoryError):
        return f"{name} needs more memory than is available."
    return f"Blender crashed while reading {name}: {error.cause}."
