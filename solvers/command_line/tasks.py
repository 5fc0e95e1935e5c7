"""Which file is read, which is written: decided, and refused, before any work is done."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..errors import InvalidSettingError
from ..faults import Failure, attempt
from ..files import real_path
from .files import (
    FOR_JOINTS,
    FOR_MOTIONS,
    JOINTS,
    LEARNED,
    MOTIONS,
    RECORDED,
    ending_for,
    found_in,
    refuse_long_name,
    refuse_target,
    told_apart,
)
from .report import PICTURE
from .verb import Makes, Task, Verb


def tasks_of(verb: Verb, arguments: argparse.Namespace) -> list[Task]:
    """Return what is to be done, in the order of the command line.

    Raises
    ------
    InvalidSettingError
        A file would be written over, or two would be written to one place.
    InvalidFileError
        Something could not be written where it was asked for.
    """
    files: list[Path] = arguments.files
    if verb.makes is Makes.WORDS:
        return [Task((path,), None, arguments) for path, _ in found_in(files)]
    if verb.makes in {Makes.LIBRARY, Makes.MATCHES}:
        return [_task_with_library(verb.makes, files, arguments)]
    if verb.makes is Makes.MANY_FILES:
        if arguments.output.exists() and not arguments.output.is_dir():
            raise InvalidSettingError(
                f"{arguments.output} is a file; name a folder to write to."
            )
        sources = tuple(path for path, _ in found_in(files, not_in=arguments.output))
        return [Task(sources, arguments.output, arguments)]
    if verb.makes is Makes.ONE_FILE:
        sources = tuple(path for path, _ in found_in(files))
        _refuse_reading_and_writing(sources, [arguments.output])
        refuse_target(arguments.output, LEARNED)
        return [Task(sources, arguments.output, arguments)]
    return _file_tasks(verb, arguments)


def _task_with_library(
    makes: Makes, files: Sequence[Path], arguments: argparse.Namespace
) -> Task:
    if makes is Makes.LIBRARY:
        if len(files) < 2:
            raise InvalidSettingError(
                f"Only {files[0]} is named: name the library and then recordings, or folders"
                " of them."
            )
        return Task(tuple(files[1:]), files[0], arguments)
    if len(files) != 2:
        raise InvalidSettingError(
            f"Name the recording and then the library; the names are {len(files)}."
        )
    return Task(tuple(files), None, arguments)


def _file_tasks(verb: Verb, arguments: argparse.Namespace) -> list[Task]:
    """Return which file is written from which."""
    files: list[Path] = arguments.files
    folder: Path | None = arguments.output_folder
    if folder is None:
        if len(files) != 2:
            raise InvalidSettingError(
                f"{len(files)} files are named: name one to read and one to write, or say"
                " where to put many with --output-folder DIR."
            )
        source, target = files
        _refuse_reading_and_writing([source], [target])
        refuse_target(target, _endings(verb))
        return [Task((source,), target, arguments)]
    if folder.exists() and not folder.is_dir():
        raise InvalidSettingError(f"{folder} is a file; name a folder to write to.")
    found = found_in(files, folder, verb.look)
    sources = [path for path, _ in found]
    endings = [_ending(verb, path, arguments) for path in sources]
    targets = [folder / place for place in told_apart([place for _, place in found], endings)]
    _refuse_reading_and_writing(sources, targets)
    folder.mkdir(parents=True, exist_ok=True)
    return [
        Task((source,), target, arguments, _refusal(source, target, _endings(verb)))
        for source, target in zip(sources, targets, strict=True)
    ]


def _refusal(source: Path, target: Path, endings: Mapping[str, str]) -> str:
    """Make the folder of a target; return why it cannot be written, or nothing."""
    made = attempt(source, _make_room, target, endings)
    return made.sentence if isinstance(made, Failure) else ""


def _make_room(target: Path, endings: Mapping[str, str]) -> None:
    refuse_long_name(target, PICTURE)
    target.parent.mkdir(parents=True, exist_ok=True)
    refuse_target(target, endings)


def _endings(verb: Verb) -> Mapping[str, str]:
    if not verb.writes_motions:
        return RECORDED
    return FOR_MOTIONS | FOR_JOINTS if verb.writes_joints else FOR_MOTIONS


def _ending(verb: Verb, source: Path, arguments: argparse.Namespace) -> str:
    if verb.writes_joints and arguments.joints:
        return JOINTS
    return MOTIONS if verb.writes_motions else ending_for(source)


def _refuse_reading_and_writing(sources: Sequence[Path], targets: Sequence[Path]) -> None:
    """Refuse to write over what is read, or twice to one place."""
    places = [real_path(target) for target in targets]
    same = [source for source in sources if real_path(source) in places]
    if same:
        raise InvalidSettingError(
            f"{same[0]} would be written over. Recordings are never changed: choose another"
            " name or folder."
        )
    if len(set(places)) < len(places):
        twice = next(place for place in places if places.count(place) > 1)
        raise InvalidSettingError(f"Two inputs would both be written to {twice}. Rename one.")
