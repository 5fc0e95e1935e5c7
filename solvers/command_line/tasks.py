"""Assign an output to each input, and check both before any work."""

import argparse
import re
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
    bodies_in,
    check_name_length,
    check_target,
    find_recordings,
    output_extension,
    unique_targets,
    with_body,
)
from .report import PICTURE
from .verb import OutputKind, Task, Verb

MAX_NAME_LETTERS = 40
"""Letters of the name of a body in the name of a file."""


def tasks_of(verb: Verb, arguments: argparse.Namespace) -> list[Task]:
    """Return the tasks in the order of the command line.

    Raises
    ------
    InvalidSettingError
        An input would be overwritten, or two outputs would have the same path.
    InvalidFileError
        An output cannot be written.
    """
    files: list[Path] = arguments.files
    if verb.makes is OutputKind.WORDS:
        return [
            Task((path,), None, of_body)
            for path, _ in find_recordings(files)
            for of_body, _ in _bodies(path, arguments)
        ]
    if verb.makes in {OutputKind.LIBRARY, OutputKind.MATCHES}:
        return [_task_with_library(verb.makes, files, arguments)]
    if verb.makes is OutputKind.MANY_FILES:
        if arguments.output.exists() and not arguments.output.is_dir():
            raise InvalidSettingError(
                f"{arguments.output} is a file; name a folder to write to."
            )
        sources = tuple(path for path, _ in find_recordings(files, excluded=arguments.output))
        return [Task(sources, arguments.output, arguments)]
    if verb.makes is OutputKind.ONE_FILE:
        sources = tuple(path for path, _ in find_recordings(files))
        _check_overwriting(sources, [arguments.output])
        check_target(arguments.output, LEARNED)
        return [Task(sources, arguments.output, arguments)]
    return _file_tasks(verb, arguments)


def _task_with_library(
    makes: OutputKind, files: Sequence[Path], arguments: argparse.Namespace
) -> Task:
    if makes is OutputKind.LIBRARY:
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
    """Return one task for each input file."""
    files: list[Path] = arguments.files
    folder: Path | None = arguments.output_folder
    if folder is None:
        if len(files) != 2:
            raise InvalidSettingError(
                f"{len(files)} files are named: name one to read and one to write, or name"
                " a folder for the results with --output-folder DIR."
            )
        source, target = files
        _check_overwriting([source], [target])
        check_target(target, _allowed_extensions(verb))
        return [
            Task((source,), target.with_stem(target.stem + ending), of_body)
            for of_body, ending in _bodies(source, arguments)
        ]
    if folder.exists() and not folder.is_dir():
        raise InvalidSettingError(f"{folder} is a file; name a folder to write to.")
    found = [
        (path, below.with_stem(below.stem + ending), of_body)
        for path, below in find_recordings(files, folder, verb.list_recordings)
        for of_body, ending in _bodies(path, arguments)
    ]
    sources = [path for path, _, _ in found]
    extensions = [_extension(verb, path, arguments) for path in sources]
    targets = [
        folder / path for path in unique_targets([path for _, path, _ in found], extensions)
    ]
    _check_overwriting(sources, targets)
    folder.mkdir(parents=True, exist_ok=True)
    return [
        Task(
            (source,),
            target,
            of_body,
            _prepare_failure(source, target, _allowed_extensions(verb)),
        )
        for (source, _, of_body), target in zip(found, targets, strict=True)
    ]


def _bodies(
    source: Path, arguments: argparse.Namespace
) -> list[tuple[argparse.Namespace, str]]:
    """Return the arguments for each chosen body of a file, and the ending of its output."""
    names = bodies_in(source, arguments) if getattr(arguments, "body", None) else []
    if len(names) < 2:
        return [(arguments, "")]
    return [(with_body(arguments, name), f"_{_file_name(name)}") for name in names]


def _file_name(name: str) -> str:
    return re.sub(r"[^\w-]", "_", name)[:MAX_NAME_LETTERS]


def _prepare_failure(source: Path, target: Path, extensions: Mapping[str, str]) -> str:
    """Create the folder of a target; return why it cannot be written, or an empty text."""
    result = attempt(source, _prepare_target, target, extensions)
    return result.sentence if isinstance(result, Failure) else ""


def _prepare_target(target: Path, extensions: Mapping[str, str]) -> None:
    check_name_length(target, PICTURE)
    target.parent.mkdir(parents=True, exist_ok=True)
    check_target(target, extensions)


def _allowed_extensions(verb: Verb) -> Mapping[str, str]:
    if not verb.writes_motions:
        return RECORDED
    return FOR_MOTIONS | FOR_JOINTS if verb.writes_joints else FOR_MOTIONS


def _extension(verb: Verb, source: Path, arguments: argparse.Namespace) -> str:
    if verb.writes_joints and arguments.joints:
        return JOINTS
    return MOTIONS if verb.writes_motions else output_extension(source)


def _check_overwriting(sources: Sequence[Path], targets: Sequence[Path]) -> None:
    """Raise an error if an input would be overwritten, or a path written twice."""
    real_targets = [real_path(target) for target in targets]
    overwritten = [source for source in sources if real_path(source) in real_targets]
    if overwritten:
        raise InvalidSettingError(
            f"{overwritten[0]} would be overwritten. Recordings are never changed: choose"
            " another name or folder."
        )
    if len(set(real_targets)) < len(real_targets):
        duplicate = next(path for path in real_targets if real_targets.count(path) > 1)
        raise InvalidSettingError(
            f"Two inputs would both be written to {duplicate}. Rename one."
        )
