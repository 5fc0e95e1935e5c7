"""A library of clips that can be searched, grows and shrinks, in memory or in a file."""

import sqlite3
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self
from weakref import finalize

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...files import write_atomically
from ...progress import Progress, unwatched, within
from ..index import (
    RATE,
    Clip,
    ClipEntry,
    DescribedClip,
    IndexBlock,
    Origin,
    SearchIndex,
    Vocabulary,
    block_of,
    describe_all_spans,
    describe_clip,
    learn_vocabulary,
    merged,
)
from ..postures import ClipPostures
from . import clip_rows as rows
from . import library_file as files
from .database_errors import readable_errors
from .refused_files import read_refused, write_refused

LARGEST_BLOCK = 50_000
"""Spans from which on blocks are not put together: SQLite stores no more than about four times
as many in one row, and a merge would need much memory."""


class ClipLibrary:
    """Clips and the index that finds them. Made by the verbs of `open_library`.

    One that was loaded from a file is that file: what is added or removed is written at once,
    as a whole or not at all, and others who have it open see it with their next search.
    """

    def __init__(self, database: sqlite3.Connection, path: Path | None = None) -> None:
        """Wrap an open database; for the two makers only."""
        self._database = database
        finalize(self, database.close)  # one that nobody closed lets go of its file, too
        self._path = path
        self._seen = (-1, -1)
        self._entries: dict[int, ClipEntry] = {}
        self._blocks: dict[int, IndexBlock] = {}
        self._numbers: dict[str, int] | None = None
        self._alive: tuple[tuple[IndexBlock, NDArray[np.bool_]], ...] | None = None
        self._index_of_all: SearchIndex | None = None
        self._words = -1
        self._vocabulary: Vocabulary | None = None

    @property
    def path(self) -> Path | None:
        """The file it lives in; None in memory."""
        return self._path

    @property
    def entries(self) -> tuple[ClipEntry, ...]:
        """What is told of the clips, in the order in which they came."""
        return tuple(self.numbered().values())

    @property
    def vocabulary(self) -> Vocabulary | None:
        """What the index is told in; None while the library is empty."""
        self._refresh()
        return self._vocabulary

    @property
    def blocks(self) -> tuple[tuple[IndexBlock, NDArray[np.bool_]], ...]:
        """The index, and which spans of each block are of clips that are still there."""
        self._refresh()
        if self._alive is None:
            numbers = np.array(list(self._entries))
            self._alive = tuple(
                (block, np.isin(block.clips, numbers)) for block in self._blocks.values()
            )
        return self._alive

    @property
    def search_index(self) -> SearchIndex:
        """The index as a whole; kept until the library changes."""
        blocks = self.blocks
        if self._index_of_all is None:
            self._index_of_all = SearchIndex(blocks)
        return self._index_of_all

    def numbers_of(self, names: Iterable[str]) -> list[int]:
        """Return the numbers of clips by their names; other names are passed over."""
        entries = self.numbered()
        if self._numbers is None:
            self._numbers = {entry.name: number for number, entry in entries.items()}
        return [self._numbers[name] for name in names if name in self._numbers]

    def numbered(self) -> dict[int, ClipEntry]:
        """Return what is told of the clips, by the numbers that the index calls them by."""
        self._refresh()
        return self._entries

    def postures(self, number: int, n_frames: int = 0) -> ClipPostures:
        """Return the postures of a clip at 20 Hz, as they were indexed; at least so many."""
        with readable_errors(self._path):
            return rows.read_postures(self._database, number, n_frames)

    def add(self, clips: Iterable[Clip], *, progress: Progress = unwatched) -> None:
        """Add clips, in place of those of the same origin or, without one, the same name.

        Raises
        ------
        InvalidMotionError
            A clip shows no body, or two without an origin have one name; the library is as it
            was.
        SolveCancelled
            Raised by `progress`; the library is as it was.
        """
        clips = list(clips)
        described = []
        for place, clip in enumerate(clips):
            progress(0.5 * place / len(clips), clip.name)
            described.append(describe_clip(clip))
        self.add_described(described, progress=within(progress, 0.5, 1.0))

    def add_described(
        self,
        clips: Sequence[DescribedClip],
        *,
        free_name: rows.FreeName = rows.numbered_name,
        progress: Progress = unwatched,
    ) -> tuple[str, ...]:
        """Add clips that `describe_clip` has described, here or in another process.

        A clip with an origin replaces the one of that origin, and keeps its name; where the
        name of a new one is taken, `free_name` chooses another while nobody else can write.

        Returns
        -------
        tuple of str
            The names that the clips have in the library.

        Raises
        ------
        InvalidMotionError
            Two clips without an origin have one name; the library is as it was.
        SolveCancelled
            Raised by `progress`; the library is as it was.
        """
        names = Counter(clip.entry.name for clip in clips if clip.entry.origin is None)
        if doubled := [name for name, count in names.items() if count > 1]:
            raise InvalidMotionError(f"Two clips are called {min(doubled)}.")
        if not clips:
            return ()
        postures = [clip.postures for clip in clips]
        with readable_errors(self._path), files.transaction(self._database):
            self._refresh()
            written = rows.write_clips(self._database, clips, free_name)
            if self._needs_new_words(sum(clip.n_frames for clip in postures)):
                self._index_all(progress)
            else:
                self._index(list(written), postures, progress)
            progress(1.0)
        return tuple(written.values())

    def remove(self, names: Sequence[str]) -> None:
        """Take clips out.

        Raises
        ------
        InvalidMotionError
            There is no clip of a name; the library is as it was.
        """
        with readable_errors(self._path), files.transaction(self._database):
            for name in names:
                if not self._database.execute(
                    "DELETE FROM clips WHERE name = ?", (name,)
                ).rowcount:
                    raise InvalidMotionError(f"The library has no clip {name}.")

    def discard(self, numbers: Iterable[int]) -> tuple[str, ...]:
        """Take out the clips of these numbers that are still there; return their names."""
        with readable_errors(self._path), files.transaction(self._database):
            return tuple(rows.remove_clips(self._database, numbers))

    def refused(self, reader: str) -> dict[Origin, str]:
        """Return files that this version of a reader could not use, and why."""
        with readable_errors(self._path):
            return read_refused(self._database, reader)

    def remember_refused(self, reader: str, refused: Sequence[tuple[Origin, str]]) -> None:
        """Note files that are of no use as they are, and why."""
        with readable_errors(self._path), files.transaction(self._database):
            write_refused(self._database, reader, refused)

    def save(self, path: Path | str) -> None:
        """Write the library into a file, atomically.

        Raises
        ------
        InvalidFileError
            The folder is missing or may not be written to.
        """
        with write_atomically(path) as part, readable_errors(Path(path)):
            copy = sqlite3.connect(part)
            try:
                self._database.backup(copy)
            finally:
                copy.close()

    def close(self) -> None:
        """Let go of the file."""
        self._database.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close."""
        self.close()

    def _refresh(self) -> None:
        """See what others have written, and what was written here."""
        with readable_errors(self._path), files.one_state(self._database):
            version = self._database.execute("PRAGMA data_version").fetchone()[0]
            seen = (version, self._database.total_changes)
            if seen == self._seen:
                return
            words = files.vocabulary_number(self._database)
            if words != self._words:
                self._blocks = {}
                self._vocabulary = files.read_vocabulary(self._database)
                self._words = words
            self._entries = rows.read_entries(self._database, self._entries)
            numbers = files.block_numbers(self._database)
            if self._entries and not numbers:
                raise sqlite3.DatabaseError("the index is missing")
            known, n_words = self._blocks, 0
            if self._vocabulary is not None:
                n_words = self._vocabulary.words.shape[1]
            self._blocks = {
                number: known.get(number) or files.read_block(self._database, number, n_words)
                for number in numbers
            }
            self._numbers = self._alive = self._index_of_all = None
            self._seen = seen

    def _needs_new_words(self, n_frames: int) -> bool:
        """Whether the vocabulary was learned from too little for a library of this size."""
        stored = sum(entry.seconds for entry in self._entries.values()) * RATE
        return self._vocabulary is None or self._vocabulary.is_outgrown(stored + n_frames)

    def _index_all(self, progress: Progress) -> None:
        """Learn words anew and describe all clips by them."""
        numbers = rows.clip_numbers(self._database)
        postures = [rows.read_postures(self._database, number) for number in numbers]
        vocabulary = learn_vocabulary(postures)
        files.write_vocabulary(self._database, vocabulary)
        self._database.execute("DELETE FROM blocks")
        described = describe_all_spans(postures, vocabulary, progress)
        ends = np.cumsum([len(spans.frames) for spans in described]) // LARGEST_BLOCK
        for one in np.unique(ends):
            first, last = np.searchsorted(ends, one), np.searchsorted(ends, one, side="right")
            block = block_of(numbers[first:last], described[first:last])
            files.write_block(self._database, block)

    def _index(
        self, numbers: list[int], postures: list[ClipPostures], progress: Progress
    ) -> None:
        """Describe clips, and put them into one block with the smaller ones before."""
        assert self._vocabulary is not None
        block = block_of(numbers, describe_all_spans(postures, self._vocabulary, progress))
        together = [block]
        for number, before in sorted(self._blocks.items(), reverse=True):
            n_spans = sum(one.n_spans for one in together)
            if before.n_spans > 2 * n_spans or before.n_spans + n_spans > LARGEST_BLOCK:
                break
            together.insert(0, before)
            self._database.execute("DELETE FROM blocks WHERE number = ?", (number,))
        if len(together) > 1:
            block = merged(together, np.array(rows.clip_numbers(self._database)))
        files.write_block(self._database, block)
