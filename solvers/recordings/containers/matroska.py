"""Index a Matroska file: its tracks, tags, attachments, and where each frame of a track is.

Only heads are read, so that a file of 20 GB takes seconds and little memory; a file that was
cut short, as by a recorder that crashed, is read as far as it goes.
"""

import struct
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from ...errors import InvalidFileError
from ...files import open_regular, unreadable
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
"""Nanoseconds in one unit of time."""
MAX_ELEMENT_BYTES = 16_000_000
"""Bytes of an element that is read whole."""
BLOCK_START = 4096
"""Bytes at the beginning of a block in which its lacing stands."""
PROGRESS_INTERVAL = 4096
MAX_TIME_NS = 2**62
"""Nanoseconds from the start of the recording: 146 years, which an array can hold."""

MAX_TRACKS = 127
"""As many as a block can name in one byte; cameras record up to five."""


@dataclass
class Track:
    """A track, and where its frames stand in the file.

    Attributes
    ----------
    times : array of int, nanoseconds
    places, sizes : arrays of int, bytes
    """

    number: int
    uid: int = 0
    name: str = ""
    codec: str = ""
    private: bytes = b""
    duration: int = 0
    """Nanoseconds of one frame; 0 where it is not said."""
    times: "array[int]" = field(default_factory=lambda: array("q"))
    places: "array[int]" = field(default_factory=lambda: array("q"))
    sizes: "array[int]" = field(default_factory=lambda: array("q"))


@dataclass
class Matroska:
    """What was found in a file.

    Attributes
    ----------
    tracks : dict of Track
        By their numbers, the first of each; at most `MAX_TRACKS`.
    tags : dict
        Value of each tag.
    files : dict
        Content of each attached file.
    whole : bool
        Whether the file ends where its last element does.
    """

    tracks: dict[int, Track] = field(default_factory=dict)
    tags: dict[str, str] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)
    whole: bool = True
    scale: int = DEFAULT_SCALE


def is_matroska(head: bytes) -> bool:
    """Tell from the first bytes."""
    return head[:4] == HEADER.to_bytes(4, "big")


def index_matroska(path: Path, wanted: Callable[[Track], bool], progress: Progress) -> Matroska:
    """Find what a file holds, and the frames of the tracks that are wanted.

    Raises
    ------
    InvalidFileError
        The file is missing or damaged before its first frame.
    SolveCancelled
        Raised by `progress`.
    """
    found = Matroska()
    try:
        with open_regular(path) as file:
            _walk(file, path.stat().st_size, found, wanted, progress)
    except OSError as error:
        raise unreadable(path, error) from None
    except (ValueError, IndexError, struct.error):
        raise InvalidFileError(
            f"{path} is damaged: it is not in the Matroska format. Copy or record it again."
        ) from None
    return found


def _walk(
    file: IO[bytes],
    end: int,
    found: Matroska,
    wanted: Callable[[Track], bool],
    progress: Progress,
) -> None:
    """Go from element to element; whatever holds frames is entered, so no size is needed."""
    at, cluster, n_elements = 0, 0, 0
    while at < end:
        head = _next_head(file, at, found)
        if head is None:
            return
        at += head.length
        if head.number in ENTERED:
            continue
        if head.size is None or at + head.size > end:
            found.whole = False
            return
        if head.number == TIMESTAMP:
            cluster = unsigned(_content(file, at, head.size))
        elif head.number in {SIMPLE_BLOCK, BLOCK}:
            _add_block(file, at, head.size, cluster, found, wanted)
        else:
            _describe(file, at, head, found)
        at += head.size
        n_elements += 1
        if not n_elements % PROGRESS_INTERVAL:
            progress(at / end, "Reading")


def _describe(file: IO[bytes], at: int, head: Head, found: Matroska) -> None:
    if head.number in DESCRIBED and head.size is not None and head.size <= MAX_ELEMENT_BYTES:
        DESCRIBED[head.number](_content(file, at, head.size), found)


def _next_head(file: IO[bytes], at: int, found: Matroska) -> Head | None:
    """Return the head of an element; None where frames came before, but here is nonsense."""
    try:
        return read_head(_content(file, at, MAX_HEAD_BYTES))
    except ValueError:
        if not any(track.places for track in found.tracks.values()):
            raise
        found.whole = False
        return None


def _content(file: IO[bytes], at: int, size: int) -> bytes:
    file.seek(at)
    return file.read(size)


def _add_block(
    file: IO[bytes],
    at: int,
    size: int,
    cluster: int,
    found: Matroska,
    wanted: Callable[[Track], bool],
) -> None:
    start = _content(file, at, min(size, BLOCK_START))
    number, time, flags, length = block_head(start)
    track = found.tracks.get(number)
    if track is None or not wanted(track):
        return
    for place, (begin, each) in enumerate(split_lacing(start[length:], flags, size - length)):
        since = (cluster + time) * found.scale + place * track.duration
        if abs(since) > MAX_TIME_NS:
            raise ValueError(since)
        track.times.append(since)
        track.places.append(at + length + begin)
        track.sizes.append(each)


def _read_info(content: bytes, found: Matroska) -> None:
    for number, inside in children(content):
        if number == SCALE:
            found.scale = unsigned(inside) or DEFAULT_SCALE


def _read_tracks(content: bytes, found: Matroska) -> None:
    for number, inside in children(content):
        if number == TRACK and len(found.tracks) < MAX_TRACKS:
            told = dict(children(inside))
            track = Track(
                unsigned(told.get(NUMBER, b"")),
                unsigned(told.get(UID, b"")),
                text(told.get(NAME, b"")),
                text(told.get(CODEC, b"")),
                told.get(PRIVATE, b""),
                unsigned(told.get(DURATION, b"")),
            )
            found.tracks.setdefault(track.number, track)


def _read_tags(content: bytes, found: Matroska) -> None:
    for number, tag in children(content):
        for kind, pair in children(tag) if number == TAG else ():
            if kind == TAG_PAIR:
                told = dict(children(pair))
                found.tags[text(told.get(TAG_NAME, b""))] = text(told.get(TAG_TEXT, b""))


def _read_files(content: bytes, found: Matroska) -> None:
    for number, inside in children(content):
        if number == FILE:
            told = dict(children(inside))
            found.files[text(told.get(FILE_NAME, b""))] = told.get(FILE_DATA, b"")


DESCRIBED = {INFO: _read_info, TRACKS: _read_tracks, TAGS: _read_tags, ATTACHMENTS: _read_files}
