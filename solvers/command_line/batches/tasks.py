"""Assign an output to each input, and check both before any work."""

import argparse
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import count
from pathlib import Path

from ...errors import InvalidFileError, InvalidSettingError
from ...faults import Failure, attempt
from ...files import is_missing, real_path
from ...recordings import recordings_in
from ..arguments import (
    FOR_JOINTS,
    FOR_MOTIONS,
    JOINTS,
    LEARNED,
    MOTIONS,
    RECORDED,
    OutputKind,
    Task,
    Verb,
    bodies_in,
    check_name_length,
    check_target,
    find_recordings,
    output_extension,
    unique_targets,
    with_body,
)
from ..sharing import Listed, Records, Shard, claimed, read_manifest
from .report import PICTURE
from .screen import Screen

MAX_NAME_LETTERS = 40
"""Letters of the name of a body in the name of a file."""
SHARING = ("manifest", "shard", "after", "wait", "cluster")
"""Options for batches."""


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
    if verb.makes is OutputKind.REPORT:
        return [Task((folder,), None, arguments) for folder in files]
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
    if len(files) < 2:
        raise InvalidSettingError(
            f"Only {files[0]} is named: name the recording and then one or more libraries."
        )
    return Task(tuple(files), None, arguments)


def _file_tasks(verb: Verb, arguments: argparse.Namespace) -> list[Task]:
    """Return one task for each input file."""
    folder: Path | None = arguments.output_folder
    if folder is None:
        return _tasks_without_folder(verb, arguments)
    if folder.exists() and not folder.is_dir():
        raise InvalidSettingError(f"{folder} is a file; name a folder to write to.")
    listed = find_inputs(arguments, folder, verb.work().list_recordings or recordings_in)
    found = [
        (each, of_body, ending)
        for each in listed
        for of_body, ending in _bodies(each.path, arguments)
    ]
    names = [_with_ending(each.output or each.name, ending) for each, _, ending in found]
    sources = [each.path for each, _, _ in found]
    extensions = [
        each.output.suffix if each.output else _extension(verb, each.path, arguments)
        for each, _, _ in found
    ]
    targets = [folder / path for path in unique_targets(names, extensions)]
    _check_overwriting(sources, targets)
    folder.mkdir(parents=True, exist_ok=True)
    return [
        Task(
            (each.path,),
            target,
            of_body,
            _prepare_failure(each.path, target, _allowed_extensions(verb)),
            _with_ending(each.name, ending).as_posix(),
        )
        for (each, of_body, ending), target in zip(found, targets, strict=True)
    ]


def _tasks_without_folder(verb: Verb, arguments: argparse.Namespace) -> list[Task]:
    files: list[Path] = arguments.files
    shared = [name for name in SHARING if getattr(arguments, name) is not None]
    if shared:
        raise InvalidSettingError(
            f"--{shared[0]} needs a folder: name it with --output-folder DIR."
        )
    if len(files) != 2:
        raise InvalidSettingError(
            f"{len(files)} file{' is' if len(files) == 1 else 's are'} named: name one to read"
            " and one to write, or name"
            " a folder for the results with --output-folder DIR."
        )
    source, target = files
    bodies = _bodies(source, arguments)
    targets = [_with_ending(target, ending) for _, ending in bodies]
    _check_overwriting([source], targets)
    for each in targets:
        check_target(each, _allowed_extensions(verb))
    return [
        Task((source,), each, of_body)
        for (of_body, _), each in zip(bodies, targets, strict=True)
    ]


def _with_ending(path: Path, ending: str) -> Path:
    return path.with_stem(path.stem + ending)


def find_inputs(
    arguments: argparse.Namespace,
    excluded: Path,
    list_recordings: Callable[[Path], list[Path]],
) -> list[Listed]:
    """Return the inputs of a batch: those on the command line, and those in its manifest.

    Raises
    ------
    InvalidFileError
        A folder has no recordings, or the manifest is invalid.
    InvalidSettingError
        There are no inputs, or one is named twice.
    """
    listed = [] if arguments.manifest is None else read_manifest(arguments.manifest)
    if not listed and not arguments.files:
        raise InvalidSettingError(
            "Name recordings to read, or folders of them, or a list of them with --manifest"
            " FILE."
        )
    found = [
        Listed(path, name, None)
        for path, name in find_recordings(arguments.files, excluded, list_recordings)
    ]
    for each in listed:
        inside = find_recordings([each.path], excluded, list_recordings)
        in_folder = inside != [(each.path, Path(each.path.name))]
        found += [
            Listed(path, each.name / below if in_folder else each.name, each.output)
            for path, below in inside
        ]
    twice = next((each.path for each, number in Counter(found).items() if number > 1), None)
    if twice is not None:
        raise InvalidSettingError(f"{twice} is named twice. Name it once.")
    return found


def note_pipe(arguments: argparse.Namespace, screen: Screen) -> None:
    """Say at a terminal that a manifest is a pipe, which may wait for its writer forever."""
    manifest: Path | None = getattr(arguments, "manifest", None)
    if manifest is not None and manifest.is_fifo():
        screen.note(f"Reading the manifest {manifest}, a pipe, until its writer closes it.")


def shared_tasks(
    tasks: Sequence[Task], arguments: argparse.Namespace, screen: Screen
) -> list[Task]:
    """Return the tasks of this machine's shard, and make their records possible.

    What the one record of an earlier version says becomes a record of each output.
    """
    records = Records(arguments.output_folder)
    records.prepare()
    records.remove_abandoned_parts()
    for former in records.former():
        with claimed(records.claim(former.output)) as claim:
            if not claim.holder and records.read(former.output) is None:
                records.write(former)
    shard: Shard | None = arguments.shard
    if shard is None:
        return [*tasks]
    own = [task for task in tasks if shard.has(task.name)]
    if not own:
        part = f"part {shard.number} of {shard.n_shards}"
        screen.write_line(f"No take is in {part}; takes in all parts: {len(tasks)}.")
    return own


def _bodies(
    source: Path, arguments: argparse.Namespace
) -> list[tuple[argparse.Namespace, str]]:
    """Return the arguments for each chosen body of a file, and the ending of its output."""
    names = bodies_in(source, arguments) if getattr(arguments, "body", None) else []
    if len(names) < 2:
        return [(arguments, "")]
    files = _file_names(names)
    return [
        (with_body(arguments, name), f"_{file}")
        for name, file in zip(names, files, strict=True)
    ]


def _file_names(names: Sequence[str]) -> list[str]:
    """Return what a file may be named after each body; equal ones get numbers."""
    made: list[str] = []
    taken: set[str] = set()
    for name in names:
        plain = re.sub(r"[^\w-]", "_", name)[:MAX_NAME_LETTERS]
        numbered = (plain if n == 1 else f"{plain}_{n}" for n in count(1))
        made.append(next(each for each in numbered if each.casefold() not in taken))
        taken.add(made[-1].casefold())
    return made


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
    real_targets = Counter(map(real_path, targets))
    overwritten = [source for source in sources if real_path(source) in real_targets]
    if overwritten:
        raise InvalidSettingError(
            f"{overwritten[0]} would be overwritten. Recordings are never changed: choose"
            " another name or folder."
        )
    duplicates = [path for path, n_sources in real_targets.items() if n_sources > 1]
    if duplicates:
        raise InvalidSettingError(
            f"Two inputs would both be written to {duplicates[0]}. Rename one."
        )


def check_output_folder(folder: Path) -> None:
    """Raise InvalidFileError if the output folder has vanished, such as with its share."""
    if is_missing(folder):
        raise InvalidFileError(
            f"The output folder {folder} is gone; the batch stops. Run it again to continue."
        )
