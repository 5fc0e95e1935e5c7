"""Read header, parameters and points of C3D files.

Libraries fail on some of 44 test files from many makers. ezc3d 1.7.2 never returns from one,
which blocks Blender; it misplaces the points of four and refuses six. c3d 0.6.0 refuses
eleven. This reader reads all of them, and the tests compare it with both.

The format is described at https://www.c3d.org/HTML/default.htm.
"""

from math import prod
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from .text import map_bytes

BLOCK_BYTES = 512
C3D_ID = 0x50
DEC, MIPS = 85, 86
PROCESSORS = range(83, 88)
"""Codes of number formats: 84 Intel, 85 DEC, 86 SGI; some programs write one less or more."""
PARAMETER_BLOCKS = range(2, 33)
"""First block of the parameters: directly after the header, or after proprietary blocks."""
CHARACTERS, BYTES, INTEGERS, FLOATS = -1, 1, 2, 4


def is_c3d(head: bytes) -> bool:
    """Return whether a file is C3D, from its first bytes, even if it is damaged or truncated.

    The second byte is not sufficient: it is the letter P, as in PNG and PDF files.
    """
    if head[1:2] != bytes([C3D_ID]):
        return False
    starts_plausibly = head[0] in PARAMETER_BLOCKS and b"\0" in head[:BLOCK_BYTES]
    return starts_plausibly or _has_parameters(head, BLOCK_BYTES)


def _has_parameters(content: bytes, start: int) -> bool:
    """Return whether parameters begin at a byte, with the name of a group."""
    head = content[start : start + 6]
    if len(head) < 6 or head[3] not in PROCESSORS or head[5] < 128:
        return False
    length = min(head[4], 256 - head[4])  # A locked group has a negative length.
    name = content[start + 6 : start + 6 + length]
    return 0 < length == len(name) and name.isascii() and name.decode().isprintable()


class C3dFile:
    """The contents of a C3D file that describe point tracks.

    The file is memory-mapped: analog channels and forces, which may be most of it, are never
    read.

    Parameters
    ----------
    path : Path or str

    Raises
    ------
    InvalidFileError
        The file is missing, truncated or not a C3D file.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = path
        self.content = map_bytes(path)
        if len(self.content) < 2 * BLOCK_BYTES or self.content[1] != C3D_ID:
            raise InvalidFileError(f"{path} is not a C3D file, or is cut short.")
        start = self._parameter_start()
        self.processor = self.content[start + 3]
        self.order = ">" if self.processor == MIPS else "<"
        self.parameters = self._read_parameters(start + 4)

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Return all values of a parameter such as `POINT:RATE`, flattened; empty if absent."""
        value = self.parameters.get(name)
        return np.empty(0) if value is None or isinstance(value, list) else value

    def texts(self, name: str) -> list[str]:
        """Return all texts of a parameter such as `POINT:LABELS`; empty if absent."""
        value = self.parameters.get(name)
        return value if isinstance(value, list) else []

    @property
    def frame_rate(self) -> float:
        """Frames per second, from the parameters or otherwise from the header."""
        for rate in [*self.numbers("POINT:RATE")[:1], *self._floats(20, 1)]:
            if 1e-3 < rate < 1e6:
                return float(rate)
        raise InvalidFileError(f"{self.path} does not state its frame rate.")

    @property
    def n_points(self) -> int:
        """Number of points, of the header."""
        return int(self._integers(2, 1)[0])

    def read_points(self) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Return coordinates in the file's units, and whether each point was observed.

        Shapes (n_frames, n_points, 3) and (n_frames, n_points).
        """
        n_points = self.n_points
        if not n_points:
            raise InvalidFileError(f"{self.path} has no points, only other signals or nothing.")
        scale = self._scale()
        kind = "i2" if scale > 0.0 else "f4"
        start, n_frames, n_others = self._extent(n_points, 2 if scale > 0.0 else 4)
        if not n_frames:
            raise InvalidFileError(f"{self.path} ends before its first frame: it is cut short.")
        n_values = n_frames * (4 * n_points + n_others)
        words = np.frombuffer(self.content, self.order + kind, n_values, start)
        frames = words.reshape(n_frames, -1)[:, : 4 * n_points].reshape(n_frames, n_points, 4)
        if kind == "f4" and self.processor == DEC:
            frames = _from_dec(np.ascontiguousarray(frames))
        with np.errstate(invalid="ignore"):  # Damaged floats may be signaling NaN.
            points = frames[..., :3].astype(np.float64) * (scale if scale > 0.0 else 1.0)
            return points, np.asarray(frames[..., 3] >= 0)

    def _parameter_start(self) -> int:
        """Return the first byte of the parameters, even if the pointer to it is damaged."""
        for start in [BLOCK_BYTES * (self.content[0] - 1), BLOCK_BYTES]:
            if 0 < start <= len(self.content) - 4 and self.content[start + 3] in PROCESSORS:
                return start
        raise InvalidFileError(f"{self.path} has no C3D parameters: it is damaged.")

    def _read_parameters(self, at: int) -> dict[str, NDArray[np.float64] | list[str]]:
        """Return the readable parameters by `GROUP:NAME`; the first of equal names is used."""
        groups: dict[int, str] = {}
        entries: list[tuple[int, str, NDArray[np.float64] | list[str]]] = []
        size = len(self.content)
        while at + 4 < size:
            length, group = np.frombuffer(self.content, np.int8, 2, at).tolist()
            length = abs(length)
            name = self.content[at + 2 : at + 2 + length].decode("latin-1").strip().upper()
            link = at + 2 + length
            if not length or link + 5 > size:
                break
            if group < 0:
                groups.setdefault(-group, name)
            else:
                entries.append((group, name, self._read_parameter(link + 2)))
            step = int(np.frombuffer(self.content, self.order + "u2", 1, link)[0])
            if not step:
                break
            at = link + step
        parameters: dict[str, NDArray[np.float64] | list[str]] = {}
        for group, name, value in entries:
            parameters.setdefault(f"{groups.get(group, '')}:{name}", value)
        return parameters

    def _read_parameter(self, at: int) -> NDArray[np.float64] | list[str]:
        """Return the value at a byte offset; empty if the file ends within it."""
        kind, n_dimensions = np.frombuffer(self.content, np.int8, 2, at).tolist()
        sizes = list(self.content[at + 2 : at + 2 + max(0, n_dimensions)])
        start = at + 2 + len(sizes)
        count = prod(sizes)  # Python integers do not overflow.
        width = {CHARACTERS: 1, BYTES: 1, INTEGERS: 2, FLOATS: 4}.get(kind, 0)
        if not width or start + count * width > len(self.content):
            return np.empty(0)
        if kind == CHARACTERS:
            length = max(1, sizes[0] if sizes else 1)
            text = self.content[start : start + count].decode("latin-1")
            return [
                text[first : first + length].strip(" \0") for first in range(0, count, length)
            ]
        if kind == FLOATS:
            return self._floats(start, count)
        kind_name = "u1" if kind == BYTES else self.order + "i2"
        return np.frombuffer(self.content, kind_name, count, start).astype(np.float64)

    def _scale(self) -> float:
        """Return the units per integer step; negative if coordinates are floats."""
        for scale in [*self._floats(12, 1), *self.numbers("POINT:SCALE")[:1]]:
            if np.isfinite(scale) and scale != 0.0:
                return float(scale)
        return -1.0

    def _extent(self, n_points: int, width: int) -> tuple[int, int, int]:
        """Return the first byte of the data, the number of frames, and analog values per frame.

        If stored counts contradict each other, those that best fill the file are used.
        """
        start = BLOCK_BYTES * (int(self._integers(16, 1)[0]) - 1)
        n_bytes = len(self.content) - start
        if start < BLOCK_BYTES or n_bytes <= 0:
            raise InvalidFileError(f"{self.path} is cut short: its data are missing.")
        fits = [
            (n_bytes - n_frames * width * (4 * n_points + n_others), n_frames, n_others)
            for n_frames in self.frame_counts()
            for n_others in self._other_counts()
        ]
        fitting = [fit for fit in fits if fit[0] >= 0]
        if not fitting:
            raise InvalidFileError(
                f"{self.path} is cut short: it is too small for the {min(fits)[1]} frames"
                " of its header. Copy or export it again."
            )
        _, n_frames, n_others = min(fitting)
        return start, n_frames, n_others

    def frame_counts(self) -> list[int]:
        """Return all stored numbers of frames; that of the header wraps at 65536."""
        first, last = self._integers(6, 2)
        counts = [float(last) - float(first) + 1.0]
        counts += [
            *self.numbers("POINT:LONG_FRAMES")[:1],
            *self.numbers("POINT:FRAMES")[:1] % 65536,
        ]
        begin, end = (
            self.numbers(f"TRIAL:ACTUAL_{which}_FIELD")[:2] % 65536
            for which in ("START", "END")
        )
        if len(begin) == len(end) == 2:
            counts.append(float((end - begin) @ (1.0, 65536.0)) + 1.0)
        return [int(count) for count in counts if 0.0 < count < 2**31] or [1]

    def _other_counts(self) -> list[int]:
        """Return all stored numbers of analog values per frame."""
        total, per_channel = self._integers(4, 1)[0], self._integers(18, 1)[0]
        counts = [int(total)]
        used = self.numbers("ANALOG:USED")[:1]
        rate = self.numbers("ANALOG:RATE")[:1]
        counts += [int(channels) * int(per_channel) for channels in used]
        if len(used) and len(rate) and np.isfinite(rate[0] / self.frame_rate):
            counts.append(int(used[0] * round(rate[0] / self.frame_rate)))
        return [count for count in counts if 0 <= count < 2**31]

    def _integers(self, at: int, count: int) -> NDArray[np.uint16]:
        return np.frombuffer(self.content, self.order + "u2", count, at)

    def _floats(self, at: int, count: int) -> NDArray[np.float64]:
        values = np.frombuffer(self.content, self.order + "f4", count, at)
        if self.processor == DEC:
            values = _from_dec(values)
        with np.errstate(invalid="ignore"):
            return values.astype(np.float64)


def _from_dec(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Convert VAX F floats: the two halves are swapped, and the exponent is larger by two."""
    halves = values.view("<u2").reshape(*values.shape, 2)[..., ::-1]
    with np.errstate(invalid="ignore"):
        return np.ascontiguousarray(halves).view("<f4").reshape(values.shape) / np.float32(4.0)
