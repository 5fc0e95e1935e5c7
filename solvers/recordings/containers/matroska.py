"""Index a Matroska file: its tracks, tags, attachments, and the offset of each frame.

Only element headers are read, so that a file of 20 GB takes seconds and little memory. A
truncated file, for example of a recorder that crashed, is read up to its end.
"""

import struct
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from ...errors import InvalidFileError
from ...files import open_regular, unreadable_error
from ...progress import Progress
from .ebml import (
    MAX_HEAD_BYTES,
    Head,
    block_head,
    children,
    read_head,
    split_lacing,
    text,
    unsigned,
)

HEADER = 0x1A45DFA3
SEGMENT, CLUSTER, GROUP = 0x18538067, 0x1F43B675, 0xA0
INFO, TRACKS, TAGS, ATTACHMENTS = 0x1549A966, 0x1654AE6B, 0x1254C367, 0x1941A469
TIMESTAMP, SIMPLE_BLOCK, BLOCK = 0xE7, 0xA3, 0xA1
SCALE = 0x2AD7B1
TRACK, NUMBER, UID, NAME, CODEC, PRIVATE, DURATION = (
    0xAE, 0xD7, 0x73C5, 0x536E, 0x86, 0x63A2, 0x23E383,
)  # fmt: skip
TAG, TAG_PAIR, TAG_NAME, TAG_TEXT = 0x7373, 0x67C8, 0x45A3, 0x4487
FILE, FILE_NAME, FILE_DATA = 0x61A7, 0x466E, 0x465C
ENTERED = {SEGMENT, CLUSTER, GROUP}
DEFAULT_SCALE = 1_000_000
"""Nanoseconds per unit of time."""
MAX_ELEMENT_BYTES = 16_000_000
"""Maximum size of an element that is loaded, bytes."""
BLOCK_START = 4096
"""Bytes at the start of a block that contain its lacing."""
PROGRESS_INTERVAL = 4096
MAX_TIME_NS = 2**62
"""Maximum time from the start of the recording: 146 years, which fit into an array."""

MAX_TRACKS = 127
"""Maximum track number in one byte of a block; cameras record up to five tracks."""


@dataclass
class Track:
    """A track and the offsets of its frames in the file.

    Attributes
    ----------
    times : array of int, nanoseconds
    offsets, sizes : arrays of int, bytes
    """

    number: int
    uid: int = 0
    name: str = ""
    codec: str = ""
    private: bytes = b""
    duration: int = 0
    """Nanoseconds per frame; 0 if not stored."""
    times: "array[int]" = field(default_factory=lambda: array("q"))
    offsets: "array[int]" = field(default_factory=lambda: array("q"))
    sizes: "array[int]" = field(default_factory=lambda: array("q"))


@dataclass
class Matroska:
    """The index of a file.

    Attributes
    ----------
    tracks : dict of Track
        By number; the first of each; at most `MAX_TRACKS`.
    tags : dict
        Value of each tag.
    files : dict
        Content of each attached file.
    is_complete : bool
        Whether the file ends with its last element.
    read_to : int, bytes
        Where the next element begins, for a file that grows.
    cluster : int
        Time of the cluster there, in its unit.
    """

    tracks: dict[int, Track] = field(default_factory=dict)
    tags: dict[str, str] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)
    is_complete: bool = True
    scale: int = DEFAULT_SCALE
    read_to: int = 0
    cluster: int = 0


def is_matroska(head: bytes) -> bool:
    """Return whether a file is Matroska, from its first bytes."""
    return head[:4] == HEADER.to_bytes(4, "big")


def index_matroska(
    path: Path,
    wanted: Callable[[Track], bool],
    progress: Progress,
    index: Matroska | None = None,
) -> Matroska:
    """Index a file, and the frames of the wanted tracks.

    An index of the file when it was shorter is continued.

    Raises
    ------
    InvalidFileError
        The file is missing or damaged before its first frame.
    SolveCancelled
        Raised by `progress`.
    """
    index = index or Matroska()
    index.is_complete = True
    try:
        with open_regular(path) as file:
            _scan(file, path.stat().st_size, index, wanted, progress)
    except OSError as error:
        raise unreadable_error(path, error) from None
    except (ValueError, IndexError, struct.error):
        raise InvalidFileError(
            f"{path} is damaged: it is not in the Matroska format. Copy or record it again."
        ) from None
    return index


def _scan(
    file: IO[bytes],
    end: int,
    index: Matroska,
    wanted: Callable[[Track], bool],
    progress: Progress,
) -> None:
    """Scan all elements; those that contain frames are entered, so their size is not needed."""
    n_elements = 0
    while index.read_to < end:
        head = _next_head(file, index.read_to, index)
        if head is None:
            return
        at = index.read_to + head.length
        if head.number in ENTERED:
            index.read_to = at
            continue
        if head.size is None or at + head.size > end:
            index.is_complete = False
            return
        if head.number == TIMESTAMP:
            index.cluster = unsigned(_content(file, at, head.size))
        elif head.number in {SIMPLE_BLOCK, BLOCK}:
            _add_block(file, at, head.size, index.cluster, index, wanted)
        else:
            _describe(file, at, head, index)
        index.read_to = at + head.size
        n_elements += 1
        if not n_elements % PROGRESS_INTERVAL:
            progress(index.read_to / end, "Reading")


def _describe(file: IO[bytes], at: int, head: Head, index: Matroska) -> None:
    if head.number in DESCRIBED and head.size is not None and head.size <= MAX_ELEMENT_BYTES:
        DESCRIBED[head.number](_content(file, at, head.size), index)


def _next_head(file: IO[bytes], at: int, index: Matroska) -> Head | None:
    """Return the next header; None if it is invalid and frames precede it."""
    try:
        return read_head(_content(file, at, MAX_HEAD_BYTES))
    except ValueError:
        if not any(track.offsets for track in index.tracks.values()):
            raise
        index.is_complete = False
        return None


def _content(file: IO[bytes], at: int, size: int) -> bytes:
    file.seek(at)
    return file.read(size)


def _add_block(
    file: IO[bytes],
    at: int,
    size: int,
    cluster: int,
    index: Matroska,
    wanted: Callable[[Track], bool],
) -> None:
    start = _content(file, at, min(size, BLOCK_START))
    number, time, flags, length = block_head(start)
    track = index.tracks.get(number)
    if track is None or not wanted(track):
        return
    for number_in_block, (begin, each) in enumerate(
        split_lacing(start[length:], flags, size - length)
    ):
        timestamp = (cluster + time) * index.scale + number_in_block * track.duration
        if abs(timestamp) > MAX_TIME_NS:
            raise ValueError(timestamp)
        track.times.append(timestamp)
        track.offsets.append(at + length + begin)
        track.sizes.append(each)


def _read_info(content: bytes, index: Matroska) -> None:
    for number, child in children(content):
        if number == SCALE:
            index.scale = unsigned(child) or DEFAULT_SCALE


def _read_tracks(content: bytes, index: Matroska) -> None:
    for number, child in children(content):
        if number == TRACK and len(index.tracks) < MAX_TRACKS:
            fields = dict(children(child))
            track = Track(
                unsigned(fields.get(NUMBER, b"")),
                unsigned(fields.get(UID, b"")),
                text(fields.get(NAME, b"")),
                text(fields.get(CODEC, b"")),
                fields.get(PRIVATE, b""),
                unsigned(fields.get(DURATION, b"")),
            )
            index.tracks.setdefault(track.number, track)


def _read_tags(content: bytes, index: Matroska) -> None:
    for number, tag in children(content):
        for kind, pair in children(tag) if number == TAG else ():
            if kind == TAG_PAIR:
                fields = dict(children(pair))
                index.tags[text(fields.get(TAG_NAME, b""))] = text(fields.get(TAG_TEXT, b""))


def _read_files(content: bytes, index: Matroska) -> None:
    for number, child in children(content):
        if number == FILE:
            fields = dict(children(child))
            index.files[text(fields.get(FILE_NAME, b""))] = fields.get(FILE_DATA, b"")


DESCRIBED = {INFO: _read_info, TRACKS: _read_tracks, TAGS: _read_tags, ATTACHMENTS: _read_files}
