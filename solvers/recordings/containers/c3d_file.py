"""What a C3D file holds, byte by byte: header, parameters and points.

Why not a library: of 44 files at hand, from many makers, ezc3d 1.7.2 never returns from one,
and being native code takes Blender with it; it misplaces the points of four and refuses six.
c3d 0.6.0 refuses eleven. This reads all of them, and the tests hold it against both.

The format is described at https://www.c3d.org/HTML/default.htm.
"""

from math import prod
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from .text import map_bytes

BLOCK = 512
C3D_ID = 0x50
DEC, MIPS = 85, 86
PROCESSORS = range(83, 88)
"""Kinds of numbers: 84 Intel, 85 DEC, 86 SGI; some programs write one less or more."""
PARAMETER_BLOCKS = range(2, 33)
"""Where parameters begin: right behind the header, or behind some blocks of a maker's own."""
CHARACTERS, BYTES, INTEGERS, FLOATS = -1, 1, 2, 4


def is_c3d(head: bytes) -> bool:
    """Tell from the first bytes of a file, also of one that is damaged or cut short.

    The second byte alone does not tell: it is a letter P, as in PNG and PDF files.
    """
    if head[1:2] != bytes([C3D_ID]):
        return False
    begins_well = head[0] in PARAMETER_BLOCKS and b"\0" in head[:BLOCK]
    return begins_well or _has_parameters(head, BLOCK)


def _has_parameters(content: bytes, start: int) -> bool:
    """Whether parameters begin at a byte: with a group that has a name, as all do."""
    head = content[start : start + 6]
    if len(head) < 6 or head[3] not in PROCESSORS or head[5] < 128:
        return False
    length = min(head[4], 256 - head[4])  # A locked group has a negative one.
    name = content[start + 6 : start + 6 + length]
    return 0 < length == len(name) and name.isascii() and name.decode().isprintable()


class C3dFile:
    """The parts of a C3D file that matter for point tracks.

    The file is mapped, not loaded: analog channels and forces, which may be most of it, are
    never read.

    Parameters
    ----------
    path : Path or str

    Raises
    ------
    InvalidFileError
        The file is missing, cut short or no C3D file.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = path
        self.content = map_bytes(path)
        if len(self.content) < 2 * BLOCK or self.content[1] != C3D_ID:
            raise InvalidFileError(f"{path} is no C3D file, or is cut short.")
        start = self._parameter_start()
        self.processor = self.content[start + 3]
        self.order = ">" if self.processor == MIPS else "<"
        self.parameters = self._read_parameters(start + 4)

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Return all values of a parameter such as `POINT:RATE`, in one row; none if absent."""
        value = self.parameters.get(name)
        return np.empty(0) if value is None or isinstance(value, list) else value

    def texts(self, name: str) -> list[str]:
        """Return all texts of a parameter such as `POINT:LABELS`; none if absent."""
        value = self.parameters.get(name)
        return value if isinstance(value, list) else []

    @property
    def frame_rate(self) -> float:
        """Frames per second, of the parameters or else of the header."""
        for rate in [*self.numbers("POINT:RATE")[:1], *self._floats(20, 1)]:
            if 1e-3 < rate < 1e6:
                return float(rate)
        raise InvalidFileError(f"{self.path} does not say its frame rate.")

    def read_points(self) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Return coordinates in the file's units, and whether each point was seen.

        Shapes (n_frames, n_points, 3) and (n_frames, n_points).
        """
        n_points = int(self._integers(2, 1)[0])
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
        with np.errstate(invalid="ignore"):  # Damaged floats may be NaN of a kind that warns.
            points = frames[..., :3].astype(np.float64) * (scale if scale > 0.0 else 1.0)
            return points, np.asarray(frames[..., 3] >= 0)

    def _parameter_start(self) -> int:
        """Return where the parameters begin; also where a broken first byte hides it."""
        for start in [BLOCK * (self.content[0] - 1), BLOCK]:
            if 0 < start <= len(self.content) - 4 and self.content[start + 3] in PROCESSORS:
                return start
        raise InvalidFileError(f"{self.path} has no C3D parameters: it is damaged.")

    def _read_parameters(self, at: int) -> dict[str, NDArray[np.float64] | list[str]]:
        """Return what can be read, by `GROUP:NAME`; the first of equal names counts."""
        groups: dict[int, str] = {}
        found: list[tuple[int, str, NDArray[np.float64] | list[str]]] = []
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
                found.append((group, name, self._read_parameter(link + 2)))
            step = int(np.frombuffer(self.content, self.order + "u2", 1, link)[0])
            if not step:
                break
            at = link + step
        named: dict[str, NDArray[np.float64] | list[str]] = {}
        for group, name, value in found:
            named.setdefault(f"{groups.get(group, '')}:{name}", value)
        return named

    def _read_parameter(self, at: int) -> NDArray[np.float64] | list[str]:
        """Return the value that begins at a byte; empty if the file ends within it."""
        kind, n_dimensions = np.frombuffer(self.content, np.int8, 2, at).tolist()
        sizes = list(self.content[at + 2 : at + 2 + max(0, n_dimensions)])
        start = at + 2 + len(sizes)
        count = prod(sizes)  # Of Python's integers: NumPy's would wrap around.
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
        """Return units per step; negative where coordinates are floats already."""
        for scale in [*self._floats(12, 1), *self.numbers("POINT:SCALE")[:1]]:
            if np.isfinite(scale) and scale != 0.0:
                return float(scale)
        return -1.0

    def _extent(self, n_points: int, width: int) -> tuple[int, int, int]:
        """Return the first byte of the data, the number of frames, and of other values in each.

        Counts that contradict each other are weighed by how well they fill the file.
        """
        start = BLOCK * (int(self._integers(16, 1)[0]) - 1)
        n_bytes = len(self.content) - start
        if start < BLOCK or n_bytes <= 0:
            raise InvalidFileError(f"{self.path} is cut short: its data are missing.")
        fits = [
            (n_bytes - n_frames * width * (4 * n_points + n_others), n_frames, n_others)
            for n_frames in self._frame_counts()
            for n_others in self._other_counts()
        ]
        fitting = [fit for fit in fits if fit[0] >= 0]
        if not fitting:
            raise InvalidFileError(
                f"{self.path} is cut short: it has no room for the {min(fits)[1]} frames that"
                " it announces. Copy or export it again."
            )
        _, n_frames, n_others = min(fitting)
        return start, n_frames, n_others

    def _frame_counts(self) -> list[int]:
        """Return all that the file says of its number of frames; in the header it wraps."""
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
        """Return all that the file says of how many analog values each frame has."""
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
    """Read VAX F floats: the two halves are swapped, and the exponent is larger by two."""
    halves = values.view("<u2").reshape(*values.shape, 2)[..., ::-1]
    with np.errstate(invalid="ignore"):
        return np.ascontiguousarray(halves).view("<f4").reshape(values.shape) / np.float32(4.0)
