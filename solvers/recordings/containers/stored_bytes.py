"""Any part of a long run of bytes in a file, packed or not, without reading what is before."""

import zlib
from bisect import bisect_right
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from ...errors import InvalidFileError
from ...files import open_regular, unreadable

CHUNK = 1 << 17
"""Bytes that are taken from the file, and that are unpacked, at a time."""
MIN_MARK_SPACING, MAX_MARKS = 4_000_000, 400
"""Unpacked bytes between two marks, of which each holds some 50 kB; fewer in long files."""
MAX_CHECKED_BYTES = 200_000_000
"""Bytes that are looked through for damage before the first picture, in a second at most."""
MAX_DEFLATE_RATIO = 1040
"""How many bytes one packed byte can hold, by the rules of deflate."""


class StoredBytes(Protocol):
    """A run of bytes of which any part can be read."""

    @property
    def size(self) -> int:
        """How many bytes they are."""

    def read(self, start: int, count: int) -> bytes:
        """Return these bytes; raises InvalidFileError if they are damaged or cut off."""


@dataclass(frozen=True)
class PlainBytes:
    """Bytes that stand in a file as they are."""

    path: Path
    offset: int
    size: int

    def read(self, start: int, count: int) -> bytes:
        """Return these bytes; raises InvalidFileError if they are cut off."""
        try:
            with open_regular(self.path) as file:
                file.seek(self.offset + start)
                content = file.read(count)
        except OSError as error:
            raise unreadable(self.path, error) from None
        if len(content) < count:
            raise truncation_error(self.path)
        return content


@dataclass(frozen=True)
class ByteSlice:
    """Bytes behind a header."""

    whole: StoredBytes
    skipped: int
    size: int

    def read(self, start: int, count: int) -> bytes:
        """Return these bytes; raises InvalidFileError if they are damaged or cut off."""
        return self.whole.read(self.skipped + start, count)


class _Checkpoint(NamedTuple):
    """Where unpacking may go on: how much was unpacked, how much was taken, and the state."""

    unpacked: int
    taken: int
    state: Any
    tail: bytes


class PackedBytes:
    """Bytes that were packed with deflate, as in zip archives and MATLAB's files.

    Unpacking starts at marks that were left behind when a part was first come by, so that a
    jump back costs no more than a few pictures. Marks are kept while the object lives; a copy
    sent to another process begins without.

    Parameters
    ----------
    path : Path
    offset, packed : int, bytes
        Where the packed bytes begin in the file, and how many there are.
    size : int, bytes
        How many they are unpacked.
    window : int
        What zlib calls wbits: 15 with zlib's header, -15 without.
    """

    def __init__(self, path: Path, offset: int, packed: int, size: int, window: int) -> None:
        self.path, self.offset, self.packed, self.size = path, offset, packed, size
        self.window = window
        self._forget()

    def read(self, start: int, count: int) -> bytes:
        """Return these bytes; raises InvalidFileError if they are damaged or cut off."""
        at = bisect_right(self._marks, start, key=lambda mark: mark.unpacked) - 1
        mark = self._marks[at]
        if mark.unpacked <= self._last.unpacked <= start:
            mark = self._last
        try:
            with open_regular(self.path) as file:
                return self._unpack(file, mark, start, count)
        except OSError as error:
            raise unreadable(self.path, error) from None
        except zlib.error:
            raise damage_error(self.path) from None

    def check(self) -> None:
        """Raise zlib.error if the whole belies its checksum; long ones are believed."""
        if self.size > MAX_CHECKED_BYTES:
            return
        state, taken = zlib.decompressobj(self.window), 0
        with open_regular(self.path) as file:
            file.seek(self.offset)
            while not state.eof:
                tail = state.unconsumed_tail
                if not tail:
                    tail = file.read(min(CHUNK, self.packed - taken))
                    taken += len(tail)
                if not state.decompress(tail, CHUNK) and not tail:
                    raise zlib.error

    def _unpack(self, file: Any, mark: _Checkpoint, start: int, count: int) -> bytes:
        unpacked, taken, tail = mark.unpacked, mark.taken, mark.tail
        state = mark.state.copy()
        file.seek(self.offset + taken)
        wanted = []
        while unpacked < start + count:
            if not tail:
                tail = file.read(min(CHUNK, self.packed - taken))
                taken += len(tail)
            most = min(CHUNK, (start if unpacked < start else start + count) - unpacked)
            part = state.decompress(tail, most)
            if not part and (state.eof or taken >= self.packed or not tail):
                raise truncation_error(self.path)
            tail = state.unconsumed_tail
            if unpacked >= start:
                wanted.append(part)
            unpacked += len(part)
            self._leave_mark(_Checkpoint(unpacked, taken, state, tail))
        self._last = _Checkpoint(unpacked, taken, state, tail)
        return b"".join(wanted)

    def _leave_mark(self, mark: _Checkpoint) -> None:
        if mark.unpacked >= self._marks[-1].unpacked + self._spacing:
            self._marks.append(mark._replace(state=mark.state.copy()))

    def _forget(self) -> None:
        self._spacing = max(MIN_MARK_SPACING, self.size // MAX_MARKS)
        self._last = _Checkpoint(0, 0, zlib.decompressobj(self.window), b"")
        self._marks = [self._last]

    def __getstate__(self) -> dict[str, Any]:
        return {
            name: value for name, value in self.__dict__.items() if not name.startswith("_")
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._forget()


def truncation_error(path: Path) -> InvalidFileError:
    """Return the error of a file that ends too early."""
    return InvalidFileError(f"{path} is cut short. Copy or export it again.")


def damage_error(path: Path) -> InvalidFileError:
    """Return the error of a file whose bytes make no sense."""
    return InvalidFileError(f"{path} is damaged. Copy or export it again.")
