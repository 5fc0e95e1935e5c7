"""Files that were read last, kept so that the redo panel need not read them again."""

from pathlib import Path

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import InvalidFileError
from ...solvers.motion import JointRecording, Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import DepthSettings
from ...solvers.recordings.depth_files import DEFAULT_DEPTH_SETTINGS
from ...solvers.recordings.skeleton_files import find_skeleton
from .solve_reading import ReadRecording, Recording, read_file

MOST = 20_000_000  # numbers that are kept

State = tuple[tuple[str, int, int], ...]
_read: dict[tuple[State, float | None], ReadRecording] = {}


def read_again(
    path: Path,
    progress: Progress = unwatched,
    *,
    unit: float | None = None,
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS,
) -> ReadRecording:
    """Return what a file holds, as `read_file` does; what has not changed is read once.

    Recordings of depth are opened anew: little is read for that.
    """
    state = state_of(path)
    known = _read.pop((state, unit), None) or read_file(path, progress, unit=unit, depth=depth)
    remember(path, state, known, unit)
    return known


def remember(path: Path, state: State, known: ReadRecording, unit: float | None) -> None:
    """Keep what was read from a file in this state and unit, unless it has changed since."""
    if isinstance(known.recording, DepthRecording):
        return
    if state and state == state_of(path):
        _read[state, unit] = known
    while sum(_size(known.recording) for known in _read.values()) > MOST:
        _read.pop(next(iter(_read)))


def state_of(path: Path) -> State:
    """When and how long the file, and the skeleton that it needs, were written last."""
    try:
        needed = [path, find_skeleton(path)] if path.suffix.lower() == ".amc" else [path]
        states = [(each, each.stat()) for each in needed]
    except (OSError, InvalidFileError):  # the reader reports it
        return ()
    return tuple((str(each), state.st_mtime_ns, state.st_size) for each, state in states)


def _size(recording: Recording) -> int:
    if isinstance(recording, DepthRecording):
        return 0  # never kept
    if isinstance(recording, Motion):
        return recording.rotations.size
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return tracks.positions.size
