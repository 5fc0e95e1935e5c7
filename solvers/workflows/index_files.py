"""Make a library of recordings in files and folders, and keep it as they are."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InvalidMotionError
from ..files import is_missing, real_path, reason_of
from ..progress import Progress, unwatched
from ..retrieval import ClipEntry, ClipLibrary, DescribedClip, Origin, open_clip_library
from ..retrieval.index import find_tags_fault
from ..version import version
from .clip_sources import ClipSource, clip_sources
from .describe_files import Described, Wanted, describe_files

BATCH = 100
"""Clips that are written together; an interrupt loses no more."""
BATCH_FRAMES = 200_000
"""Frames at 20 Hz from which on fewer are: 100 megabytes."""


@dataclass(frozen=True)
class IndexReport:
    """What came of indexing.

    Attributes
    ----------
    added, changed, unchanged, removed : tuple of str
        Names of the clips that are new, whose files or tags have changed, that were known as
        they are, and whose files have gone.
    refused : tuple of (str, str)
        Files that cannot be in a library, each with one sentence on why. What was known of
        such a file by another content is forgotten.
    n_clips : int
        In the library now, whatever they came from.
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
    jobs: int = 1,
    n_threads: int = 1,
    remove_missing: bool = False,
    progress: Progress = unwatched,
) -> IndexReport:
    """Put recordings into the library in a file, which is made where there is none.

    Files that are in it with the same size, date and tags are passed over; those that were
    refused and have not changed since are refused again without being read. A clip is called
    as its file lies in the folder that was named, without the ending; where that name is taken,
    with the ending, the folder's name or a number. It keeps its name when its file changes.
    Several processes may index into one library at once.

    Parameters
    ----------
    library_path : Path or str
    files_or_folders : sequence of Path or str
        Recordings of any known format; of folders those in them and below.
    tags : sequence of str
        That the clips get beside those they have.
    jobs : int
        Files to read at a time, each in a process of its own.
    n_threads : int
        Of linear algebra in each of these processes.
    remove_missing : bool
        Whether clips are taken out whose files were in the folders and have gone.
    progress : Progress
        What was written before it cancels stays.

    Raises
    ------
    InvalidFileError
        There is no such file or folder; the library is none, damaged, of a newer version,
        cannot be written or made, or is being written by another program all the time.
    InvalidMotionError
        A tag has control characters or is not valid UTF-8.
    SolveCancelled
        Raised by `progress`.
    """
    sources = clip_sources(files_or_folders)
    if fault := find_tags_fault(tuple(tags)):
        raise InvalidMotionError(fault)
    with open_clip_library(library_path) as library:
        indexing = _Indexing(library, tuple(dict.fromkeys(tags)))
        files = indexing.to_read(sources)
        for place, done in enumerate(describe_files(files, min(jobs, len(files)), n_threads)):
            progress(place / len(files), Path(done.wanted.origin.path).name)
            indexing.take(done)
        indexing.write()
        if remove_missing:
            indexing.remove_missing([real_path(each) for each in files_or_folders])
        progress(1.0)
        return indexing.report()


class _Indexing:
    """A library, and what has been done to it so far."""

    def __init__(self, library: ClipLibrary, tags: tuple[str, ...]) -> None:
        self._library, self._tags = library, tags
        self._known = dict(_of_files(library))
        self._sources: dict[str, ClipSource] = {}
        self._batch: list[DescribedClip] = []
        self._added, self._changed = list[str](), list[str]()
        self._unchanged, self._removed = list[str](), list[str]()
        self._refused: list[tuple[str, str]] = []
        self._known_refused = library.refused(version())
        self._of_no_use: list[tuple[Origin, str]] = []

    def to_read(self, sources: Sequence[ClipSource]) -> list[Wanted]:
        """Return what is not in the library as it is, under the names that suit it best."""
        files = []
        for source in sources:
            try:
                origin = source.origin()
            except OSError as error:
                self._refused.append((str(source.path), f"{source.path}: {reason_of(error)}."))
                continue
            if sentence := source.fault() or self._known_refused.get(origin, ""):
                self._refused.append((str(source.path), sentence))
                continue
            name, tags = next(iter(source.names())), self._tags
            if str(source.path) in self._known:
                _, known = self._known[str(source.path)]
                name, tags = known.name, tuple(dict.fromkeys(known.tags + tags))
                if known.origin == origin and known.tags == tags:
                    self._unchanged.append(name)
                    continue
            self._sources[origin.path] = source
            files.append(Wanted(name, origin, tags))
        return files

    def take(self, done: Described) -> None:
        """Keep a clip until there are enough to be written, or note why there is none."""
        wanted = done.wanted
        if done.clip is None:
            self._refused.append((wanted.origin.path, done.sentence))
            if done.for_good:
                self._of_no_use.append((wanted.origin, done.sentence))
            if wanted.origin.path in self._known:
                self._removed += self._library.discard([self._known[wanted.origin.path][0]])
            return
        self._batch.append(done.clip)
        n_frames = sum(clip.postures.n_frames for clip in self._batch)
        if len(self._batch) >= BATCH or n_frames >= BATCH_FRAMES:
            self.write()

    def write(self) -> None:
        """Write what has been kept; names are chosen while no other process can write."""
        names = self._library.add_described(self._batch, free_name=self._free_name)
        for clip, name in zip(self._batch, names, strict=True):
            known = clip.entry.origin is not None and clip.entry.origin.path in self._known
            (self._changed if known else self._added).append(name)
        if self._of_no_use:
            self._library.remember_refused(version(), self._of_no_use)
        self._batch, self._of_no_use = [], []

    def remove_missing(self, named: Sequence[Path]) -> None:
        """Take out clips whose files lay in these folders and are there no more."""
        self._removed += self._library.discard([
            number
            for path, (number, _) in self._known.items()
            if any(Path(path).is_relative_to(one) for one in named) and is_missing(path)
        ])  # fmt: skip

    def report(self) -> IndexReport:
        """Tell what has been done."""
        return IndexReport(
            tuple(self._added), tuple(self._changed), tuple(self._unchanged),
            tuple(self._removed), tuple(self._refused), len(self._library.entries),
        )  # fmt: skip

    def _free_name(self, entry: ClipEntry, taken: Collection[str]) -> str:
        assert entry.origin is not None
        names = self._sources[entry.origin.path].names()
        return next(name for name in names if name not in taken)


def _of_files(library: ClipLibrary) -> Iterator[tuple[str, tuple[int, ClipEntry]]]:
    """Yield the clips that each are all of a file, by its path, and their numbers."""
    for number, entry in library.numbered().items():
        if entry.origin is not None and not entry.origin.item:
            yield entry.origin.path, (number, entry)
