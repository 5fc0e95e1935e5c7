"""What the button Import has done for it before anything comes into the scene."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeVar

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import MocapAssistError, SolveCancelled
from ...solvers.faults import Failure, attempt
from ...solvers.motion import (
    JointRecording,
    Motion,
    Skeleton,
    Tracks,
    joint_parents,
    motion_from_points,
    resample,
)
from ...solvers.motion.humanoid import fill_missing_hips
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import DepthSettings, is_depth, read_depth, read_tracked
from ...solvers.recordings.depth_files import DEFAULT_DEPTH_SETTINGS

Pointwise = Motion | Tracks | JointRecording
"""What is known joint by joint, or marker by marker."""
Recording = Pointwise | DepthRecording
Result = TypeVar("Result")


class Wanted(NamedTuple):
    """How recordings come into the scene."""

    armature: bool
    """Whether joints of a camera become a skeleton's motion, where they hang together."""
    scale: float
    frame_rate: float | None
    """Frames per second to resample to; None leaves each recording its own."""
    unit: float | None = None
    """Metres in one unit of the files; None for what they say, or their readers guess."""
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS
    """How pictures of depth are to be understood."""


class Known(NamedTuple):
    """What a file holds."""

    recording: Recording
    warnings: tuple[str, ...] = ()
    """What its reader said of it."""


class Read(NamedTuple):
    """What a file holds, and what is to be seen of it."""

    recording: Recording
    moving: Motion | Tracks | None
    """None for depth, which is read from its files."""
    warnings: tuple[str, ...] = ()
    """What its reader said of it."""


def read_files(
    paths: Sequence[Path], wanted: Wanted, *, progress: Progress = unwatched
) -> list[Read | MocapAssistError]:
    """Return what each file holds, or the error that says why it cannot come in."""
    found: list[Read | MocapAssistError] = []
    for path in paths:

        def share(fraction: float, message: str = "", path: Path = path) -> None:
            progress((len(found) + fraction) / len(paths), f"Reading {path.name}")

        share(0.0)
        try:
            known = read_file(path, share, unit=wanted.unit, depth=wanted.depth)
            moving = _tried(path, partial(as_wanted, known.recording, wanted))
            found.append(Read(known.recording, moving, known.warnings))
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            found.append(error)
    return found


def read_file(
    path: Path,
    progress: Progress = unwatched,
    *,
    unit: float | None = None,
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS,
) -> Known:
    """Read a file or folder, as `read_recording` does, and keep what its reader says.

    `unit` is its metres in one unit of the file, `depth` how pictures of depth are understood.

    Whatever goes wrong is a MocapAssistError, so that other files are read all the same.
    """
    listener = _Listener(progress)

    def read() -> Recording:
        if is_depth(path):
            return read_depth(path, depth, progress=listener)
        return read_tracked(path, scale=unit, progress=listener)

    recording = _tried(path, read)
    return Known(recording, tuple(listener.warnings))


def _tried(path: Path, read: Callable[[], Result]) -> Result:
    found = attempt(path, read)
    if isinstance(found, Failure):
        raise found.as_error()
    return found


class _Listener:
    """A Progress that keeps what a reader says beyond that it reads."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.warnings: list[str] = []

    def __call__(self, fraction: float, message: str = "") -> None:
        if message not in {"", "Reading", *self.warnings}:
            self.warnings.append(message)
        self._progress(fraction, message)


def as_wanted(recording: Recording, wanted: Wanted) -> Motion | Tracks | None:
    """Turn a recording into what moves as it does in the scene; None for depth."""
    return None if isinstance(recording, DepthRecording) else moved(recording, wanted)


def moved(recording: Pointwise, wanted: Wanted) -> Motion | Tracks:
    """Turn joints or markers into what moves as they do in the scene."""
    moving = _scaled(_joined(recording, wanted.armature), wanted.scale)
    if wanted.frame_rate is None:
        return moving
    if isinstance(moving, Motion):
        return resample(moving, wanted.frame_rate)
    return resample(moving, wanted.frame_rate)


def in_one_tree(recording: JointRecording) -> bool:
    """Whether it is known which joint hangs on which, so that they can become an armature."""
    parents = recording.parents
    return sum(parents[joint] < 0 for joint in hanging(recording)) == 1


def hanging(recording: JointRecording) -> list[int]:
    """Return the joints that hang on another, or that others hang on."""
    parents = recording.parents
    return [joint for joint, parent in enumerate(parents) if parent >= 0 or joint in parents]


def _joined(recording: Pointwise, armature: bool) -> Motion | Tracks:
    """Turn the joints of a camera into a motion, where an armature is wanted and they hang
    together; into points otherwise.
    """
    if not isinstance(recording, JointRecording):
        return recording
    if armature and in_one_tree(recording):
        kept, tracks = hanging(recording), fill_missing_hips(recording).tracks
        names = tuple(tracks.names[joint] for joint in kept)
        body = Tracks(names, tracks.positions[:, kept], tracks.frame_rate)
        return motion_from_points(body, joint_parents(names))
    return recording.tracks


def _scaled(recording: Motion | Tracks, factor: float) -> Motion | Tracks:
    """Return the recording with all lengths so many times as long."""
    if factor == 1.0:
        return recording
    if isinstance(recording, Tracks):
        return recording.with_positions(factor * recording.positions)
    skeleton = recording.skeleton
    larger = Skeleton(skeleton.names, skeleton.parents, factor * skeleton.offsets)
    return replace(recording, skeleton=larger, root_positions=factor * recording.root_positions)
