"""Read and write the recordings named on the command line."""

import argparse
import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from ...errors import InvalidFileError
from ...faults import Failure, attempt
from ...files import real_path
from ...motion import JointRecording, Motion, Tracks
from ...progress import Progress, within
from ...recordings import (
    FloorPlacement,
    FloorPlacementSettings,
    ReadingSettings,
    describe_no_recording,
    detect_format,
    is_scene_file,
    open_bodies,
    read_as,
    recordings_in,
    takes_in,
    write_bvh,
    write_c3d,
    write_trc,
)
from ...recordings.containers import files_below, is_folder, shown
from ...recordings.conventions import conventions_of, describe_placement
from .options import arguments_from, settings_from_arguments
from .verb_description import Outcome

MOTIONS = ".bvh"
POINTS = {".c3d": write_c3d, ".trc": write_trc}
FOR_MOTIONS = {MOTIONS: "a skeleton's motion"}
JOINTS = ".csv"
FOR_JOINTS = {JOINTS: "joints"}
RECORDED = {**FOR_MOTIONS, **dict.fromkeys(POINTS, "points")}
"""File extensions of recordings that can be written, and their content."""
POINTS_BY_DEFAULT = ".trc"
MAX_NAME_BYTES = 255
"""Bytes in the name of a file; on Windows, units of two bytes."""
LISTING_ALL = (recordings_in, takes_in)
"""Lists of recordings of any kind, which would have those of files that need Blender, too."""
LEARNED = {".npz": "learned patterns"}


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for properties that a file may not store."""
    parser.add_argument(
        "--scale",
        type=float,
        metavar="X",
        help="Meters per unit of the input files, instead of --unit [default: as stored in the"
        " file, or estimated from the size of the body]",
    )
    add_body_option(parser)
    arguments_from(parser, ReadingSettings)


def add_body_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for files with several bodies."""
    parser.add_argument(
        "--body",
        metavar="WHICH",
        help="Body to read from input files with several: its name or number, several with"
        " commas, or all [default: the person seen in most frames]",
    )


def bodies_in(path: Path, arguments: argparse.Namespace) -> list[str]:
    """Return the names of the bodies chosen in a file; one name, or empty, where it has one.

    Of a file that cannot be read it is what was given: the reader reports the reason.
    """
    given = arguments.body or ""
    if not given:
        return [given]
    bodies = attempt(path, open_bodies, path)
    if isinstance(bodies, Failure):
        return [given]
    chosen = attempt(path, bodies.choose, given)
    if isinstance(chosen, Failure) or not bodies.listed:
        return [given]
    return [bodies.listed[index].name for index in chosen]


def read(
    path: Path,
    arguments: argparse.Namespace,
    progress: Progress,
    floor: FloorPlacement = FloorPlacement.NEVER,
) -> Motion | Tracks:
    """Read a recording as `read_recorded` does; return the joints of a camera as points."""
    recording = read_recorded(path, arguments, progress, floor)
    return recording.tracks if isinstance(recording, JointRecording) else recording


def read_recorded(
    path: Path,
    arguments: argparse.Namespace,
    progress: Progress,
    floor: FloorPlacement = FloorPlacement.NEVER,
) -> Motion | Tracks | JointRecording:
    """Read a recording with the options of `add_reading_options`."""
    return read_as(
        path,
        settings_from_arguments(arguments, ReadingSettings),
        scale=arguments.scale,
        body=arguments.body,
        floor=floor,
        progress=progress,
    )


def read_on_floor(
    path: Path, arguments: argparse.Namespace, progress: Progress
) -> tuple[Motion | Tracks | JointRecording, tuple[str, ...]]:
    """Read a recording, placed as `FloorPlacementSettings` say, and report if it was placed."""
    floor = settings_from_arguments(arguments, FloorPlacementSettings).place_on_floor
    recording = read_recorded(path, arguments, progress, floor)
    placed = floor is not FloorPlacement.NEVER
    return recording, describe_placement(recording) if placed else ()


def find_recordings(
    paths: Sequence[Path],
    excluded: Path | None = None,
    list_recordings: Callable[[Path], list[Path]] = recordings_in,
) -> list[tuple[Path, Path]]:
    """Return the given files, and the recordings in and below the given folders.

    Parameters
    ----------
    paths : sequence of Path
    excluded : Path, optional
        A folder to skip: the output folder.
    list_recordings : callable
        Returns the recordings in a folder, or the folder itself if it is a recording.

    Returns
    -------
    list of (Path, Path)
        Each file and its path relative to the given folder. With several arguments, the
        relative path begins with the name of the folder.

    Raises
    ------
    InvalidFileError
        A folder has no recordings.
    """
    found = []
    for path in paths:
        if not is_folder(path):
            found.append((path, Path(path.name)))
            continue
        root = real_path(path)
        inside = [(file, root / file.relative_to(path)) for file in list_recordings(path)]
        if excluded is not None:
            inside = [each for each in inside if real_path(excluded) not in each[1].parents]
        if not inside:
            needing = scene_files_in(path, excluded) if list_recordings in LISTING_ALL else []
            raise InvalidFileError(describe_no_recording(path, needing))
        is_single = len(paths) == 1 and inside != [(path, root)]
        base = root if is_single else root.parent
        found += [(file, path.relative_to(base)) for file, path in inside]
    return found


def scene_files_in(folder: Path, excluded: Path | None = None) -> list[Path]:
    """Return the files in a folder and below, but for an excluded one, that need Blender."""
    outside = None if excluded is None else real_path(excluded)
    return [
        path
        for path in files_below(folder)
        if is_scene_file(path) and outside not in real_path(path).parents
    ]


def read_all(
    paths: Sequence[Path], arguments: argparse.Namespace, progress: Progress
) -> list[Motion | Tracks]:
    """Read recordings and folders of them with the options of `add_reading_options`.

    Of a file with several bodies, all that are chosen are read.
    """
    chosen = [
        (path, with_body(arguments, name))
        for path, _ in find_recordings(paths)
        for name in bodies_in(path, arguments)
    ]
    fraction = 1.0 / len(chosen)
    return [
        read(path, of_body, within(progress, fraction * number, fraction * (number + 1)))
        for number, (path, of_body) in enumerate(chosen)
    ]


def with_body(arguments: argparse.Namespace, body: str) -> argparse.Namespace:
    """Return a copy of the arguments that chooses another body; empty for the default."""
    return argparse.Namespace(**{**vars(arguments), "body": body or None})


def write(recording: Motion | Tracks, path: Path | None, progress: Progress) -> None:
    """Write a recording in the format of the file extension."""
    extension = path.suffix.lower() if path else ""
    if isinstance(recording, Motion) and path and extension == MOTIONS:
        write_bvh(recording, path, progress=progress)
    elif isinstance(recording, Tracks) and path and extension in POINTS:
        POINTS[extension](recording, path, progress=progress)
    else:
        kind, allowed, hint = ("A skeleton's motion", MOTIONS, "")
        if isinstance(recording, Tracks):
            kind, allowed = ("Points without a skeleton", " or ".join(POINTS))
            hint = ", or make a skeleton of labeled markers with the verb solve"
        raise InvalidFileError(
            f"{kind} cannot be written as {path}; end the name in {allowed}{hint}."
        )


def check_target(path: Path, extensions: Mapping[str, str] = RECORDED) -> None:
    """Raise InvalidFileError if the target cannot be written, before any work."""
    check_name_length(path)
    if path.suffix.lower() not in extensions:
        allowed = " or ".join(f"{extension} ({kind})" for extension, kind in extensions.items())
        raise InvalidFileError(f"{path} cannot be written; end the name in {allowed}.")
    if path.is_dir() or not path.parent.is_dir():
        raise InvalidFileError(
            f"{path} cannot be written: "
            + ("it is a folder." if path.is_dir() else f"there is no folder {path.parent}.")
        )


def check_name_length(path: Path, extension: str = "") -> None:
    """Raise InvalidFileError if the name with this extension is too long for a file.

    Temporary names are shorter: `write_atomically` keeps 40 letters of the name.
    """
    name = path.name + extension
    windows = os.name == "nt"
    length = (
        len(name.encode("utf-16-le", "surrogatepass")) // 2
        if windows
        else len(os.fsencode(name))
    )
    if length > MAX_NAME_BYTES:
        raise InvalidFileError(
            f"The output {shown(path.name)} needs a name of {length} bytes, but"
            f" {MAX_NAME_BYTES} is the maximum. Shorten the name of the recording."
        )


def unique_targets(paths: Sequence[Path], extensions: Sequence[str]) -> list[Path]:
    """Return paths with new extensions; equal results keep the old extension before the new."""
    wanted = [
        path.with_suffix(extension) for path, extension in zip(paths, extensions, strict=True)
    ]
    n_wanting = Counter(wanted)
    return [
        path.with_name(path.name + extension) if n_wanting[target] > 1 else target
        for path, extension, target in zip(paths, extensions, wanted, strict=True)
    ]


def output_extension(source: Path) -> str:
    """Return the extension of the output for a file: its own, or that of a similar format."""
    extension = source.suffix.lower()
    if extension in RECORDED:
        return extension
    format_found = attempt(source, detect_format, source)
    if format_found is None or isinstance(format_found, Failure):  # The reader reports why.
        return MOTIONS
    return MOTIONS if format_found.has_skeleton else POINTS_BY_DEFAULT


def convert(recording: Motion | Tracks, target: Path | None, progress: Progress) -> Outcome:
    """Write a recording in the format of the target's extension; return its outcome."""
    write(recording, target, progress)
    names = recording.skeleton.names if isinstance(recording, Motion) else recording.names
    kind = "joints" if isinstance(recording, Motion) else "points"
    conventions = conventions_of(recording)
    figures = {
        "n_frames": recording.n_frames,
        "frame_rate_hz": recording.frame_rate,
        kind: list(names),
        "conventions": asdict(conventions),
    }
    text = (
        f"{recording.n_frames} frames at {recording.frame_rate:g} Hz, {len(names)} {kind};"
        f" {conventions.sentence()}."
    )
    return Outcome(text, figures)
