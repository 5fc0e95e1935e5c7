"""Solve of the button Import: read and convert recordings."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeVar

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import InvalidFileError, MocapAssistError, SolveCancelled
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
from ...solvers.recordings import DepthSettings, is_depth_recording, read_depth, read_tracked
from ...solvers.recordings.conventions import put_on_floor
from ...solvers.recordings.depth_files import DEFAULT_DEPTH_SETTINGS
from ..jobs.in_blender import BackgroundBlender, is_scene_file, read_blends

TrackedRecording = Motion | Tracks | JointRecording
"""Joints or markers over time."""
Recording = TrackedRecording | DepthRecording
Result = TypeVar("Result")


class Conversion(NamedTuple):
    """Conversion of recordings for the scene."""

    armature: bool = True
    """Whether connected joints of a camera become a skeleton's motion."""
    scale: float = 1.0
    frame_rate: float | None = None
    """Frames per second to resample to; None leaves each recording its own."""
    unit: float | None = None
    """Meters per unit of the files; None reads it from the file or estimates it."""
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS
    """Interpretation of depth images."""
    place_on_floor: bool = False
    """Whether the lowest foot is put at height 0."""
    blender: BackgroundBlender = BackgroundBlender("")
    """The Blender whose importers read FBX, glTF and USD."""


class ReadRecording(NamedTuple):
    """Content of a file, or of one of its takes."""

    recording: Recording
    warnings: tuple[str, ...] = ()
    """Warnings of its reader."""
    take: str = ""
    """Name of the take in a file with several."""


class Read(NamedTuple):
    """Content of a file or take, and its converted motion."""

    content: ReadRecording
    moving: Motion | Tracks | None
    """None for depth, which is read from its files."""


def read_files(
    paths: Sequence[Path], conversion: Conversion, *, progress: Progress = unwatched
) -> list[list[Read] | MocapAssistError]:
    """Return the takes of each file, or the error that prevents its import."""
    found: list[list[Read] | MocapAssistError] = []
    for path in paths:

        def file_progress(fraction: float, message: str = "", path: Path = path) -> None:
            progress((len(found) + fraction) / len(paths), f"Reading {path.name}")

        file_progress(0.0)
        try:
            takes = read_takes(path, conversion, file_progress)
            found.append([_convert(path, take, conversion) for take in takes])
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            found.append(error)
    return found


def _convert(path: Path, content: ReadRecording, conversion: Conversion) -> Read:
    moving = _attempt_read(path, lambda: convert_recording(content.recording, conversion))
    return Read(content, moving)


def read_takes(
    path: Path, conversion: Conversion, progress: Progress = unwatched
) -> list[ReadRecording]:
    """Return the takes of a file: several perhaps of FBX, glTF and USD, else one.

    Every failure becomes a MocapAssistError, so that other files are still read.
    """
    if not is_scene_file(path):
        return [read_file(path, progress, unit=conversion.unit, depth=conversion.depth)]
    (found,) = _attempt_read(
        path, lambda: read_blends(conversion.blender, [str(path)], progress=progress)
    )
    if not found.clips:
        raise InvalidFileError(
            found.refused[0] if found.refused else f"{path} has no animation of a skeleton."
        )
    several = len(found.clips) > 1
    return [
        ReadRecording(clip.motion, found.refused, clip.item if several else "")
        for clip in found.clips
    ]


def read_file(
    path: Path,
    progress: Progress = unwatched,
    *,
    unit: float | None = None,
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS,
) -> ReadRecording:
    """Read a file or folder like `read_recording`, and keep the warnings of its reader.

    `unit` is meters per unit of the file, `depth` the interpretation of depth images. Every
    failure becomes a MocapAssistError, so that other files are still read.
    """
    listener = _WarningCollector(progress)

    def read() -> Recording:
        if is_depth_recording(path):
            return read_depth(path, depth, progress=listener)
        return read_tracked(path, scale=unit, progress=listener)

    recording = _attempt_read(path, read)
    return ReadRecording(recording, tuple(listener.warnings))


def _attempt_read(path: Path, read: Callable[[], Result]) -> Result:
    found = attempt(path, read)
    if isinstance(found, Failure):
        raise found.as_error()
    return found


class _WarningCollector:
    """A Progress that collects the warnings of a reader."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.warnings: list[str] = []

    def __call__(self, fraction: float, message: str = "") -> None:
        if message not in {"", "Reading", *self.warnings}:
            self.warnings.append(message)
        self._progress(fraction, message)


def convert_recording(recording: Recording, conversion: Conversion) -> Motion | Tracks | None:
    """Convert a recording to a motion or points for the scene; None for depth."""
    if isinstance(recording, DepthRecording):
        return None
    return convert_tracked(recording, conversion)


def convert_tracked(recording: TrackedRecording, conversion: Conversion) -> Motion | Tracks:
    """Convert joints or markers to a motion or points for the scene."""
    moving = _scaled(_joined(recording, conversion.armature), conversion.scale)
    if conversion.place_on_floor and isinstance(moving, Motion):
        moving = put_on_floor(moving)
    if conversion.frame_rate is None:
        return moving
    if isinstance(moving, Motion):
        return resample(moving, conversion.frame_rate)
    return resample(moving, conversion.frame_rate)


def in_one_tree(recording: JointRecording) -> bool:
    """Whether the joints form one tree, so that they can become an armature."""
    parents = recording.parents
    return sum(parents[joint] < 0 for joint in connected_joints(recording)) == 1


def connected_joints(recording: JointRecording) -> list[int]:
    """Return the joints that have a parent or a child."""
    parents = recording.parents
    return [joint for joint, parent in enumerate(parents) if parent >= 0 or joint in parents]


def _joined(recording: TrackedRecording, armature: bool) -> Motion | Tracks:
    """Convert a camera's joints to a motion for an armature, otherwise to points."""
    if not isinstance(recording, JointRecording):
        return recording
    if armature and in_one_tree(recording):
        joints, tracks = connected_joints(recording), fill_missing_hips(recording).tracks
        names = tuple(tracks.names[joint] for joint in joints)
        body = Tracks(names, tracks.positions[:, joints], tracks.frame_rate)
        return motion_from_points(body, joint_parents(names))
    return recording.tracks


def _scaled(recording: Motion | Tracks, factor: float) -> Motion | Tracks:
    """Return the recording with all lengths scaled."""
    if factor == 1.0:
        return recording
    if isinstance(recording, Tracks):
        return recording.with_positions(factor * recording.positions)
    skeleton = recording.skeleton
    larger = Skeleton(skeleton.names, skeleton.parents, factor * skeleton.offsets)
    return replace(recording, skeleton=larger, root_positions=factor * recording.root_positions)
