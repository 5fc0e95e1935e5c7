"""Solve of the button Import: read and convert recordings."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeVar, cast

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
from ...solvers.progress import Progress, Remark, collect_remarks, unwatched
from ...solvers.recordings import (
    DEFAULT_READING,
    Body,
    DepthSettings,
    FloorPlacement,
    ReadingSettings,
    is_depth_recording,
    is_scene_file,
    open_as,
    questions_of,
    read_depth,
    settle,
)
from ...solvers.recordings.conventions import (
    conventions_of,
    describe_guesses,
    describe_lying,
    with_conventions,
)
from ...solvers.recordings.depth_files import DEFAULT_DEPTH_SETTINGS
from ..jobs.in_blender import BackgroundBlender, BlendRead, SkinnedMeshes
from .solve_bodies import (
    SkeletonAction,
    bodies_of_scene,
    choice_in_scene,
    describe_left_out,
)
from .solve_scenes import read_scenes

TrackedRecording = Motion | Tracks | JointRecording
"""Joints or markers over time."""
Recording = TrackedRecording | DepthRecording
Result = TypeVar("Result")
Moving = TypeVar("Moving", bound=Motion | Tracks)


class Conversion(NamedTuple):
    """Conversion of recordings for the scene."""

    armature: bool = True
    """Whether connected joints of a camera become a skeleton's motion."""
    scale: float = 1.0
    frame_rate: float | None = None
    """Frames per second to resample to; None leaves each recording its own."""
    reading: ReadingSettings = DEFAULT_READING
    """Conventions that the files may not state."""
    depth: DepthSettings = DEFAULT_DEPTH_SETTINGS
    """Interpretation of depth images."""
    floor: FloorPlacement = FloorPlacement.NEVER
    """Whether takes are put on the floor."""
    meshes: bool = False
    """Whether skinned meshes are read too."""
    body: str = ""
    """Bodies to read of a file with several; empty for the default (`Bodies.choose`)."""
    blender: BackgroundBlender = BackgroundBlender("")
    """The Blender whose importers read FBX, glTF and USD."""


class ReadRecording(NamedTuple):
    """Content of a file, or one of its bodies."""

    recording: Recording
    warnings: tuple[str, ...] = ()
    """Warnings of its reader."""
    take: str = ""
    """Name of the recording in a file with several takes."""
    body: str = ""
    """Name in a file with several bodies."""
    others: tuple[SkeletonAction, ...] = ()
    """Further takes of the same skeleton."""
    bodies: tuple[Body, ...] = ()
    """Bodies to choose from in its file."""
    meshes: SkinnedMeshes | None = None
    """Skinned meshes of the file."""
    armature: str = ""
    """Name in the file of what deforms them."""


class Read(NamedTuple):
    """Content of a file or body, and its converted motion."""

    content: ReadRecording
    moving: Motion | Tracks | None
    """None for depth, which is read from its files."""


def read_files(
    paths: Sequence[Path], conversion: Conversion, *, progress: Progress = unwatched
) -> list[list[Read] | MocapAssistError]:
    """Return the bodies of each file, or the error that prevents its import."""
    found: list[list[Read] | MocapAssistError] = []
    scenes = [path for path in paths if is_scene_file(path)]
    opened = dict(zip(scenes, _read_scenes(scenes, conversion, progress), strict=True))
    for path in paths:

        def file_progress(fraction: float, message: str = "", path: Path = path) -> None:
            progress((len(found) + fraction) / len(paths), f"Reading {path.name}")

        file_progress(0.0)
        try:
            takes = read_takes(path, conversion, file_progress, opened.get(path))
            found.append([_convert(path, take, conversion) for take in takes])
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            found.append(error)
    return found


def _convert(path: Path, content: ReadRecording, conversion: Conversion) -> Read:
    moving = _attempt_read(path, lambda: convert_recording(content.recording, conversion))
    return Read(content, moving)


def convert_takes(
    takes: Sequence[SkeletonAction], conversion: Conversion
) -> tuple[SkeletonAction, ...]:
    """Convert the further takes of a skeleton for the scene."""
    return tuple(
        replace(take, motion=motion)
        for take in takes
        if isinstance(motion := convert_tracked(take.motion, conversion), Motion)
    )


def read_takes(
    path: Path,
    conversion: Conversion,
    progress: Progress = unwatched,
    found: BlendRead | MocapAssistError | None = None,
) -> list[ReadRecording]:
    """Return the chosen bodies of a file; of FBX, glTF and USD each with all its takes.

    Every failure becomes a MocapAssistError, so that other files are still read. `found` is
    the content of an FBX, glTF or USD file, if it was read already.
    """
    if not is_scene_file(path):
        return _read_bodies(path, conversion, progress)
    if found is None:
        (found,) = _read_scenes([path], conversion, progress)
    if isinstance(found, MocapAssistError):
        raise found
    bodies = bodies_of_scene(str(path), found)
    offered = tuple(bodies.listed[each] for each in bodies.offered)
    chosen = choice_in_scene(conversion.body, bodies)
    contents: list[ReadRecording] = []
    for index in chosen:
        first, *others = (
            replace(take, motion=_settle_scene_take(take.motion, conversion))
            for take in bodies.read(index, unwatched)
        )
        take = first.name if others else ""
        name = bodies.listed[index].name if len(bodies.listed) > 1 else ""
        motions = [take.motion for take in (first, *others)]
        warnings = (
            *(() if contents else found.refused),
            *describe_guesses(first.motion),
            *([] if conversion.reading.up.axis else describe_lying(motions)),
            *questions_of(first.motion, conversion.floor),
            *describe_left_out([take.left_out for take in (first, *others)]),
        )
        more = tuple(others), offered, found.meshes, first.armature
        contents.append(ReadRecording(first.motion, warnings, take, name, *more))
    return contents


def _read_scenes(
    paths: Sequence[Path], conversion: Conversion, progress: Progress
) -> list[BlendRead | MocapAssistError]:
    blender, meshes = conversion.blender, conversion.meshes
    return read_scenes(paths, blender, meshes=meshes, progress=progress)


def _read_bodies(path: Path, conversion: Conversion, progress: Progress) -> list[ReadRecording]:
    """Return the chosen bodies of a file that is read without Blender."""
    remarks: list[Remark] = []
    listener = collect_remarks(progress, remarks)

    def read() -> tuple[list[tuple[str, Recording]], tuple[Body, ...]]:
        if is_depth_recording(path):
            return [("", read_depth(path, conversion.depth, progress=listener))], ()
        bodies = open_as(path, conversion.reading, floor=conversion.floor, progress=listener)
        offered = tuple(bodies.listed[each] for each in bodies.offered)
        return [*bodies.read_chosen(conversion.body, listener)], offered

    found, offered = _attempt_read(path, read)
    return [
        ReadRecording(
            recording,
            tuple(remarks) if number == 0 else (),
            body=name if len(found) > 1 or conversion.body else "",
            bodies=offered,
        )
        for number, (name, recording) in enumerate(found)
    ]


def read_file(path: Path, conversion: Conversion) -> ReadRecording:
    """Read one body of a file or folder like `read_recording`."""
    return _read_bodies(path, conversion, unwatched)[0]


def _settle_scene_take(motion: Motion, conversion: Conversion) -> Motion:
    """Return a take of another program in the unit and axes of the settings."""
    reading, conventions = conversion.reading, conventions_of(motion)
    if unit := reading.unit.meters:
        motion = with_conventions(
            scaled_recording(motion, unit / conventions.unit),
            replace(conventions, unit=unit, is_unit_guessed=False),
        )
    return settle(motion, reading, conversion.floor)


def _attempt_read(path: Path, read: Callable[[], Result]) -> Result:
    found = attempt(path, read)
    if isinstance(found, Failure):
        raise found.as_error()
    return found


def convert_recording(recording: Recording, conversion: Conversion) -> Motion | Tracks | None:
    """Convert a recording to a motion or points for the scene; None for depth."""
    if isinstance(recording, DepthRecording):
        return None
    return convert_tracked(recording, conversion)


def convert_tracked(recording: TrackedRecording, conversion: Conversion) -> Motion | Tracks:
    """Convert joints or markers to a motion or points for the scene."""
    moving = scaled_recording(
        _motion_or_points(recording, conversion.armature), conversion.scale
    )
    return moving if conversion.frame_rate is None else at_rate(moving, conversion.frame_rate)


def at_rate(moving: Moving, frame_rate: float) -> Moving:
    """Return the recording with so many frames per second, in hertz."""
    return moving if moving.frame_rate == frame_rate else resample(moving, frame_rate)


def in_one_tree(recording: JointRecording) -> bool:
    """Whether the joints form one tree, so that they can become an armature."""
    parents = recording.parents
    return sum(parents[joint] < 0 for joint in connected_joints(recording)) == 1


def connected_joints(recording: JointRecording) -> list[int]:
    """Return the joints that have a parent or a child."""
    parents = recording.parents
    return [joint for joint, parent in enumerate(parents) if parent >= 0 or joint in parents]


def _motion_or_points(recording: TrackedRecording, armature: bool) -> Motion | Tracks:
    """Convert a camera's joints to a motion for an armature, otherwise to points."""
    if not isinstance(recording, JointRecording):
        return recording
    if armature and in_one_tree(recording):
        joints, tracks = connected_joints(recording), fill_missing_hips(recording).tracks
        names = tuple(tracks.names[joint] for joint in joints)
        body = Tracks(names, tracks.positions[:, joints], tracks.frame_rate)
        return motion_from_points(body, joint_parents(names))
    return recording.tracks


def scaled_recording(recording: Moving, factor: float) -> Moving:
    """Return the recording with all lengths scaled."""
    if factor == 1.0:
        return recording
    if isinstance(recording, Tracks):
        return cast(Moving, recording.with_positions(factor * recording.positions))
    skeleton = recording.skeleton
    larger = Skeleton(skeleton.names, skeleton.parents, factor * skeleton.offsets)
    positions = factor * recording.root_positions
    return cast(Moving, replace(recording, skeleton=larger, root_positions=positions))
