"""Index the clips of a library in blocks of its database; call within a transaction."""

import sqlite3
from collections.abc import Mapping

import numpy as np

from ...progress import Progress
from ..index import (
    IndexBlock,
    Segments,
    Vocabulary,
    build_block,
    describe_clip_segments,
    learn_vocabulary,
    merge_blocks,
)
from . import clip_rows as rows
from . import library_file as files

MAX_BLOCK_SEGMENTS = 50_000
"""Segments of a merged block at most: SQLite stores about four times as many in one row, and a
larger merge needs much memory."""


def learn_from_all(database: sqlite3.Connection) -> Vocabulary:
    """Learn a vocabulary from all clips."""
    numbers = rows.clip_numbers(database)
    return learn_vocabulary([rows.read_postures(database, number) for number in numbers])


def index_all(database: sqlite3.Connection, vocabulary: Vocabulary, progress: Progress) -> None:
    """Index all clips with a vocabulary that replaces the former one.

    One block at a time is in memory.
    """
    files.write_vocabulary(database, vocabulary)
    database.execute("DELETE FROM blocks")
    numbers = rows.clip_numbers(database)
    clips, described, n_segments = list[int](), list[Segments](), 0
    for index, number in enumerate(numbers):
        progress(index / len(numbers), "Indexing")
        segments = describe_clip_segments(rows.read_postures(database, number), vocabulary)
        before, n_segments = n_segments, n_segments + len(segments.frames)
        if clips and n_segments // MAX_BLOCK_SEGMENTS > before // MAX_BLOCK_SEGMENTS:
            files.write_block(database, build_block(clips, described))
            clips, described = [], []
        clips.append(number)
        described.append(segments)
    if clips:
        files.write_block(database, build_block(clips, described))


def index_more(
    database: sqlite3.Connection, former: Mapping[int, IndexBlock], block: IndexBlock
) -> None:
    """Add the block of new clips, merged with smaller previous blocks."""
    group = [block]
    for number, before in sorted(former.items(), reverse=True):
        n_segments = sum(one.n_segments for one in group)
        if (
            before.n_segments > 2 * n_segments
            or before.n_segments + n_segments > MAX_BLOCK_SEGMENTS
        ):
            break
        group.insert(0, before)
        database.execute("DELETE FROM blocks WHERE number = ?", (number,))
    if len(group) > 1:
        block = merge_blocks(group, np.array(rows.clip_numbers(database)))
    files.write_block(database, block)
