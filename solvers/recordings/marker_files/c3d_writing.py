"""Write C3D files that motion-capture and biomechanics programs read."""

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...errors import InvalidMotionError
from ...files import write_atomically
from ...motion import Tracks
from ...progress import Progress, unwatched
from ..containers import BLOCK_BYTES, C3D_ID, CHARACTERS, FLOATS, INTEGERS

INTEL = 84
MILLIMETERS_PER_METER = 1000.0
LABELS_AT_ONCE = 255
MAX_TEXT_BYTES = 255
MAX_BLOCKS = 255
MAX_COUNT = 65535


def write_c3d(tracks: Tracks, path: Path | str, *, progress: Progress = unwatched) -> None:
    """Write tracks as a C3D file, atomically: millimeters, Z up, single precision.

    Missing points get the residual -1, as the format defines. The format has no confidence.

    Parameters
    ----------
    tracks : Tracks
    path : Path or str
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There are too many points, or too long names, for the format.
    InvalidFileError
        The file cannot be written.
    SolveCancelled
        Raised by `progress`, which is called at the end.
    """
    n_blocks = -(-(4 + len(_parameters(tracks, 0))) // BLOCK_BYTES)
    if n_blocks > MAX_BLOCKS or tracks.n_points > MAX_COUNT:
        raise InvalidMotionError(
            f"{tracks.n_points} points with these names do not fit into a C3D file. Shorten the"
            " names, or write fewer points."
        )
    first_data_block = 2 + n_blocks
    parameters = struct.pack("<BBBB", 1, C3D_ID, n_blocks, INTEL)
    parameters += _parameters(tracks, first_data_block)
    frames = np.empty((tracks.n_frames, tracks.n_points, 4), dtype="<f4")
    frames[..., :3] = MILLIMETERS_PER_METER * np.nan_to_num(tracks.positions)
    frames[..., 3] = np.where(tracks.visible, 0.0, -1.0)
    frames[~tracks.visible, :3] = 0.0
    with write_atomically(path) as part, part.open("wb") as file:
        file.write(_header(tracks, first_data_block).ljust(BLOCK_BYTES, b"\0"))
        file.write(parameters.ljust(BLOCK_BYTES * n_blocks, b"\0"))
        file.write(frames.tobytes())
        file.write(b"\0" * (-frames.nbytes % BLOCK_BYTES))
    progress(1.0, "Writing")


def _header(tracks: Tracks, first_data_block: int) -> bytes:
    last = min(tracks.n_frames, MAX_COUNT)
    return struct.pack(
        "<BBHHHHHfHHf",
        2, C3D_ID, tracks.n_points, 0, 1, last, 0, -1.0, first_data_block, 0, tracks.frame_rate,
    )  # fmt: skip


def _parameters(tracks: Tracks, first_data_block: int) -> bytes:
    """Return the groups and parameters, without the four bytes before them."""
    n_frames = tracks.n_frames
    parts = [
        _group(1, "POINT"),
        _integers(1, "USED", [tracks.n_points]),
        _floats(1, "SCALE", [-1.0]),
        _floats(1, "RATE", [tracks.frame_rate]),
        _integers(1, "DATA_START", [first_data_block]),
        _integers(1, "FRAMES", [min(n_frames, MAX_COUNT)]),
        _floats(1, "LONG_FRAMES", [n_frames]),
        _texts(1, "UNITS", ["mm"]),
        _texts(1, "X_SCREEN", ["+X"]),
        _texts(1, "Y_SCREEN", ["+Z"]),
    ]
    for start in range(0, tracks.n_points, LABELS_AT_ONCE):
        number = str(start // LABELS_AT_ONCE + 1) if start else ""
        labels = tracks.names[start : start + LABELS_AT_ONCE]
        parts += [
            _texts(1, f"LABELS{number}", labels),
            _texts(1, f"DESCRIPTIONS{number}", labels),
        ]
    parts += [
        _group(2, "ANALOG"),
        _integers(2, "USED", [0]),
        _group(3, "TRIAL"),
        _integers(3, "ACTUAL_START_FIELD", [1, 0]),
        _integers(3, "ACTUAL_END_FIELD", [n_frames % 65536, n_frames // 65536]),
    ]
    return b"".join(parts) + b"\0\0"


def _group(number: int, name: str) -> bytes:
    return struct.pack("<bb", len(name), -number) + name.encode() + _next(b"\0")


def _integers(group: int, name: str, values: Sequence[int]) -> bytes:
    data = struct.pack(f"<{len(values)}H", *values)
    return _parameter(group, name, INTEGERS, [len(values)] if len(values) > 1 else [], data)


def _floats(group: int, name: str, values: Sequence[float]) -> bytes:
    return _parameter(group, name, FLOATS, [], struct.pack(f"<{len(values)}f", *values))


def _texts(group: int, name: str, texts: Sequence[str]) -> bytes:
    coded = [text.encode("latin-1", "replace")[:MAX_TEXT_BYTES] for text in texts]
    length = max(len(text) for text in coded)
    data = b"".join(text.ljust(length) for text in coded)
    return _parameter(group, name, CHARACTERS, [length, len(coded)], data)


def _parameter(group: int, name: str, kind: int, sizes: Sequence[int], data: bytes) -> bytes:
    value = struct.pack("<bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
    return struct.pack("<bb", len(name), group) + name.encode() + _next(value)


def _next(rest: bytes) -> bytes:
    """Prefix the rest of an entry with the offset of the next one."""
    return struct.pack("<H", 2 + len(rest)) + rest
