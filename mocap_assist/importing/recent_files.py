"""Files that were read last, kept so that the redo panel need not read them again."""

from pathlib import Path

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import InvalidFileError
from ...solvers.motion import JointRecording, Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import Body, FloorPlacement, ReadingSettings
from ...solvers.recordings.skeleton_files import find_skeleton
from .solve_reading import Conversion, ReadRecording, read_takes

MAX_CACHED_NUMBERS = 20_000_000
"""Numbers in all cached recordings together, 160 MB; it bounds the memory."""
BYTES_PER_NUMBER = 8
"""Bytes of a number in double precision, by definition."""

State = tuple[tuple[str, int, int], ...]
Reading = tuple[ReadingSettings, FloorPlacement, str, bool]
_read: dict[tuple[State, Reading], list[ReadRecording]] = {}


def read_again(
    path: Path, conversion: Conversion, progress: Progress = unwatched
) -> list[ReadRecording]:
    """Return the takes of a file, as `read_takes` does; an unchanged file is read once.

    Depth recordings are opened again: little is read for that.
    """
    state, reading = state_of(path), reading_of(conversion)
    takes = _read.pop((state, reading), None) or read_takes(path, conversion, progress)
    store_read_file(path, state, takes, reading)
    return takes


def bodies_of(path: Path) -> tuple[Body, ...]:
    """Return the bodies to choose from in a recent file; empty for any other."""
    state = state_of(path)
    known = [takes for (its_state, _), takes in _read.items() if its_state == state]
    return known[-1][0].bodies if state and known else ()


def reading_of(conversion: Conversion) -> Reading:
    """Return the settings that affect how a file is read."""
    return conversion.reading, conversion.floor, conversion.body, conversion.meshes


def store_read_file(
    path: Path, state: State, takes: list[ReadRecording], reading: Reading
) -> None:
    """Keep what was read from a file in this state, unless it has changed since."""
    if any(isinstance(take.recording, DepthRecording) for take in takes):
        return
    if state and state == state_of(path):
        _read[state, reading] = takes
    while sum(_size(take) for takes in _read.values() for take in takes) > MAX_CACHED_NUMBERS:
        _read.pop(next(iter(_read)))


def state_of(path: Path) -> State:
    """Date and size of the file, and of the skeleton file that it needs."""
    try:
        needed = [path, find_skeleton(path)] if path.suffix.lower() == ".amc" else [path]
        states = [(each, each.stat()) for each in needed]
    except (OSError, InvalidFileError):  # the reader reports it
        return ()
    return tuple((str(each), state.st_mtime_ns, state.st_size) for each, state in states)


def _size(take: ReadRecording) -> int:
    recording = take.recording
    others = sum(other.motion.rotations.size for other in take.others)
    others += len(take.meshes.content) // BYTES_PER_NUMBER if take.meshes else 0
    if isinstance(recording, DepthRecording):
        return 0  # never kept
    if isinstance(recording, Motion):
        return recording.rotations.size + others
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.positions.size
