"""Recordings in and out, as the command line names them."""

import argparse
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ..errors import InvalidFileError
from ..faults import Failure, attempt
from ..files import real_path
from ..motion import Motion, Tracks
from ..progress import Progress, within
from ..recordings import (
    format_of,
    read_motion_or_tracks,
    recordings_in,
    write_bvh,
    write_c3d,
    write_trc,
)
from ..recordings.containers import is_folder, shown

MOTIONS = ".bvh"
POINTS = {".c3d": write_c3d, ".trc": write_trc}
FOR_MOTIONS = {MOTIONS: "a skeleton's motion"}
JOINTS = ".csv"
FOR_JOINTS = {JOINTS: "joints"}
RECORDED = {**FOR_MOTIONS, **dict.fromkeys(POINTS, "points")}
"""Endings of recordings that can be written, and what each is for."""
POINTS_BY_DEFAULT = ".trc"
LONGEST_NAME = 255
"""Bytes in the name of a file; on Windows, units of two bytes."""
LEARNED = {".npz": "learned patterns"}


def add_reading_options(parser: argparse.ArgumentParser) -> None:
    """Add what a file may leave open."""
    parser.add_argument(
        "--scale",
        type=float,
        metavar="X",
        help="Metres in one unit of the files that are read [default: as the file says, or"
        " guessed from the size of the body]",
    )


def read(path: Path, arguments: argparse.Namespace, progress: Progress) -> Motion | Tracks:
    """Read a recording with the options of `add_reading_options`."""
    return read_motion_or_tracks(path, scale=arguments.scale, progress=progress)


def found_in(
    paths: Sequence[Path],
    not_in: Path | None = None,
    look: Callable[[Path], list[Path]] = recordings_in,
) -> list[tuple[Path, Path]]:
    """Return every file, and in place of a folder the recordings in it and below.

    Parameters
    ----------
    paths : sequence of Path
    not_in : Path, optional
        A folder that is passed over: the one to write to.
    look : callable
        Returns the recordings in a folder; the folder itself, if it is one.

    Returns
    -------
    list of (Path, Path)
        The file, and its place within the folder that was named; where other places are named
        too, with the folder's own name.

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
        whole = real_path(path)
        inside = [(file, whole / file.relative_to(path)) for file in look(path)]
        if not_in is not None:
            inside = [each for each in inside if real_path(not_in) not in each[1].parents]
        if not inside:
            raise InvalidFileError(f"There is no recording in the folder {path}.")
        alone = len(paths) == 1 and inside != [(path, whole)]
        above = whole if alone else whole.parent
        found += [(file, place.relative_to(above)) for file, place in inside]
    return found


def read_all(
    paths: Sequence[Path], arguments: argparse.Namespace, progress: Progress
) -> list[Motion | Tracks]:
    """Read recordings, and all in folders, with the options of `add_reading_options`."""
    paths = [path for path, _ in found_in(paths)]
    share = 1.0 / len(paths)
    return [
        read(path, arguments, within(progress, share * number, share * (number + 1)))
        for number, path in enumerate(paths)
    ]


def write(recording: Motion | Tracks, path: Path | None, progress: Progress) -> None:
    """Write a recording in the format that the name's ending stands for."""
    ending = path.suffix.lower() if path else ""
    if isinstance(recording, Motion) and path and ending == MOTIONS:
        write_bvh(recording, path, progress=progress)
    elif isinstance(recording, Tracks) and path and ending in POINTS:
        POINTS[ending](recording, path, progress=progress)
    else:
        kind, fit, else_ = ("A skeleton's motion", MOTIONS, "")
        if isinstance(recording, Tracks):
            kind, fit = ("Points without a skeleton", " or ".join(POINTS))
            else_ = ", or make a skeleton of labelled markers with the verb solve"
        raise InvalidFileError(
            f"{kind} cannot be written as {path}; end the name in {fit}{else_}."
        )


def refuse_target(path: Path, endings: Mapping[str, str] = RECORDED) -> None:
    """Raise InvalidFileError where nothing could be written, before any work is done."""
    refuse_long_name(path)
    if path.suffix.lower() not in endings:
        allowed = " or ".join(f"{ending} ({kind})" for ending, kind in endings.items())
        raise InvalidFileError(f"{path} cannot be written; end the name in {allowed}.")
    if path.is_dir() or not path.parent.is_dir():
        raise InvalidFileError(
            f"{path} cannot be written: "
            + ("it is a folder." if path.is_dir() else f"there is no folder {path.parent}.")
        )


def refuse_long_name(path: Path, ending: str = "") -> None:
    """Raise InvalidFileError where a file of this name and ending could not be made.

    Temporary names are shorter: `write_atomically` keeps 40 letters of the name.
    """
    name = path.name + ending
    windows = os.name == "nt"
    length = (
        len(name.encode("utf-16-le", "surrogatepass")) // 2
        if windows
        else len(os.fsencode(name))
    )
    if length > LONGEST_NAME:
        raise InvalidFileError(
            f"The output {shown(path.name)} needs a name of {length} bytes, but {LONGEST_NAME}"
            " is the maximum. Shorten the name of the recording."
        )


def told_apart(places: Sequence[Path], ending_of: Sequence[str]) -> list[Path]:
    """Return places with other endings; those that would be the same keep theirs before it."""
    wanted = [
        place.with_suffix(ending) for place, ending in zip(places, ending_of, strict=True)
    ]
    return [
        place.with_name(place.name + ending) if wanted.count(target) > 1 else target
        for place, ending, target in zip(places, ending_of, wanted, strict=True)
    ]


def ending_for(source: Path) -> str:
    """Return the ending of what is made from a file: its own, or one that fits it."""
    ending = source.suffix.lower()
    if ending in RECORDED:
        return ending
    known = attempt(source, format_of, source)
    if known is None or isinstance(known, Failure):  # Whoever reads it will say why.
        return MOTIONS
    return MOTIONS if known.has_skeleton else POINTS_BY_DEFAULT
