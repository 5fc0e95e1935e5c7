"""Files that were read last, kept so that the redo panel need not read them again."""

from pathlib import Path

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import InvalidFileError
from ...solvers.motion import JointRecording, Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import Body
from ...solvers.recordings.skeleton_files import find_skeleton
from .solve_reading import Conversion, ReadRecording, read_takes

MOST = 20_000_000  # numbers that are kept

State = tuple[tuple[str, int, int], ...]
_read: dict[tuple[State, float | None, str], list[ReadRecording]] = {}


def read_again(
    path: Path, conversion: Conversion, progress: Progress = unwatched
) -> list[ReadRecording]:
    """Return the takes of a file, as `read_takes` does; an unchanged file is read once.

    Recordings of depth are opened anew: little is read for that.
    """
    state = state_of(path)
    key = state, conversion.unit, conversion.body
    takes = _read.pop(key, None) or read_takes(path, conversion, progress)
    remember(path, state, takes, conversion)
    return takes


def bodies_of(path: Path) -> tuple[Body, ...]:
    """Return the bodies to choose from in a file that was read last; else nothing."""
    state = state_of(path)
    known = [takes for (its_state, _, _), takes in _read.items() if its_state == state]
    return known[-1][0].bodies if state and known else ()


def remember(
    path: Path, state: State, takes: list[ReadRecording], conversion: Conversion
) -> None:
    """Keep what was read from a file in this state, unless it has changed since."""
    if any(isinstance(take.recording, DepthRecording) for take in takes):
        return
    if state and state == state_of(path):
        _read[state, conversion.unit, conversion.body] = takes
    while sum(_size(take) for takes in _read.values() for take in takes) > MOST:
        _read.pop(next(iter(_read)))


def state_of(path: Path) -> State:
    """When and how long the file, and the skeleton that it needs, were written last."""
    try:
        needed = [path, find_skeleton(path)] if path.suffix.lower() == ".amc" else [path]
        states = [(each, each.stat()) for each in needed]
    except (OSError, InvalidFileError):  # the reader reports it
        return ()
    return tuple((str(each), state.st_mtime_ns, state.st_size) for each, state in states)


def _size(take: ReadRecording) -> int:
    recording = take.recording
    others = sum(other.motion.rotations.size for other in take.others)
    if isinstance(recording, DepthRecording):
        return 0  # never kept
    if isinstance(recording, Motion):
        return recording.rotations.size + others
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.positions.size
