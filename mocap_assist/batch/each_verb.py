"""`each`: run a verb on many files, each in a Blender of its own, with one report."""

import argparse
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from threading import Event
from typing import Any

import bpy

from ...solvers.command_line.arguments import (
    Outcome,
    Task,
    add_sharing_options,
    check_name_length,
    unique_targets,
)
from ...solvers.command_line.batches import (
    PICTURE,
    FinishedTask,
    Screen,
    already_made,
    check_output_folder,
    find_inputs,
    has_called_hook,
    has_picture,
    made_record,
    note_other_builds,
    note_pipe,
    picture_file,
    remove_picture,
    shared_tasks,
    task_entries,
    until_released,
    verb_name,
    work_if_unclaimed,
    write_report,
)
from ...solvers.command_line.sharing import stamp_options
from ...solvers.errors import InvalidFileError, InvalidSettingError
from ...solvers.faults import Failure, attempt, escaped
from ...solvers.files import is_missing, make_folder, real_path
from ...solvers.json_text import parse_json
from ...solvers.processes import ScratchFolder
from ...solvers.recordings.containers import check_folder_access, files_below, is_folder
from ..importing.depth_folders import all_recordings_in, depth_recordings_in
from .each_child import OPTION, run_child

HELP = "Run another verb on each of many files: each FILE... --output-folder DIR -- VERB ..."
BLEND = ".blend"
IMPORT_VERBS = {"import": all_recordings_in, "capture": depth_recordings_in}
"""Verbs that import recordings, and their functions to list those in a folder."""
PACKAGE = __package__.removesuffix(".mocap_assist.batch")
MODULE_CHILD = """
import os, sys
import bpy
from addon_utils import enable
from importlib import import_module
package, file, *words = sys.argv[1:]
enable(package, default_set=True)
if file:
    bpy.ops.wm.open_mainfile(filepath=file)
else:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
status = import_module(f"{package}.mocap_assist.batch.command").run(words)
sys.stdout.flush()
sys.stderr.flush()
os._exit(status)
"""
"""Script for Blender as a Python module; it may hang at exit, hence _exit."""


def add_each_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `each`."""
    parser.add_argument(
        "files", nargs="*", type=Path, metavar="FILE",
        help=".blend files, or folders of them; for import and capture, recordings or folders"
        " of them",
    )  # fmt: skip
    parser.add_argument(
        "--output-folder", type=Path, required=True, metavar="DIR",
        help="folder for one .blend file per input; a second run resumes the first",
    )  # fmt: skip
    parser.add_argument("--again", action="store_true", help="redo existing results")
    parser.add_argument(
        "--jobs", type=int, default=1, metavar="N",
        help="number of Blender processes in parallel [default 1]",
    )  # fmt: skip
    parser.add_argument(
        "--report", action="store_true",
        help="write DIR/report.html and report.json about all files, with pictures",
    )  # fmt: skip
    add_sharing_options(parser)


def perform_each(arguments: argparse.Namespace, screen: Screen) -> None:
    """Start a Blender for each file, report, and raise InvalidFileError if any failed."""
    if not arguments.words:
        raise InvalidSettingError(
            "Give the verb for each file after --, for example: -- denoise."
        )
    opened = [bpy.data.filepath] if arguments.words[0] in IMPORT_VERBS else []
    arguments.depends_on = _named_files([*opened, *arguments.words])
    if arguments.jobs < 1:
        raise InvalidSettingError(f"jobs is {arguments.jobs}; it must be at least 1.")
    folder: Path = arguments.output_folder
    stamp_options(arguments)
    note_pipe(arguments, screen)
    every = _tasks(arguments)
    tasks = shared_tasks(every, arguments, screen)
    failed: list[str] = []
    faults: tuple[str, ...] = ()
    try:
        note_other_builds(tasks, screen)
        run_all = partial(_work_on_tasks, arguments=arguments, screen=screen)
        for finished in until_released(tasks, run_all, screen):
            sys.stdout.write(f"{_describe(finished)}\n")
            sys.stdout.flush()
            failed += finished.outcome.failures if finished.outcome else [finished.failure]
            check_output_folder(folder)
    finally:
        if arguments.report and not is_missing(folder):
            name = verb_name(every[0])
            faults = write_report(folder, name, lambda: task_entries(every))
    if failed:
        raise InvalidFileError(f"{len(failed)} of {len(tasks)} files failed. {failed[0]}")
    if faults:
        raise InvalidFileError(faults[0])


def _describe(finished: FinishedTask) -> str:
    """Return the line on a finished file; a failure names the file itself."""
    done = finished.outcome
    return escaped(f"{finished.task.source}: {done.text}" if done else finished.failure)


def _named_files(words: Sequence[str]) -> list[Path]:
    """Return the files that the result depends on, such as examples."""
    parts = [Path(part.strip()) for word in words for part in word.split(";")]
    return [path for path in parts if path.is_file()]


def _tasks(arguments: argparse.Namespace) -> list[Task]:
    """Return one task for each input file."""
    folder: Path = real_path(arguments.output_folder)
    list_recordings = IMPORT_VERBS.get(arguments.words[0])
    inputs = find_inputs(arguments, folder, list_recordings or _blends_in)
    targets = unique_targets(
        [each.output or each.name for each in inputs], [BLEND] * len(inputs)
    )
    tasks = []
    for each, relative_path in zip(inputs, targets, strict=True):
        source = each.path
        if list_recordings is None and not is_folder(source) and not _is_blend(source):
            raise InvalidSettingError(
                f"{source} is not a .blend file; only import and capture read others."
            )
        target = arguments.output_folder / relative_path
        if real_path(target) == real_path(source):
            raise InvalidSettingError(f"{source} would be overwritten; choose another folder.")
        refusal = _refusal(source, target)
        tasks.append(Task((source,), target, arguments, refusal, each.name.as_posix()))
    return tasks


def _refusal(source: Path, target: Path) -> str:
    """Create the folder of a target; return why it cannot be written, or an empty text."""
    made = attempt(source, _prepare_target, source, target)
    return made.sentence if isinstance(made, Failure) else ""


def _prepare_target(source: Path, target: Path) -> None:
    if is_missing(source):
        raise InvalidFileError(f"There is no file {source}.")
    if is_folder(source):
        check_folder_access(source)
    check_name_length(target, PICTURE)
    target.parent.mkdir(parents=True, exist_ok=True)


def _is_blend(file: Path) -> bool:
    return file.suffix.lower() == BLEND


def _blends_in(folder: Path) -> list[Path]:
    """Return the .blend files in a folder and below, and the folders that cannot be opened."""
    found = [file for file in files_below(folder) if _is_blend(file) or is_folder(file)]
    if not found:
        raise InvalidFileError(
            f"There is no .blend file in {folder}. Make them of recordings with each FOLDER"
            " --output-folder DIR -- import."
        )
    return found


def _work_on_tasks(
    tasks: Sequence[Task], arguments: argparse.Namespace, screen: Screen
) -> Iterator[FinishedTask]:
    """Yield existing results, then each task when it finishes, and record it."""
    remaining = []
    for task in tasks:
        record = made_record(task)
        if record is None:
            remaining.append(task)
        elif arguments.again or (arguments.report and not has_picture(task)):
            remaining.append(task._replace(replaced=record.identifier))
        elif has_called_hook(task, record):
            yield FinishedTask(task, already_made(record))
        else:
            remaining.append(task)
    if not remaining:
        return
    stopped = Event()
    with ThreadPoolExecutor(arguments.jobs) as pool:
        waiting = [
            pool.submit(work_if_unclaimed, task, partial(_attempt, task, stopped))
            for task in remaining
        ]
        try:
            for done in screen.counted(as_completed(waiting), len(waiting)):
                yield done.result()
        finally:
            stopped.set()
            pool.shutdown(cancel_futures=True)


def _attempt(task: Task, stopped: Event) -> FinishedTask:
    """Run the verb on one file in another Blender."""
    finished = attempt(task.source, _perform, task, stopped)
    if isinstance(finished, Failure):
        return FinishedTask(task, None, finished.sentence)
    return finished


def _perform(task: Task, stopped: Event) -> FinishedTask:
    if task.refusal:
        return FinishedTask(task, None, task.refusal)
    remove_picture(task)
    if task.arguments.report:
        make_folder(picture_file(task).parent, task.arguments.output_folder)
    with ScratchFolder() as scratch:
        figures = scratch.path / "figures"
        ended = run_child(_command(task, figures), _made_by(task), stopped)
        if ended is None:
            return FinishedTask(task, None, f"{task.source}: Interrupted.")
        if ended.status == 0:
            return FinishedTask(task, Outcome("Done.", _figures(figures)))
    error_lines = [line for line in ended.errors.splitlines() if line.strip()]
    sentence = (
        error_lines[-1] if ended.status == 2 and error_lines else "its Blender process crashed."
    )
    named = task.source.name in sentence
    return FinishedTask(task, None, sentence if named else f"{task.source}: {sentence}")


def _made_by(task: Task) -> Path:
    """Return the .blend file of a task; each of `each` has one."""
    if task.target is None:
        raise ValueError(f"the task of {task.source} writes nothing")
    return task.target


def _command(task: Task, figures: Path) -> list[str]:
    arguments, source = task.arguments, str(real_path(task.source))
    verb, *options = arguments.words
    imports = verb in IMPORT_VERBS
    opened = bpy.data.filepath if imports else source
    words = [OPTION, verb, *([source] if imports else []), *options, "--json", str(figures)]
    words += ["--output", str(real_path(_made_by(task)))]
    if arguments.report:
        words += ["--picture", str(real_path(picture_file(task)))]
    if bpy.app.binary_path:
        start = [bpy.app.binary_path, "--background", *([opened] if opened else [])]
        return [*start, "--command", "mocap_assist", *words]
    return [sys.executable, "-c", MODULE_CHILD, PACKAGE, opened, *words]


def _figures(path: Path) -> dict[str, Any]:
    """Return the figures of the first armature, and how many there are; or of a recording."""
    lines = [parse_json(line) for line in path.read_text(encoding="utf-8").splitlines()]
    first: dict[str, Any] = lines[0] if lines else {}
    if "objects" in first:  # What is said of the one recording that each is.
        description = first["figures"][0] if "figures" in first else {"said": first["said"]}
        return {"object": first["objects"][0], **description}
    return {**first, "armatures": len(lines)}
