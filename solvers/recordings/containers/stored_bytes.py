"""Read any range of stored or compressed bytes in a file, without reading from the start."""

import zlib
from bisect import bisect_right
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from ...errors import InvalidFileError
from ...files import open_regular, unreadable_error

CHUNK_BYTES = 1 << 17
"""Bytes read from the file, and decompressed, at a time."""
MIN_CHECKPOINT_SPACING, MAX_CHECKPOINTS = 4_000_000, 400
"""Minimum decompressed bytes between two checkpoints, and maximum number of checkpoints. A
checkpoint takes about 50 kB."""
MAX_CHECKED_BYTES = 200_000_000
"""Maximum size checked for damage before the first image, which takes up to a second."""
MAX_DEFLATE_RATIO = 1040
"""Maximum decompressed bytes per compressed byte of deflate."""


class StoredBytes(Protocol):
    """Bytes with random access."""

    @property
    def size(self) -> int:
        """Number of bytes."""

    def read(self, start: int, count: int) -> bytes:
        """Return a range of bytes; raise InvalidFileError if it is damaged or truncated."""


@dataclass(frozen=True)
class PlainBytes:
    """Uncompressed bytes in a file."""

    path: Path
    offset: int
    size: int

    def read(self, start: int, count: int) -> bytes:
        """Return a range of bytes; raise InvalidFileError if it is truncated."""
        try:
            with open_regular(self.path) as file:
                file.seek(self.offset + start)
                content = file.read(count)
        except OSError as error:
            raise unreadable_error(self.path, error) from None
        if len(content) < count:
            raise truncation_error(self.path)
        return content


@dataclass(frozen=True)
class ByteSlice:
    """Bytes after a header."""

    source: StoredBytes
    skipped: int
    size: int

    def read(self, start: int, count: int) -> bytes:
        """Return a range of bytes; raise InvalidFileError if it is damaged or truncated."""
        return self.source.read(self.skipped + start, count)


class _Checkpoint(NamedTuple):
    """A state from which decompression can resume.

    Attributes
    ----------
    unpacked, taken : int, bytes
        Decompressed, and read from the file, so far.
    state : zlib decompression object
    tail : bytes
        Read but not yet decompressed.
    """

    unpacked: int
    taken: int
    state: Any
    tail: bytes


class PackedBytes:
    """Bytes compressed with deflate, as in zip archives and MATLAB files.

    Decompression resumes at checkpoints of earlier reads, so that a jump back costs no more
    than a few images. Checkpoints are not pickled.

    Parameters
    ----------
    path : Path
    offset, packed : int, bytes
        Offset and number of the compressed bytes in the file.
    size : int, bytes
        Number of decompressed bytes.
    window : int
        `wbits` of zlib: 15 with a zlib header, -15 without.
    """

    def __init__(self, path: Path, offset: int, packed: int, size: int, window: int) -> None:
        self.path, self.offset, self.packed, self.size = path, offset, packed, size
        self.window = window
        self._reset()

    def read(self, start: int, count: int) -> bytes:
        """Return a range of bytes; raise InvalidFileError if it is damaged or truncated."""
        at = (
            bisect_right(self._checkpoints, start, key=lambda checkpoint: checkpoint.unpacked)
            - 1
        )
        checkpoint = self._checkpoints[at]
        if checkpoint.unpacked <= self._last.unpacked <= start:
            checkpoint = self._last
        try:
            with open_regular(self.path) as file:
                return self._unpack(file, checkpoint, start, count)
        except OSError as error:
            raise unreadable_error(self.path, error) from None
        except zlib.error:
            raise damage_error(self.path) from None

    def check(self) -> None:
        """Raise zlib.error if the checksum does not match; long content is not checked."""
        if self.size > MAX_CHECKED_BYTES:
            return
        state, taken = zlib.decompressobj(self.window), 0
        with open_regular(self.path) as file:
            file.seek(self.offset)
            while not state.eof:
                tail = state.unconsumed_tail
                if not tail:
                    tail = file.read(min(CHUNK_BYTES, self.packed - taken))
                    taken += len(tail)
                if not state.decompress(tail, CHUNK_BYTES) and not tail:
                    raise zlib.error

    def _unpack(self, file: Any, checkpoint: _Checkpoint, start: int, count: int) -> bytes:
        unpacked, taken, tail = checkpoint.unpacked, checkpoint.taken, checkpoint.tail
        state = checkpoint.state.copy()
        file.seek(self.offset + taken)
        parts = []
        while unpacked < start + count:
            if not tail:
                tail = file.read(min(CHUNK_BYTES, self.packed - taken))
                taken += len(tail)
            max_length = min(
                CHUNK_BYTES, (start if unpacked < start else start + count) - unpacked
            )
            part = state.decompress(tail, max_length)
            if not part and (state.eof or taken >= self.packed or not tail):
                raise truncation_error(self.path)
            tail = state.unconsumed_tail
            if unpacked >= start:
                parts.append(part)
            unpacked += len(part)
            self._add_checkpoint(_Checkpoint(unpacked, taken, state, tail))
        self._last = _Checkpoint(unpacked, taken, state, tail)
        return b"".join(parts)

    def _add_checkpoint(self, checkpoint: _Checkpoint) -> None:
        if checkpoint.unpacked >= self._checkpoints[-1].unpacked + self._spacing:
            self._checkpoints.append(checkpoint._replace(state=checkpoint.state.copy()))

    def _reset(self) -> None:
        self._spacing = max(MIN_CHECKPOINT_SPACING, self.size // MAX_CHECKPOINTS)
        self._last = _Checkpoint(0, 0, zlib.decompressobj(self.window), b"")
        self._checkpoints = [self._last]

    def __getstate__(self) -> dict[str, Any]:
        return {
            name: value for name, value in self.__dict__.items() if not name.startswith("_")
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._reset()


def truncation_error(path: Path) -> InvalidFileError:
    """Return the error for a truncated file."""
    return InvalidFileError(f"{path} is cut short. Copy or export it again.")


def damage_error(path: Path) -> InvalidFileError:
    """Return the error for a file with invalid bytes."""
    return InvalidFileError(f"{path} is damaged. Copy or export it again.")
