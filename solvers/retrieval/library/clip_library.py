"""Search, extend and shrink a library of clips, in memory or in a file."""

import sqlite3
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
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
    CLIP_RATE_HZ,
    Clip,
    ClipEntry,
    DescribedClip,
    IndexBlock,
    Origin,
    SearchIndex,
    Vocabulary,
    build_block,
    describe_all_segments,
    describe_clip,
)
from ..postures import ClipPostures
from . import clip_rows as rows
from . import library_file as files
from .database_errors import readable_errors
from .index_clips import index_all, index_more, learn_from_all
from .refused_files import read_refused, write_refused


class ClipLibrary:
    """Clips and their index, created by the functions of `open_library`.

    A library that was loaded from a file is that file. Each change is written at once as one
    transaction; other processes with the same file see it in their next search.
    """

    def __init__(self, database: sqlite3.Connection, path: Path | None = None) -> None:
        """Wrap an open database; use the functions of `open_library` instead."""
        self._database = database
        finalize(self, database.close)  # also closes the file of a library that was not closed
        self._path = path
        self._state = (-1, -1)
        self._entries: dict[int, ClipEntry] = {}
        self._blocks: dict[int, IndexBlock] = {}
        self._numbers: dict[str, int] | None = None
        self._alive_blocks: tuple[tuple[IndexBlock, NDArray[np.bool_]], ...] | None = None
        self._search_index: SearchIndex | None = None
        self._vocabulary_number = -1
        self._vocabulary: Vocabulary | None = None

    @property
    def path(self) -> Path | None:
        """The file of the library; None in memory."""
        return self._path

    @property
    def entries(self) -> tuple[ClipEntry, ...]:
        """Metadata of the clips in the order of their addition."""
        return tuple(self.numbered().values())

    @property
    def vocabulary(self) -> Vocabulary | None:
        """The vocabulary of the index; None while the library is empty."""
        self._refresh()
        return self._vocabulary

    @property
    def blocks(self) -> tuple[tuple[IndexBlock, NDArray[np.bool_]], ...]:
        """The index blocks, and a mask of the segments of existing clips in each block."""
        self._refresh()
        if self._alive_blocks is None:
            numbers = np.array(list(self._entries))
            self._alive_blocks = tuple(
                (block, np.isin(block.clips, numbers)) for block in self._blocks.values()
            )
        return self._alive_blocks

    @property
    def search_index(self) -> SearchIndex:
        """The complete index; cached until the library changes."""
        blocks = self.blocks
        if self._search_index is None:
            self._search_index = SearchIndex(blocks)
        return self._search_index

    def numbers_of(self, names: Iterable[str]) -> list[int]:
        """Return the numbers of clips by name; unknown names are skipped."""
        entries = self.numbered()
        if self._numbers is None:
            self._numbers = {entry.name: number for number, entry in entries.items()}
        return [self._numbers[name] for name in names if name in self._numbers]

    def numbered(self) -> dict[int, ClipEntry]:
        """Return the metadata of the clips by their numbers in the index."""
        self._refresh()
        return self._entries

    def postures(self, number: int, n_frames: int = 0) -> ClipPostures:
        """Return the indexed postures of a clip at 20 Hz, with at least `n_frames` frames."""
        with readable_errors(self._path):
            return rows.read_postures(self._database, number, n_frames)

    def add(self, clips: Iterable[Clip], *, progress: Progress = unwatched) -> None:
        """Add clips; replace those of the same origin or, without an origin, the same name.

        Raises
        ------
        InvalidMotionError
            A clip shows no body, or two without an origin share a name; nothing is changed.
        SolveCancelled
            Raised by `progress`; the library is unchanged.
        """
        clips = list(clips)
        described = []
        for index, clip in enumerate(clips):
            progress(0.5 * index / len(clips), clip.name)
            described.append(describe_clip(clip))
        self.add_described(described, progress=within(progress, 0.5, 1.0))

    def add_described(
        self,
        clips: Sequence[DescribedClip],
        *,
        free_name: rows.FreeName = rows.number_name,
        progress: Progress = unwatched,
    ) -> tuple[str, ...]:
        """Add clips from `describe_clip`, which may run in another process.

        A clip with an origin replaces the clip of that origin and keeps its name. If the name
        of a new clip exists, `free_name` returns another one while the file is locked.

        Returns
        -------
        tuple of str
            Names of the clips in the library.

        Raises
        ------
        InvalidMotionError
            Two clips without an origin have the same name; the library is unchanged.
        SolveCancelled
            Raised by `progress`; the library is unchanged.
        """
        names = Counter(clip.entry.name for clip in clips if clip.entry.origin is None)
        if duplicates := [name for name, count in names.items() if count > 1]:
            raise InvalidMotionError(f"Two clips have the name {min(duplicates)}.")
        if not clips:
            return ()
        postures = [rows.stored_postures(clip.postures) for clip in clips]
        with readable_errors(self._path), files.transaction(self._database):
            self._refresh()
            written = rows.write_clips(self._database, clips, free_name)
            if self._needs_new_vocabulary(sum(clip.n_frames for clip in postures)):
                index_all(self._database, learn_from_all(self._database), progress)
            else:
                assert self._vocabulary is not None
                described = describe_all_segments(postures, self._vocabulary, progress)
                index_more(self._database, self._blocks, build_block([*written], described))
            progress(1.0)
        return tuple(written.values())

    def freeze_vocabulary(
        self, vocabulary: Vocabulary, *, progress: Progress = unwatched
    ) -> None:
        """Use a vocabulary, such as that of another library, and never learn one again.

        If the library had another one, its clips are indexed again.

        Raises
        ------
        SolveCancelled
            Raised by `progress`; the library is unchanged.
        """
        with readable_errors(self._path), files.transaction(self._database):
            self._refresh()
            former, frozen = self._vocabulary, replace(vocabulary, is_frozen=True)
            if former is None or not former.describes_like(frozen):
                index_all(self._database, frozen, progress)
            elif not former.is_frozen:
                files.write_vocabulary(self._database, frozen)

    def remove(self, names: Sequence[str]) -> None:
        """Remove clips by name.

        Raises
        ------
        InvalidMotionError
            The library has no clip of that name; it is unchanged.
        """
        with readable_errors(self._path), files.transaction(self._database):
            for name in names:
                if not self._database.execute(
                    "DELETE FROM clips WHERE name = ?", (name,)
                ).rowcount:
                    raise InvalidMotionError(f"The library has no clip {name}.")

    def discard(self, numbers: Iterable[int]) -> tuple[str, ...]:
        """Remove the existing clips of these numbers; return their names."""
        with readable_errors(self._path), files.transaction(self._database):
            return tuple(rows.remove_clips(self._database, numbers))

    def refused(self, reader: str) -> dict[Origin, str]:
        """Return the files that this version of a reader refused, with the messages."""
        with readable_errors(self._path):
            return read_refused(self._database, reader)

    def remember_refused(self, reader: str, refused: Sequence[tuple[Origin, str]]) -> None:
        """Store refused files and the messages."""
        with readable_errors(self._path), files.transaction(self._database):
            write_refused(self._database, reader, refused)

    def save(self, path: Path | str) -> None:
        """Write the library into a file, atomically.

        Raises
        ------
        InvalidFileError
            The folder is missing or not writable.
        """
        with write_atomically(path) as part, readable_errors(Path(path)):
            copy = sqlite3.connect(part)
            try:
                self._database.backup(copy)
            finally:
                copy.close()

    def close(self) -> None:
        """Close the file."""
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
        """Reload what this or another process has changed."""
        with readable_errors(self._path), files.read_transaction(self._database):
            version = self._database.execute("PRAGMA data_version").fetchone()[0]
            state = (version, self._database.total_changes)
            if state == self._state:
                return
            words = files.vocabulary_number(self._database)
            if words != self._vocabulary_number:
                self._blocks = {}
                self._vocabulary = files.read_vocabulary(self._database)
                self._vocabulary_number = words
            self._entries = rows.read_entries(self._database, self._entries)
            numbers = files.block_numbers(self._database)
            if self._entries and not numbers:
                raise sqlite3.DatabaseError("the index is missing")
            cached, n_words = self._blocks, 0
            if self._vocabulary is not None:
                n_words = self._vocabulary.words.shape[1]
            self._blocks = {
                number: cached.get(number) or files.read_block(self._database, number, n_words)
                for number in numbers
            }
            self._numbers = self._alive_blocks = self._search_index = None
            self._state = state

    def _needs_new_vocabulary(self, n_frames: int) -> bool:
        """Whether a library of this size needs a new vocabulary."""
        stored = sum(entry.seconds for entry in self._entries.values()) * CLIP_RATE_HZ
        return self._vocabulary is None or self._vocabulary.is_outgrown(stored + n_frames)
