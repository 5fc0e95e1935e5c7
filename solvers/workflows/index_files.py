"""Build a library from files and folders of recordings, and keep it up to date."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import InvalidMotionError
from ..files import is_missing, real_path, reason_of
from ..processes import LocalWorkers, Workers
from ..progress import Progress, unwatched, within
from ..retrieval import (
    ClipEntry,
    ClipLibrary,
    DescribedClip,
    Origin,
    load_clip_library,
    open_clip_library,
)
from ..retrieval.index import Vocabulary, find_tags_fault
from ..version import version
from .clip_sources import ClipSource, clip_sources, is_action
from .describe_files import ClipRequest, FileDescription, describe_files

MAX_BATCH_CLIPS = 100
"""Clips written in one transaction. It bounds the loss at an interrupt:
`test_interrupt_loses_at_most_one_batch`."""
MAX_BATCH_FRAMES = 200_000
"""Frames at 20 Hz written in one transaction. It bounds the memory, to 100 megabytes."""


@dataclass(frozen=True)
class IndexReport:
    """The result of indexing.

    Attributes
    ----------
    added, changed, unchanged, removed : tuple of str
        Names of clips: new ones, those with changed files or tags, those already up to date,
        and those whose files are gone.
    refused : tuple of (str, str)
        Files that cannot be indexed, each with one sentence on why. An earlier clip of such a
        file is removed.
    n_clips : int
        Number of clips in the library now, from all sources.
    """

    added: tuple[str, ...]
    changed: tuple[str, ...]
    unchanged: tuple[str, ...]
    removed: tuple[str, ...]
    refused: tuple[tuple[str, str], ...]
    n_clips: int


def index_files(
    library_path: Path | str,
    files_or_folders: Sequence[Path | str],
    *,
    tags: Sequence[str] = (),
    body: str | None = None,
    jobs: int = 1,
    n_threads: int = 1,
    workers: Workers | None = None,
    vocabulary_of: Path | str | None = None,
    remove_missing: bool = False,
    progress: Progress = unwatched,
) -> IndexReport:
    """Add recordings to a library file, which is created if it is missing.

    Files with unchanged size, date and tags are skipped. Files that were refused and have not
    changed since are refused again without being read. The name of a clip is the path of its
    file within the given folder, without the extension. If that name is taken, it gets the
    extension, the name of the folder or a number. A clip keeps its name when its file changes.
    Several processes may index into one library at once.

    Parameters
    ----------
    library_path : Path or str
    files_or_folders : sequence of Path or str
        Recordings of any known format, or folders that are searched recursively.
    tags : sequence of str
        Tags to add to those that the clips have.
    body : str, optional
        Bodies of files with several, each a clip (`Bodies.choose`); by default the one in most
        frames.
    jobs : int
        Number of files to read in parallel, each in a process of its own.
    n_threads : int
        Threads of linear algebra in each of these processes.
    workers : Workers, optional
        Processes that read the files instead, such as those of a cluster. The library is the
        same, byte for byte: this process alone writes it, in the order of the files.
    vocabulary_of : Path or str, optional
        A library whose vocabulary this library has from now on, so that they can be searched
        together. Clips that it has are indexed again with it.
    remove_missing : bool
        Whether to remove clips whose files were in the folders and are gone.
    progress : Progress
        Clips written before a cancellation stay.

    Raises
    ------
    InvalidFileError
        There is no such file or folder. The library is not a library, is damaged, comes from a
        newer version, cannot be written or created, or stays locked by another program.
    InvalidMotionError
        A tag has control characters or is not valid UTF-8. The other library has no clips.
    SolveCancelled
        Raised by `progress`.
    """
    sources = clip_sources(files_or_folders, body)
    if fault := find_tags_fault(tuple(tags)):
        raise InvalidMotionError(fault)
    vocabulary = None if vocabulary_of is None else _vocabulary(vocabulary_of)
    with open_clip_library(library_path) as library:
        if vocabulary is not None:
            library.freeze_vocabulary(vocabulary, progress=within(progress, 0.0, 0.0))
        indexing = _Indexing(library, tuple(dict.fromkeys(tags)))
        files = indexing.to_read(sources)
        if workers is None and min(jobs, len(files)) > 1:
            workers = LocalWorkers(jobs, n_threads)
        for index, description in enumerate(describe_files(files, workers)):
            progress(index / len(files), Path(description.request.origin.path).name)
            indexing.take(description)
        indexing.write()
        if remove_missing:
            indexing.remove_missing([real_path(each) for each in files_or_folders])
        progress(1.0)
        return indexing.report()


def _vocabulary(library_path: Path | str) -> Vocabulary:
    with load_clip_library(library_path) as library:
        if library.vocabulary is None:
            raise InvalidMotionError(
                f"The library {library_path} has no clips, and so no vocabulary. Index clips of"
                " many kinds of motion into it first."
            )
        return library.vocabulary


Key = tuple[str, str]
"""Path of a file, and body there."""


class _Indexing:
    """An indexing run: the library and the changes so far."""

    def __init__(self, library: ClipLibrary, tags: tuple[str, ...]) -> None:
        self._library, self._tags = library, tags
        self._indexed = dict(_clips_by_key(library))
        self._sources: dict[Key, ClipSource] = {}
        self._batch: list[DescribedClip] = []
        self._added, self._changed = list[str](), list[str]()
        self._unchanged, self._removed = list[str](), list[str]()
        self._refused: list[tuple[str, str]] = []
        self._known_refused = library.refused(version())
        self._new_refusals: list[tuple[Origin, str]] = []

    def to_read(self, sources: Sequence[ClipSource]) -> list[ClipRequest]:
        """Return the files that are new or changed, with their preferred clip names."""
        files = []
        for source in self._as_indexed(sources):
            try:
                origin = source.origin()
            except OSError as error:
                self._refused.append((str(source.path), f"{source.path}: {reason_of(error)}."))
                continue
            if sentence := source.fault() or self._known_refused.get(origin, ""):
                self._refused.append((str(source.path), sentence))
                continue
            name, tags = next(iter(source.names())), self._tags
            if _key(origin) in self._indexed:
                _, known = self._indexed[_key(origin)]
                name, tags = known.name, tuple(dict.fromkeys(known.tags + tags))
                if known.origin == origin and known.tags == tags:
                    self._unchanged.append(name)
                    continue
            self._sources[_key(origin)] = source
            files.append(ClipRequest(name, origin, tags))
        return files

    def _as_indexed(self, sources: Sequence[ClipSource]) -> Iterator[ClipSource]:
        """Yield sources; of files whose bodies were indexed one by one, each of these again.

        Clips of named bodies replace a clip of the default body.
        """
        bodies: dict[str, list[str]] = {}
        for path, body in self._indexed:
            bodies.setdefault(path, []).append(body)
        for source in sources:
            known = [body for body in bodies.get(str(source.path), []) if body]
            if source.body and (str(source.path), "") in self._indexed:
                number, _ = self._indexed.pop((str(source.path), ""))
                self._removed += self._library.discard([number])
            yield from (
                [replace(source, body=body) for body in known]
                if known and not source.body
                else [source]
            )

    def take(self, description: FileDescription) -> None:
        """Add a clip to the batch, or record why there is none."""
        request = description.request
        if description.clip is None:
            self._refused.append((request.origin.path, description.sentence))
            if description.is_permanent:
                self._new_refusals.append((request.origin, description.sentence))
            if _key(request.origin) in self._indexed:
                self._removed += self._library.discard([self._indexed[_key(request.origin)][0]])
            return
        self._batch.append(description.clip)
        n_frames = sum(clip.postures.n_frames for clip in self._batch)
        if len(self._batch) >= MAX_BATCH_CLIPS or n_frames >= MAX_BATCH_FRAMES:
            self.write()

    def write(self) -> None:
        """Write the batch; names are chosen while no other process can write."""
        names = self._library.add_described(self._batch, free_name=self._free_name)
        for clip, name in zip(self._batch, names, strict=True):
            origin = clip.entry.origin
            known = origin is not None and _key(origin) in self._indexed
            (self._changed if known else self._added).append(name)
        if self._new_refusals:
            self._library.remember_refused(version(), self._new_refusals)
        self._batch, self._new_refusals = [], []

    def remove_missing(self, folders: Sequence[Path]) -> None:
        """Remove clips whose files were in these folders and are gone."""
        self._removed += self._library.discard([
            number
            for (path, _), (number, _) in self._indexed.items()
            if any(Path(path).is_relative_to(one) for one in folders) and is_missing(path)
        ])  # fmt: skip

    def report(self) -> IndexReport:
        """Return the result so far."""
        return IndexReport(
            tuple(self._added), tuple(self._changed), tuple(self._unchanged),
            tuple(self._removed), tuple(self._refused), len(self._library.entries),
        )  # fmt: skip

    def _free_name(self, entry: ClipEntry, taken: Collection[str]) -> str:
        assert entry.origin is not None
        names = self._sources[_key(entry.origin)].names()
        return next(name for name in names if name not in taken)


def _key(origin: Origin) -> Key:
    return origin.path, origin.item


def _clips_by_key(library: ClipLibrary) -> Iterator[tuple[Key, tuple[int, ClipEntry]]]:
    """Yield path and body, number and entry of each clip of a file that is read here."""
    for number, entry in library.numbered().items():
        if entry.origin is not None and not is_action(entry.origin):
            yield _key(entry.origin), (number, entry)
