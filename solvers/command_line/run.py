"""Parse the command line, process every file and report the results."""

import argparse
import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import InvalidSettingError, MocapAssistError
from ..faults import Failure, attempt, escaped
from ..files import is_missing, reason_of
from ..processes import add_threads_option
from ..version import version
from .arguments import (
    OutputKind,
    SentenceParser,
    Task,
    Verb,
    add_cluster_option,
    add_sharing_options,
    arguments_from,
    settings_from_arguments,
)
from .batches import (
    PAGE,
    FinishedTask,
    Screen,
    already_made,
    check_output_folder,
    draw_task,
    escape_undecodable_names,
    has_called_hook,
    has_picture,
    made_record,
    note_other_builds,
    printable,
    record_end,
    run_tasks,
    shared_tasks,
    task_entries,
    tasks_of,
    until_released,
    verb_name,
    workers_for,
    write_report,
)
from .farm import FlamencoSettings, add_flamenco_options, check_job, job_of_batch
from .sharing import stamp_options

FILES = {
    OutputKind.WORDS: "Recordings to read, or folders of them",
    OutputKind.FILES: "The recording and the file to write; with --output-folder recordings, or"
    " folders of them",
    OutputKind.ONE_FILE: "Recordings to read, or folders of them",
    OutputKind.MANY_FILES: "Recordings to read, or folders of them",
    OutputKind.REPORT: "Output folders of batches",
    OutputKind.LIBRARY: "The library, and then recordings to add, or folders of them",
    OutputKind.MATCHES: "The recording to search with, and then libraries with one vocabulary,"
    " or folders of them",
}
FAILED_STATUS = 2
INTERRUPTED = 130


def run(verbs: Mapping[str, Verb], words: Sequence[str], prog: str) -> int:
    """Run a command line.

    Parameters
    ----------
    verbs : mapping of str to Verb
    words : sequence of str
        The command line without the program's name.
    prog : str
        The program's name, for the help.

    Returns
    -------
    int
        Exit status: 0, or 2 if anything failed, or 130 if interrupted. Each failure is one
        sentence on stderr; a usage error raises SystemExit with status 2.
    """
    arguments = _parser(verbs, prog).parse_args(words)
    escape_undecodable_names(sys.stdout)
    screen = Screen()
    try:
        if getattr(arguments, "flamenco", None) is not None:
            return _submit(verbs[arguments.verb], arguments, list(words[1:]))
        return _run_verb(verbs[arguments.verb], arguments, screen)
    except MocapAssistError as error:
        screen.write_line(str(error))
        return FAILED_STATUS
    except BrokenPipeError:  # The reader of our output, such as `head`, has closed it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED_STATUS
    except OSError as error:
        screen.write_line(f"{error.filename or 'The output'}: {reason_of(error)}.")
        return FAILED_STATUS
    except KeyboardInterrupt:
        screen.write_line("Interrupted. Finished files are kept.")
        return INTERRUPTED


def _parser(verbs: Mapping[str, Verb], prog: str) -> SentenceParser:
    parser = SentenceParser(
        prog=prog,
        description="Clean up captured motion: BVH, Acclaim (AMC with ASF), C3D and TRC files.",
        epilog=f"For the options of a verb: {prog} VERB --help",
    )
    parser.add_argument("--version", action="version", version=f"Mocap Assist {version()}")
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for name, verb in verbs.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        _add_common_options(described, verb.makes)
        verb.add_options(described)
    return parser


def _add_common_options(parser: argparse.ArgumentParser, makes: OutputKind) -> None:
    has_manifest = makes is OutputKind.FILES
    parser.add_argument(
        "files", nargs="*" if has_manifest else "+", type=Path, metavar="FILE",
        help=FILES[makes],
    )  # fmt: skip
    if has_manifest:
        parser.add_argument(
            "--output-folder", type=Path, metavar="DIR",
            help="Folder for the results, named like the inputs. A second run resumes the"
            " first: it skips results made from the same file with the same options. Many"
            " machines may write to one folder at once",
        )  # fmt: skip
        parser.add_argument("--again", action="store_true", help="Redo existing results")
        parser.add_argument(
            "--report", action="store_true",
            help=f"Write DIR/{PAGE} and report.json about the whole batch, with pictures",
        )  # fmt: skip
        add_sharing_options(parser)
    if makes not in {
        OutputKind.ONE_FILE, OutputKind.MANY_FILES, OutputKind.MATCHES, OutputKind.REPORT,
    }:  # fmt: skip
        workers = parser.add_mutually_exclusive_group()
        workers.add_argument(
            "--jobs", type=int, default=1, metavar="N",
            help="Number of files to process in parallel [default 1]",
        )  # fmt: skip
        if has_manifest or makes is OutputKind.LIBRARY:
            add_cluster_option(workers)
    if has_manifest:
        add_flamenco_options(parser)
        arguments_from(parser, FlamencoSettings)
    add_threads_option(parser)
    parser.add_argument(
        "--json", action="store_true",
        help="Print figures for programs: one line of JSON for each file",
    )  # fmt: skip


def _submit(verb: Verb, arguments: argparse.Namespace, words: list[str]) -> int:
    """Submit the batch to a Flamenco Manager and print the address of its page."""
    settings = settings_from_arguments(arguments, FlamencoSettings)
    add_common = partial(_add_common_options, makes=verb.makes)
    job = job_of_batch(arguments, settings, words, add_common, verb.add_options)
    submitted = check_job(job, arguments.flamenco).submit()
    text = f"Submitted {job.name} in {settings.flamenco_tasks} tasks: {submitted.page}"
    figures = {"job": submitted.identifier, "page": submitted.page}
    sys.stdout.write(f"{json.dumps(figures) if arguments.json else text}\n")
    return 0


def _run_verb(verb: Verb, arguments: argparse.Namespace, screen: Screen) -> int:
    """Process all files and report each; return the exit status."""
    n_jobs = getattr(arguments, "jobs", 1)
    if n_jobs < 1:
        raise InvalidSettingError(f"jobs is {n_jobs}; it must be at least 1.")
    if getattr(arguments, "cluster", None) and hasattr(arguments, "threads"):
        raise InvalidSettingError(
            "The workers of a cluster choose their threads. Leave out --threads."
        )
    folder: Path | None = getattr(arguments, "output_folder", None)
    reporting = getattr(arguments, "report", False)
    if folder is None and reporting:
        raise InvalidSettingError("A report needs a folder: name it with --output-folder DIR.")
    stamp_options(arguments)
    every = tasks_of(verb, arguments)
    tasks = every if folder is None else shared_tasks(every, arguments)
    has_failures = False
    try:
        for finished in _run_tasks(verb, tasks, screen):
            has_failures |= _report(finished, len(tasks) > 1, screen)
            has_failures |= finished.outcome is None
            if folder is not None:
                check_output_folder(folder)
    finally:
        if folder is not None and reporting and not is_missing(folder):
            name = verb_name(every[0])
            for fault in write_report(folder, name, lambda: task_entries(every)):
                screen.write_line(fault)
                has_failures = True
    return FAILED_STATUS if has_failures else 0


def _run_tasks(verb: Verb, tasks: Sequence[Task], screen: Screen) -> Iterator[FinishedTask]:
    """Yield existing results, then each task when it finishes."""
    remaining = []
    for task in tasks:
        record = None if _folder(task) is None else made_record(task)
        if record is not None and task.arguments.again:
            remaining.append(task._replace(replaced=record.identifier))
        elif record is not None and has_called_hook(task, record):
            draw = task.arguments.report and not has_picture(task)
            failures = tuple(filter(None, [draw_task(task)])) if draw else ()
            outcome = already_made(record)
            yield FinishedTask(task, replace(outcome, failures=failures))
        elif task.refusal:
            screen.write_line(task.refusal)
            yield record_end(FinishedTask(task, None, task.refusal))
        else:
            remaining.append(task)
    if not remaining:
        return
    note_other_builds(remaining, screen)
    with workers_for(remaining) as workers:
        prepared = verb.prepare(tasks[0].arguments, screen.progress)
        run_all = partial(run_tasks, verb, prepared=prepared, workers=workers, screen=screen)
        for finished in until_released(remaining, run_all, screen):
            screen.clear()
            if finished.outcome is None and not is_missing(_folder(finished.task) or "."):
                screen.write_line(finished.failure)
            yield finished


def _folder(task: Task) -> Path | None:
    folder: Path | None = getattr(task.arguments, "output_folder", None)
    return folder


def _report(finished: FinishedTask, one_of_many: bool, screen: Screen) -> bool:
    """Print the result of a task on stdout: a line of JSON, or text.

    Returns
    -------
    bool
        Whether a part of it failed; stderr names it.
    """
    task, outcome = finished.task, finished.outcome
    arguments = task.arguments
    failures = outcome.failures if outcome is not None else ()
    if arguments.json:
        figures = {"error": finished.failure} if outcome is None else outcome.figures
        names: dict[str, Any] = {"input": str(task.source)}
        if len(task.sources) > 1:
            names = {"inputs": [str(source) for source in task.sources]}
        if getattr(arguments, "body", None):
            names["body"] = arguments.body
        if task.target is not None:
            names["output"] = str(task.target)
        line = attempt(task.subject, json.dumps, {**names, **figures}, allow_nan=False)
        if isinstance(line, Failure):
            failures = (*failures, line.sentence)
            line = json.dumps({**names, "error": line.sentence})
        sys.stdout.write(f"{line}\n")
    elif outcome is not None:
        title = f"{escaped(str(task.source))}\n" if one_of_many else ""
        sys.stdout.write(f"{title}{printable(outcome.text)}\n")
    sys.stdout.flush()
    for sentence in failures:
        screen.write_line(sentence)
    return bool(failures)
